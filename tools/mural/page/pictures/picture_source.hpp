// A source of pictures for viewers: the head, or the program's private display. Used by the thread of the page's
// io_context.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "common/base/result.hpp"
#include "nodes/head/preview/picture_wish.hpp"
#include "nodes/output/picture.hpp"

namespace mural::page {

// Number of the program's private display as a source. Others: PictureWish::source.
inline constexpr uint32_t kDesktopPicture = UINT32_MAX;

struct FeedPicture {
    std::shared_ptr<const OwnedPicture> picture;
    uint64_t frame = 0;                    // increases with each picture of the source
    int sourceWidth = 0, sourceHeight = 0; // before the reduction
};

class PictureSource {
public:
    using OnPicture = std::function<void(Result<FeedPicture> picture)>;

    virtual ~PictureSource() = default;
    // Requests a picture of a later frame. Requires that no earlier wish waits. After close() nothing is called.
    virtual void wish(const PictureWish& wish, OnPicture onPicture) = 0;
    [[nodiscard]] virtual bool isWaiting() const = 0;
    virtual void close() = 0;
};

} // namespace mural::page
