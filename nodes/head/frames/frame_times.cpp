#include "nodes/head/frames/frame_times.hpp"

#include <utility>

namespace mural {
namespace {

constexpr size_t kMaxFrames = 64; // frames that only some nodes have finished
constexpr int kOthers = 240; // consecutive frames of other windows after which the followed window counts as closed

} // namespace

bool FrameTimes::follow(const wire::FrameDoneMessage& m) {
    const auto width = static_cast<int>(m.width), height = static_cast<int>(m.height);
    if (width == 0 || height == 0) return false;
    const bool larger = int64_t{width} * height > int64_t{width_} * height_;
    if (follows(m))
        others_ = 0;
    else if (!larger && ++others_ <= kOthers)
        return false;
    if (follows(m) && width == width_ && height == height_) return false;
    followed_ = {m.client, m.window};
    others_ = 0;
    width_ = width;
    height_ = height;
    frames_.clear();
    return true;
}

std::optional<FrameTimes::Frame> FrameTimes::finished(int node, const wire::FrameDoneMessage& message) {
    const auto index = static_cast<size_t>(node);
    Frame& frame = frames_[message.frame];
    frame.busyNs.resize(alive_.size(), -1);
    frame.done.resize(alive_.size());
    frame.busyNs[index] = std::exchange(workNs_[index], 0);
    frame.done[index] = message;
    bool complete = true;
    for (size_t n = 0; n < alive_.size(); ++n) complete = complete && (!alive_[n] || frame.busyNs[n] >= 0);
    std::optional<Frame> whole;
    if (complete) {
        whole = std::move(frame);
        frames_.erase(frames_.begin(), frames_.upper_bound(message.frame));
    }
    if (frames_.size() > kMaxFrames) frames_.erase(frames_.begin());
    return whole;
}

void FrameTimes::windowGone(uint32_t client, uint32_t window) {
    if (client != followed_.first || (window != wire::kAllWindows && window != followed_.second)) return;
    frames_.clear();
    width_ = height_ = 0;
    others_ = kOthers;
}

void FrameTimes::lost(int node) {
    alive_[static_cast<size_t>(node)] = false;
    frames_.clear();
}

bool FrameTimes::joined(int node) {
    const auto index = static_cast<size_t>(node);
    if (alive_[index]) return false;
    alive_[index] = true;
    workNs_[index] = 0;
    frames_.clear();
    return true;
}

} // namespace mural
