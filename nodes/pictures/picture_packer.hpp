// A node's end of pictures that travel packed: of each window only the tiles that are not as in the picture before, each run of them by the codec
// that gets it there soonest, or as the user wants it. Bytes: docs/reference/wire-format.md, "Packed pictures".
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

// Alpha in lossy codecs, which store it separately and take Bgra8 only. Lossless codecs keep all bits of any PictureFormat.
enum class PictureAlpha { Kept, Dropped };

// Used by one thread. The other end gets all that is packed, in this order.
class PicturePacker {
public:
    // codec: as of PlaneEncoder.
    explicit PicturePacker(const std::string& codec, PictureAlpha alpha = PictureAlpha::Kept);

    // Rows bottom first, 4 bytes per pixel, B G R A; neither side is 0. The bytes live until the next call. Errors: no memory.
    [[nodiscard]] Result<std::span<const std::byte>> pack(uint32_t client, uint32_t window, int32_t width, int32_t height, const std::byte* bgra);
    // The link carried so much in a time in which it was never idle.
    void transferred(uint64_t bytes, int64_t ns) { codec_.transferred(bytes, ns); }
    void windowGone(uint32_t client, uint32_t window) { windows_.erase({client, window}); }
    void clientGone(uint32_t client);

    [[nodiscard]] uint64_t rawBytes() const { return rawBytes_; }
    [[nodiscard]] uint64_t packedBytes() const { return packedBytes_; }

private:
    LinkEncoder codec_;
    const bool asColours_; // codecs that lose something must know which byte is red
    const PictureAlpha alpha_;
    std::map<std::pair<uint32_t, uint32_t>, compositor::UnchangedTilesEncoder> windows_;
    std::vector<std::byte> packed_, rgba_;
    uint64_t rawBytes_ = 0, packedBytes_ = 0;
};

} // namespace mural
