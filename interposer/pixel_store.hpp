// The pixel-store state of the program's context, asked from the context itself: it is needed only
// where images travel, and asking is always right (client attribute stacks, other entry points).
#pragma once

#include <cstdint>

#include "streamcodec/sizes/pixel_format.hpp"

namespace mural {

struct Context;

[[nodiscard]] bool unpackBufferBound(const Context& c);
[[nodiscard]] bool packBufferBound(const Context& c);
[[nodiscard]] sizes::PixelStore unpackStore(const Context& c);
[[nodiscard]] sizes::PixelStore packStore(const Context& c);
// The same with what describes the blocks of compressed images.
[[nodiscard]] sizes::PixelStore compressedPackStore(Context& c);
// As long as it lives, the program's own context packs pixels tightly into client memory.
class TightPack {
public:
    explicit TightPack(const Context& context);
    ~TightPack();
    TightPack(const TightPack&) = delete;
    TightPack& operator=(const TightPack&) = delete;

    // False: the pack buffer is deleted already and could not be bound again; nothing was changed.
    [[nodiscard]] bool ready() const { return ready_; }

private:
    bool ready_ = false;
    int first_ = 0;
    int32_t buffer_ = 0;
    int32_t values_[6] = {};
};

// True when the image lies in client memory just as it travels.
[[nodiscard]] bool isTight(const sizes::ImageLayout& layout);

} // namespace mural
