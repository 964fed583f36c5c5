// Input of the fuzz target of previews: messages. A message is the node (1 byte), the members of its header but
// `reserved` (2 bytes each), and the JPEG with its size in bytes before it (2 bytes).
#pragma once

#include "streamcodec/wire/preview_tile.hpp"
#include "tests/fuzz/network/input_reader.hpp"

namespace mural::fuzz {

constexpr uint32_t kRequestedSide = 256; // pixels of the largest picture

inline wire::PreviewTileHeader previewHeaderOf(InputReader& in) {
    wire::PreviewTileHeader header{};
    header.number = in.half();
    header.client = in.half();
    header.frame = in.half();
    header.wallWidth = in.half();
    header.wallHeight = in.half();
    header.pictureWidth = in.half();
    header.pictureHeight = in.half();
    for (int32_t* const value : {&header.x, &header.y, &header.w, &header.h}) *value = static_cast<int16_t>(in.half());
    header.tiles = in.half();
    header.tile = in.half();
    return header;
}

} // namespace mural::fuzz
