#include "nodes/render/heartbeat.hpp"

#include "common/base/clock.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

namespace {
constexpr std::chrono::seconds kBeat{4};
constexpr int64_t kHungNs = 120 * kNsPerS; // for one packet; the slowest observed frame without a GPU took 10 s
} // namespace

Heartbeat::Heartbeat(HeadConnection& line) : line_(line), thread_([this] { beat(); }) {}

Heartbeat::~Heartbeat() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    stopped_.notify_all();
    thread_.join();
}

void Heartbeat::begins() { workingSinceNs_ = monotonicNowNs(); }

void Heartbeat::beat() {
    std::unique_lock lock(mutex_);
    while (!stopped_.wait_for(lock, kBeat, [this] { return stop_; })) {
        const int64_t since = workingSinceNs_;
        if (since == 0 || monotonicNowNs() - since < kHungNs) line_.sendIfFree(wire::NodeMessage::Alive);
    }
}

} // namespace mural
