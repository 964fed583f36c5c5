// The head's end of a node's packed pictures: keeps the last one of each of its windows, for the tiles that stay.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/result.hpp"
#include "compositor/codecs/unchanged_tiles.hpp"
#include "nodes/pictures/plane_codec_link.hpp"

namespace mural {

// Used by one thread.
class PictureUnpacker {
public:
    explicit PictureUnpacker(const std::string& codec);

    // As PicturePacker::pack got it, at once or by a later call; `into` has as many bytes. Any bytes may come in: what is no packed picture of this size,
    // or builds on one that has not come, is an error.
    [[nodiscard]] Result<void> unpack(uint32_t client, uint32_t window, int32_t width, int32_t height, std::span<const std::byte> packed, std::span<std::byte> into);
    void windowGone(uint32_t client, uint32_t window) { windows_.erase({client, window}); }
    void clientGone(uint32_t client);

private:
    struct Window {
        compositor::UnchangedTilesDecoder tiles;
        compositor::Plane last;
    };
    LinkDecoder codec_;
    const bool asColours_;
    std::map<std::pair<uint32_t, uint32_t>, Window> windows_;
};

} // namespace mural
