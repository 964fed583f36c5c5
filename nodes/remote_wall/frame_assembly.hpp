// Assembles the tiles of all sources of a remote wall to frames. Pure; not thread-safe.
//
// A frame is complete when all sources have ended it. A source leaves out unchanged tiles, so each frame depends on the
// one before. After the loss of a frame, frames are dropped until all sources have sent all their tiles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/remote_wall/wall_message.hpp"

namespace mural::remote {

struct StoredTile {
    int eye = 0;
    PixelViewport area;
    uint8_t codec = 0;
    std::vector<std::byte> bytes;
};

struct CompleteFrame {
    uint64_t number = 0;
    uint64_t wallFrame = 0;
    PictureSize size;
    std::vector<StoredTile> tiles;
};

class FrameAssembly {
public:
    static constexpr size_t kMaxIncomplete = 3; // frames; the oldest is dropped

    explicit FrameAssembly(uint32_t sources) : ended_(sources, 0) {}

    // Take a message of the source. Errors: it breaks the order of frames, or a frame has more tiles than its picture.
    Result<void> add(uint32_t source, const Tile& tile);
    Result<void> end(uint32_t source, const FrameEnd& end);
    // Returns the frames that are complete since the last call, the oldest first. All of them must be applied.
    [[nodiscard]] std::vector<CompleteFrame> takeComplete();
    // Returns true once after a loss: the sources must send all their tiles.
    [[nodiscard]] bool takeLoss();
    [[nodiscard]] size_t incomplete() const { return frames_.size(); }

private:
    struct Frame {
        CompleteFrame content;
        int64_t pixels = 0;           // of its tiles
        std::vector<uint32_t> counts; // tiles by source
        size_t missing = 0;           // sources that have not ended it
        bool isWhole = true;
    };

    // Returns the frame. Null: it was dropped.
    Result<Frame*> frameOf(uint32_t source, uint64_t number, const PictureSize& size);
    void dropBefore(uint64_t number);

    std::vector<uint64_t> ended_;      // the latest frame that each source has ended
    std::map<uint64_t, Frame> frames_; // incomplete, by number
    std::vector<CompleteFrame> complete_;
    uint64_t dropped_ = 0; // frames up to this number are complete or dropped
    bool needsWhole_ = true;
    bool hasLoss_ = false;
};

} // namespace mural::remote
