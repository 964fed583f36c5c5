#include "nodes/remote_wall/send_window.hpp"

#include <algorithm>

#include "common/base/clock.hpp"

namespace mural::remote {

int64_t SendWindow::nextNs() const {
    if (!lastNs_) return 0;
    const int rate = wantedRate_ > 0 ? std::min(wantedRate_, ownRate_) : ownRate_;
    return *lastNs_ + kNsPerS / std::max(rate, 1);
}

void SendWindow::sent(uint64_t frame, uint64_t bytes, int64_t beganNs, int64_t nowNs) {
    inFlight_.push_back({frame, bytes, beganNs, nowNs});
    lastNs_ = beganNs;
}

Result<std::optional<SendWindow::Transfer>> SendWindow::acknowledge(uint64_t frame, int64_t nowNs) {
    if (frame <= lastAcknowledged_) return std::optional<Transfer>(); // a repetition
    if (inFlight_.empty() || frame < inFlight_.front().frame || frame > inFlight_.back().frame)
        return Error{"it acknowledged a frame that was not sent"};
    const bool wasAlone = inFlight_.size() == 1;
    Transfer transfer;
    while (!inFlight_.empty() && inFlight_.front().frame <= frame) {
        transfer = {inFlight_.front().bytes, nowNs - inFlight_.front().beganNs};
        inFlight_.pop_front();
    }
    lastAcknowledged_ = frame;
    acknowledgedNs_ = nowNs;
    // Two frames in flight share the connection, so their time is not that of one of them.
    return wasAlone ? std::optional(transfer) : std::nullopt;
}

int64_t SendWindow::silentNs(int64_t nowNs) const {
    return inFlight_.empty() ? 0 : nowNs - std::max(inFlight_.front().sentNs, acknowledgedNs_);
}

} // namespace mural::remote
