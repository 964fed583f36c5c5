// Whether more is likely to come within a nap: then the reader of a program's publications looks again by itself, and
// the program needs no system call to wake it (common/capture_ring.hpp).
#pragma once

#include <cstdint>

namespace mural {

class ArrivalPace {
public:
    static constexpr int64_t kQuickNs = 300'000; // three naps

    void arrived(int64_t nowNs) {
        quick_ = nowNs - lastNs_ < kQuickNs;
        lastNs_ = nowNs;
    }
    [[nodiscard]] bool moreSoon(int64_t nowNs) const { return quick_ && nowNs - lastNs_ < kQuickNs; }

private:
    int64_t lastNs_ = INT64_MIN / 2;
    bool quick_ = false;
};

} // namespace mural
