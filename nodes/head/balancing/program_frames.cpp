#include "nodes/head/balancing/program_frames.hpp"

#include <algorithm>
#include <utility>

#include "common/base/clock.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {
namespace {

constexpr int64_t kIdleNs = 250 * kNsPerMs; // longer than the intervals of a slow animation
constexpr size_t kMaxFrames = 256;          // some node never finishes them

} // namespace

void ProgramFrames::sent(const SentFrame& frame) {
    isRepeated_ = frame.isRepeated;
    if (frame.frame == wire::kUnseenFrame) return;
    sent_ = frame.frame;
    began_.emplace_back(frame.frame, frame.beganNs);
    if (began_.size() > kMaxFrames) began_.pop_front();
}

int64_t ProgramFrames::finished(uint32_t frame, int64_t nowNs) {
    const bool isFirst = finished_ == 0; // its time includes the compilation of shaders
    int64_t beganNs = finishedNs_;
    while (!began_.empty() && began_.front().first <= frame) {
        if (began_.front().first == frame) beganNs = std::max(beganNs, began_.front().second);
        began_.pop_front();
    }
    finished_ = frame;
    finishedNs_ = nowNs;
    return isFirst ? 0 : nowNs - beganNs;
}

bool ProgramFrames::isIdle(int64_t nowNs) const {
    return sent_ != 0 && finished_ >= sent_ && nowNs - finishedNs_ > kIdleNs;
}

bool ProgramFrames::isStill(int64_t nowNs) const { return isRepeated_ || isIdle(nowNs); }

} // namespace mural
