// Measures a node's work for each frame, without its waits. Used by the replay thread.
#pragma once

#include <cstdint>
#include <functional>

namespace mural {

class WorkClock {
public:
    // Counts the CPU time of this process instead of the time. For nodes that share the cores of a machine: they delay
    // each other regardless of their tiles, so only their own work counts. `excludedNs`: CPU time of this process that
    // is counted elsewhere.
    void countCpu(std::function<int64_t()> excludedNs);
    [[nodiscard]] bool countsCpu() const { return excludedNs_ != nullptr; }
    // Planted fault: the work takes longer, by this multiple.
    void slowDown(int64_t multiple) { slowdown_ = multiple; }

    // Begins work. The time since the last call of begin() or pause() is a wait.
    void begin() { beganNs_ = nowNs(); }
    // Ends work, and begins more. Call it before a wait, and begin() after the wait.
    void pause();
    // Returns the work since the last call, in ns.
    [[nodiscard]] int64_t take();
    void discard() { busyNs_ = 0; }

private:
    [[nodiscard]] int64_t nowNs() const;

    std::function<int64_t()> excludedNs_; // null: counts the time
    int64_t slowdown_ = 0;                // 0: no fault
    int64_t beganNs_ = 0;
    int64_t busyNs_ = 0;
};

} // namespace mural
