// The rate at which requested bytes arrive, over all requests of a process. The time that the sender needed to code
// them does not count, because it is no property of the connection. Pure: the caller passes the time.
#pragma once

#include <algorithm>
#include <cstdint>

namespace mural::objects {

class LinkRate {
public:
    // A request is sent. Time counts from the first one on.
    void requested(int64_t nowNs) {
        if (beganNs_ == kIdle) beganNs_ = nowNs;
    }
    void received(uint64_t bytes, int64_t codingNs, int64_t nowNs) {
        if (beganNs_ == kIdle) return;
        bytes_ += bytes;
        codingNs_ += codingNs;
        const int64_t elapsedNs = nowNs - beganNs_;
        if (bytes_ < kLeastBytes || elapsedNs <= 0) return;
        const int64_t linkNs = std::max(elapsedNs - codingNs_, elapsedNs / kMostCodingShare);
        const double measured = 1e9 * static_cast<double>(bytes_) / static_cast<double>(linkNs);
        rate_ = rate_ == 0 ? measured : (rate_ + measured) / 2;
        restart(nowNs);
    }
    // No request is open. Bytes that were counted since the last measurement do not count.
    void idle() { restart(kIdle); }

    // 0: unknown
    [[nodiscard]] uint64_t bytesPerSecond() const { return static_cast<uint64_t>(rate_); }

private:
    static constexpr int64_t kIdle = INT64_MIN;
    static constexpr uint64_t kLeastBytes = 200U << 10; // of a measurement
    static constexpr int64_t kMostCodingShare = 10;     // at least a tenth of the time belongs to the connection

    void restart(int64_t nowNs) {
        beganNs_ = nowNs;
        bytes_ = 0;
        codingNs_ = 0;
    }

    int64_t beganNs_ = kIdle;
    uint64_t bytes_ = 0;
    int64_t codingNs_ = 0;
    double rate_ = 0;
};

} // namespace mural::objects
