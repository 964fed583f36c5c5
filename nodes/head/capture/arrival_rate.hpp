// Predicts whether another publication arrives within one nap (common/ipc/capture_ring.hpp). If so, the head's reader
// naps and polls again, and the program saves the system call of a wake-up.
#pragma once

#include <cstdint>

namespace mural {

class ArrivalRate {
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
