// The pixel store state, queried from the program's context. It is needed only for images, and a query is always
// correct (client attribute stacks, other entry points).
#pragma once

#include <cstdint>

#include "streamcodec/sizes/pixel_format.hpp"

namespace mural {

struct Context;

[[nodiscard]] bool unpackBufferBound(const Context& c);
[[nodiscard]] bool packBufferBound(const Context& c);
[[nodiscard]] sizes::PixelStore unpackStore(const Context& c);
[[nodiscard]] sizes::PixelStore packStore(const Context& c);
// The same with the parameters of compressed blocks.
[[nodiscard]] sizes::PixelStore compressedPackStore(Context& c);
// During its lifetime the program's own context packs pixels tightly into client memory.
class TightPack {
public:
    explicit TightPack(const Context& context);
    ~TightPack();
    TightPack(const TightPack&) = delete;
    TightPack& operator=(const TightPack&) = delete;

    // False: the bound pack buffer is deleted and could not be bound again; nothing was changed.
    [[nodiscard]] bool ready() const { return ready_; }

private:
    bool ready_ = false;
    int first_ = 0;
    int32_t buffer_ = 0;
    int32_t values_[6] = {};
};

// True if the image in client memory is tight already.
[[nodiscard]] bool isTight(const sizes::ImageLayout& layout);

} // namespace mural
