// Times of the attempts to reach a remote wall, and of the line about a wall that stays away. Pure; not thread-safe.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "common/base/clock.hpp"

namespace mural::remote {

class RetryTimes {
public:
    static constexpr std::array<int64_t, 5> kPausesS = {0, 1, 3, 10, 30}; // before an attempt; the last one repeats
    static constexpr int64_t kReportNs = 10 * kNsPerS;

    // begin: the first time without a connection.
    explicit RetryTimes(int64_t beginNs) : goneNs_(beginNs), nextNs_(beginNs) {}

    [[nodiscard]] int64_t nextNs() const { return nextNs_; }
    // An attempt failed at this time, or its connection ended without a shown frame.
    void failed(int64_t nowNs) {
        pause_ = std::min(pause_ + 1, kPausesS.size() - 1);
        nextNs_ = nowNs + kPausesS[pause_] * kNsPerS;
    }
    // A connection that has shown a frame ended at this time.
    void lost(int64_t nowNs) {
        goneNs_ = nowNs;
        pause_ = 0;
        isReported_ = false;
        nextNs_ = nowNs + kPausesS[pause_] * kNsPerS;
    }
    // Returns true once per absence: after kReportNs, or at once if further attempts cannot succeed.
    [[nodiscard]] bool takeReport(int64_t nowNs, bool isFinal) {
        if (isReported_ || (!isFinal && nowNs - goneNs_ < kReportNs)) return false;
        isReported_ = true;
        return true;
    }

private:
    int64_t goneNs_;
    int64_t nextNs_;
    size_t pause_ = 0;
    bool isReported_ = false;
};

} // namespace mural::remote
