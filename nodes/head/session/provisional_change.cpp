#include "nodes/head/session/provisional_change.hpp"

#include <algorithm>
#include <utility>

namespace mural {

void ProvisionalChange::begin(std::chrono::milliseconds after) {
    std::thread earlier;
    {
        const std::lock_guard lock(mutex_);
        earlier = std::move(thread_);
    }
    if (earlier.joinable()) earlier.join();
    const std::lock_guard lock(mutex_);
    if (isEnded_) return;
    due_ = std::chrono::steady_clock::now() + after;
    state_ = State::Pending;
    thread_ = std::thread([this] { awaitEnd(); });
}

bool ProvisionalChange::keep() {
    const std::lock_guard lock(mutex_);
    if (state_ != State::Pending) return false;
    state_ = State::Idle;
    changed_.notify_all();
    return true;
}

std::optional<std::chrono::milliseconds> ProvisionalChange::left() const {
    const std::lock_guard lock(mutex_);
    if (state_ == State::Idle) return {};
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(due_ - std::chrono::steady_clock::now());
    return std::max(left, std::chrono::milliseconds(0));
}

void ProvisionalChange::end() {
    std::thread last;
    {
        const std::lock_guard lock(mutex_);
        isEnded_ = true;
        if (state_ == State::Pending) state_ = State::Idle;
        changed_.notify_all();
        last = std::move(thread_);
    }
    if (last.joinable()) last.join();
}

void ProvisionalChange::awaitEnd() {
    {
        std::unique_lock lock(mutex_);
        if (changed_.wait_until(lock, due_, [this] { return state_ == State::Idle; })) return;
        state_ = State::Reverting;
    }
    revert_();
    const std::lock_guard lock(mutex_);
    state_ = State::Idle;
}

} // namespace mural
