// The rate at which requested bytes arrive, over all requests of a process. Only the time from one piece to the next
// counts, and only if the later one was requested before the former arrived: the sender then had something to send all
// the time. The time that it needed to code the piece does not count. Pure: the caller passes the time.
#pragma once

#include <algorithm>
#include <cstdint>

namespace mural::objects {

class LinkRate {
public:
    // A piece of a request that was sent at requestedNs.
    void received(uint64_t bytes, int64_t codingNs, int64_t requestedNs, int64_t nowNs) {
        const bool wasBusy = lastNs_ > requestedNs;
        const int64_t sinceLastNs = wasBusy ? nowNs - lastNs_ : 0;
        lastNs_ = nowNs;
        if (sinceLastNs <= 0) return;
        bytes_ += bytes;
        ns_ += std::max(sinceLastNs - codingNs, sinceLastNs / kMostCodingShare);
        if (bytes_ < kLeastBytes) return;
        const double measured = 1e9 * static_cast<double>(bytes_) / static_cast<double>(std::max<int64_t>(ns_, 1));
        rate_ = rate_ == 0 ? measured : (rate_ + measured) / 2;
        bytes_ = 0;
        ns_ = 0;
    }

    // 0: unknown
    [[nodiscard]] uint64_t bytesPerSecond() const { return static_cast<uint64_t>(rate_); }

private:
    static constexpr uint64_t kLeastBytes = 200U << 10; // of a measurement
    static constexpr int64_t kMostCodingShare = 10;     // at least a tenth of the time belongs to the connection

    int64_t lastNs_ = INT64_MIN; // arrival of the latest piece
    uint64_t bytes_ = 0;         // since the last measurement
    int64_t ns_ = 0;
    double rate_ = 0;
};

} // namespace mural::objects
