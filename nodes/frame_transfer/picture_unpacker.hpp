// Decodes a node's transferred pictures. Keeps the last picture of each window, because unchanged tiles are not sent.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/base/result.hpp"
#include "compositor/codecs/tile_delta.hpp"
#include "nodes/frame_transfer/plane_codec_link.hpp"

namespace mural {

// Used by one thread.
class PictureUnpacker {
public:
    explicit PictureUnpacker(const std::string& codec);

    // Inverse of PicturePacker::pack; `into` has the picture's size in bytes. Accepts arbitrary bytes. Errors: not an
    // encoded picture of this size; the picture that it depends on is missing.
    [[nodiscard]] Result<void> unpack(uint32_t client, uint32_t window, int32_t width, int32_t height,
                                      std::span<const std::byte> packed, std::span<std::byte> into);
    void windowGone(uint32_t client, uint32_t window) { windows_.erase({client, window}); }
    void clientGone(uint32_t client);

private:
    struct Window {
        compositor::TileDeltaDecoder tiles;
        compositor::Plane last;
    };
    LinkDecoder codec_;
    const bool asColours_;
    std::map<std::pair<uint32_t, uint32_t>, Window> windows_;
};

} // namespace mural
