// The pictures of a remote wall, to which the tiles of complete frames are decoded. Used by one thread.
#pragma once

#include <array>
#include <string>

#include "common/base/result.hpp"
#include "nodes/frame_transfer/plane_codecs.hpp"
#include "nodes/output/picture.hpp"
#include "nodes/remote_wall/frame_assembly.hpp"

namespace mural::remote {

class TileCanvas {
public:
    // codec: of the sender's Hello.
    explicit TileCanvas(const std::string& codec) : decoder_(codec), losesColours_(mayLose(codec)) {}

    // Errors: a tile that the codec cannot decode; the pictures are then unspecified.
    Result<void> apply(const CompleteFrame& frame);
    [[nodiscard]] const PictureSize& size() const { return size_; }
    [[nodiscard]] Picture picture(int eye) const { return pictures_[static_cast<size_t>(eye)].view(); }

private:
    PlaneDecoder decoder_;
    const bool losesColours_;
    PictureSize size_{0, 0, 1};
    std::array<OwnedPicture, kMaxEyes> pictures_;
};

} // namespace mural::remote
