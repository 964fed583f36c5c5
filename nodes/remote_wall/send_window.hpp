// Flow control of a sender of pictures: which frames may be sent, and when. A remote wall acknowledges frames that it
// has shown. Pure; not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/base/result.hpp"

namespace mural::remote {

class SendWindow {
public:
    static constexpr size_t kMaxInFlight = 2; // frames without an acknowledgement

    // rate: most frames per second.
    explicit SendWindow(int rate) : ownRate_(rate) {}

    // Limits the rate further. 0: no further limit.
    void limitRate(int rate) { wantedRate_ = rate; }
    [[nodiscard]] bool hasRoom() const { return inFlight_.size() < kMaxInFlight; }
    // Returns the time from which on the rate permits the next frame.
    [[nodiscard]] int64_t nextNs() const;
    [[nodiscard]] bool maySend(int64_t nowNs) const { return hasRoom() && nowNs >= nextNs(); }
    // Notes a frame with its encoded size. beganNs: time before its first tile; nowNs: after its last one.
    void sent(uint64_t frame, uint64_t bytes, int64_t beganNs, int64_t nowNs);

    // A transfer that was not interrupted.
    struct Transfer {
        uint64_t bytes = 0;
        int64_t ns = 0;
    };
    // Takes an acknowledgement of the frame and all earlier ones. Errors: the frame was not sent.
    Result<std::optional<Transfer>> acknowledge(uint64_t frame, int64_t nowNs);
    // True if nothing awaits an acknowledgement.
    [[nodiscard]] bool isIdle() const { return inFlight_.empty(); }
    // Returns the time since the latest acknowledgement, or since the oldest frame without one was sent; 0: all frames
    // have one.
    [[nodiscard]] int64_t silentNs(int64_t nowNs) const;

private:
    struct Sent {
        uint64_t frame = 0, bytes = 0;
        int64_t beganNs = 0, sentNs = 0;
    };
    int ownRate_;
    int wantedRate_ = 0;
    std::deque<Sent> inFlight_;
    std::optional<int64_t> lastNs_; // beginning of the latest frame
    uint64_t lastAcknowledged_ = 0;
    int64_t acknowledgedNs_ = 0;
};

} // namespace mural::remote
