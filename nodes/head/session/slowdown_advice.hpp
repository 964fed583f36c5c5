// Warns the user if the program's way of drawing prevents the chosen division of the work from saving time.
//
// Reports each line once per session. Thread-safe.
#pragma once

#include <atomic>
#include <cstdint>

#include "nodes/session/session_config.hpp"

namespace mural {

class SlowdownAdvice {
public:
    SlowdownAdvice(const SessionConfig& config, int nodeCount) : tiling_(config.tiling), nodeCount_(nodeCount) {}

    // flags: FrameDoneMessage::flags. sharesDraws: the node draws one range of a database.
    void frameDone(uint32_t flags, bool sharesDraws);

    bool drawnWhole() const { return drawnWhole_; } // see SessionReport

private:
    void countUnshared(uint32_t flags);

    const Tiling tiling_;
    const int nodeCount_;
    std::atomic<int64_t> unsharedFrames_{0}; // sum over all nodes since the start
    std::atomic<bool> keepsPicture_{false};
    std::atomic<bool> keepsAreas_{false};
    std::atomic<bool> drawnWhole_{false};
};

} // namespace mural
