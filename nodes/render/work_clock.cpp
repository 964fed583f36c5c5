#include "nodes/render/work_clock.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <thread>
#include <utility>

#include "common/base/clock.hpp"

namespace mural {

namespace {

int64_t processCpuNowNs() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return int64_t{now.tv_sec} * kNsPerS + now.tv_nsec;
}

} // namespace

void WorkClock::countCpu(std::function<int64_t()> excludedNs) { excludedNs_ = std::move(excludedNs); }

int64_t WorkClock::nowNs() const { return excludedNs_ ? processCpuNowNs() - excludedNs_() : monotonicNowNs(); }

void WorkClock::pause() {
    const int64_t now = nowNs();
    // the difference of two clocks may decrease
    const int64_t workedNs = std::max<int64_t>(now - std::exchange(beganNs_, now), 0);
    if (slowdown_ > 0) std::this_thread::sleep_for(std::chrono::nanoseconds(slowdown_ * workedNs));
    busyNs_ += workedNs * (1 + slowdown_);
}

int64_t WorkClock::take() { return std::exchange(busyNs_, 0); }

} // namespace mural
