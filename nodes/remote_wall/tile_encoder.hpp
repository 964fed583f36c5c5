// Encodes the tiles of a picture that have changed since the previous frame. Used by one thread.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "compositor/image/tile_hash.hpp"
#include "nodes/frame_transfer/plane_codecs.hpp"
#include "nodes/output/picture.hpp"
#include "nodes/remote_wall/wall_message.hpp"

namespace mural::remote {

class TileEncoder {
public:
    // codec: a name for PlaneEncoder. tile: side in pixels.
    TileEncoder(const std::string& codec, int tile) : encoder_(codec), losesColours_(mayLose(codec)), tile_(tile) {}

    // Takes an encoded tile. Its bytes are valid during the call.
    using OnTile = std::function<Result<void>(const Tile& tile)>;
    // Encodes a frame: one Bgra8 picture per eye, of equal sizes. Returns its end, without wallFrame. Errors: those of
    // onTile; the next frame then has all tiles.
    Result<FrameEnd> encode(uint64_t frame, std::span<const Picture> eyes, const OnTile& onTile);
    // The next frame has all tiles: the remote wall is new, or has lost its picture.
    void restart() { hashes_.clear(); }
    // Reports the time of a transfer, by which the encoder selects codecs.
    void transferred(uint64_t bytes, int64_t ns) { encoder_.transferred(bytes, ns); }

private:
    Result<void> encodeTile(Tile& tile, const Picture& picture, const OnTile& onTile);

    PlaneEncoder encoder_;
    const bool losesColours_;
    const int tile_;
    PictureSize size_;
    std::vector<compositor::TileHash> hashes_; // by eye, row and column; empty: nothing was sent
    std::vector<std::byte> rgba_, encoded_;
};

} // namespace mural::remote
