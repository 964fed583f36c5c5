// The frames of one window, as its program sends them and the nodes finish them. The picture stands still after
// two frames with equal commands, or after a pause of the program. Not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <utility>

#include "nodes/head/capture/frame_comparer.hpp"

namespace mural {

class ProgramFrames {
public:
    void sent(const SentFrame& frame);
    // All nodes have finished the frame. Returns its time in ns: since the end of the previous frame, but without a
    // wait for its first commands. 0: unknown, for the first frame.
    int64_t finished(uint32_t frame, int64_t nowNs);
    [[nodiscard]] bool isStill(int64_t nowNs) const;
    [[nodiscard]] bool isIdle(int64_t nowNs) const; // no frame for a while

private:
    std::deque<std::pair<uint32_t, int64_t>> began_; // unfinished frames, and when they began
    uint32_t sent_ = 0, finished_ = 0;               // latest frames
    int64_t finishedNs_ = 0;
    bool isRepeated_ = false;
};

} // namespace mural
