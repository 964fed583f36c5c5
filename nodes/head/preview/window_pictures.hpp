// Composes the picture of the wall from the previews of the nodes' windows (streamcodec/wire/preview_tile.hpp), while a
// page wishes pictures and the head has none. Thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <utility>

#include "common/base/result.hpp"
#include "nodes/output/picture.hpp"
#include "streamcodec/wire/preview_tile.hpp"

namespace mural {

class WindowPictures {
public:
    // A picture of the reduced size, and the size of the wall.
    struct Composed {
        std::shared_ptr<const OwnedPicture> picture;
        int64_t frame = 0;
        int wallWidth = 0, wallHeight = 0;
    };
    using OnPicture = std::function<void(const Composed& composed)>;

    // onPicture: called with each newer picture, by the thread of add(). Must not block.
    explicit WindowPictures(OnPicture onPicture) : onPicture_(std::move(onPicture)) {}

    // Begins a request for pictures of these largest sizes.
    [[nodiscard]] wire::WantPreviewCommand begin(uint32_t maxWidth, uint32_t maxHeight);
    // Takes the reply of a node. jpeg: may be empty. Errors: it breaks the rules of the message.
    Result<void> add(int node, const wire::PreviewTileHeader& header, std::span<const std::byte> jpeg);
    // Forgets the tiles of a node that has ended.
    void forget(int node);

private:
    struct Tile {
        wire::PreviewTileHeader header{};
        OwnedPicture picture;
    };
    void composeIfComplete(const wire::PreviewTileHeader& header);

    const OnPicture onPicture_;
    std::mutex mutex_; // guards the members below
    uint32_t number_ = 0;
    uint32_t mostWidth_ = 0, mostHeight_ = 0;        // that any request has permitted
    std::map<std::pair<int, uint32_t>, Tile> tiles_; // by node and tile
    // Of the latest composed picture. Frames of the wall increase, while those of a further program begin again.
    uint32_t client_ = 0, frame_ = 0, width_ = 0;
    int64_t wallFrame_ = 0;
};

} // namespace mural
