// The sending end of transferred pictures. Encodes only the tiles of a window that differ from its previous picture.
// Each run of tiles uses the codec that delivers it soonest, or the user's codec. Format:
// docs/reference/wire-format.md, "Packed pictures".
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

// Alpha in lossy codecs, which store it separately and take Bgra8 only. Lossless codecs keep all bits of any
// PictureFormat.
enum class PictureAlpha { Preserved, Dropped };

// Used by one thread. The receiver must decode all packed pictures in the same order.
class PicturePacker {
public:
    // codec: a name for PlaneEncoder.
    explicit PicturePacker(const std::string& codec, PictureAlpha alpha = PictureAlpha::Preserved);

    // Encodes rows bottom first, 4 bytes per pixel, B G R A. Requires width and height above 0. The bytes are valid
    // until the next call. Errors: out of memory.
    [[nodiscard]] Result<std::span<const std::byte>> pack(uint32_t client, uint32_t window, int32_t width,
                                                          int32_t height, const std::byte* bgra);
    // Reports a measurement of the link: bytes sent in a time without idle periods.
    void transferred(uint64_t bytes, int64_t ns) { codec_.transferred(bytes, ns); }
    void windowGone(uint32_t client, uint32_t window) { windows_.erase({client, window}); }
    void clientGone(uint32_t client);

    [[nodiscard]] uint64_t rawBytes() const { return rawBytes_; }
    [[nodiscard]] uint64_t packedBytes() const { return packedBytes_; }

private:
    LinkEncoder codec_;
    const bool asColours_; // lossy codecs need the real channel order
    const PictureAlpha alpha_;
    std::map<std::pair<uint32_t, uint32_t>, compositor::TileDeltaEncoder> windows_;
    std::vector<std::byte> packed_, rgba_;
    uint64_t rawBytes_ = 0, packedBytes_ = 0;
};

} // namespace mural
