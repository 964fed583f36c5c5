// Finds out whether the program's way of drawing prevents the chosen division of the work from saving time, and warns
// the user.
//
// Reports each limit once per session. Thread-safe.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <vector>

#include "nodes/session/session_config.hpp"

namespace mural {

// A way of drawing that prevents a division of the work.
struct DivisionLimit {
    const char* code; // "drawn-whole", "areas-stay", "frames-build-up", "draws-unshared"; never changes
    const char* text; // one line for the user
};

// Frames of the nodes that draw ranges, summed over these nodes.
struct SharedDraws {
    int64_t frames = 0; // 0: no node draws a range
    int64_t shared = 0; // frames in which a draw was divided
};

class SlowdownAdvice {
public:
    SlowdownAdvice(const SessionConfig& config, int nodeCount) : tiling_(config.tiling), nodeCount_(nodeCount) {}

    // flags: FrameDoneMessage::flags. sharesDraws: the node draws one range of a database.
    void frameDone(uint32_t flags, bool sharesDraws);

    bool drawnWhole() const { return drawnWhole_; } // see SessionReport
    // Returns the limits that were reported, in this order.
    [[nodiscard]] std::vector<DivisionLimit> limits() const;
    [[nodiscard]] SharedDraws sharedDraws() const { return {rangeFrames_, splitFrames_}; }

private:
    void advise(const DivisionLimit& limit);
    void countUnshared(uint32_t flags);

    const Tiling tiling_;
    const int nodeCount_;
    std::atomic<int64_t> unsharedFrames_{0}; // sum over all nodes since the start
    std::atomic<int64_t> rangeFrames_{0}, splitFrames_{0};
    std::atomic<bool> keepsPicture_{false};
    std::atomic<bool> keepsAreas_{false};
    std::atomic<bool> drawnWhole_{false};
    mutable std::mutex mutex_;
    std::vector<DivisionLimit> limits_; // under mutex_
};

} // namespace mural
