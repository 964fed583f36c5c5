// Pictures of the windows of nodes, for pages. The head sends HeadCommand::WantPreview while somebody looks. Each node
// with windows replies NodeMessage::PreviewTile for each tile, from a thread of its own.
#pragma once

#include <cstdint>

namespace mural::wire {

struct WantPreviewCommand {
    uint32_t number;              // of the request, from 1
    uint32_t maxWidth, maxHeight; // of the reduced picture of the whole wall
};

// JPEG bytes follow, the upper row first. None: the tile shows the same as in the node's previous reply of this size.
struct PreviewTileHeader {
    uint32_t number; // of the WantPreviewCommand
    uint32_t client; // program of the frame
    uint32_t frame;  // of that program
    uint32_t reserved;
    uint32_t wallWidth, wallHeight; // before the reduction
    uint32_t pictureWidth, pictureHeight;
    int32_t x, y, w, h;   // place in the reduced picture, from the lower left corner
    uint32_t tiles, tile; // number of the node's tiles, and this one's, from 0
};
static_assert(sizeof(PreviewTileHeader) == 56);

constexpr uint32_t kMaxPreviewSide = 16384;
constexpr uint32_t kMaxPreviewTiles = 1024;      // of a node
constexpr uint32_t kMaxPreviewBytes = 64u << 20; // of a tile

} // namespace mural::wire
