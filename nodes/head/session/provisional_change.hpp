// A change that reverts by itself unless it is kept. A layout may hide the picture from the person who would undo it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace mural {

// Thread-safe.
class ProvisionalChange {
public:
    // revert: undoes the change. Called by a thread of this object, once per begin(); may take seconds.
    explicit ProvisionalChange(std::function<void()> revert) : revert_(std::move(revert)) {}
    ~ProvisionalChange() { end(); }
    ProvisionalChange(const ProvisionalChange&) = delete;
    ProvisionalChange& operator=(const ProvisionalChange&) = delete;

    // Starts the time after which the change reverts. Requires that none is pending. No effect after end().
    void begin(std::chrono::milliseconds after);
    // Returns false if no change is pending, or its reversion has begun.
    bool keep();
    // Returns the time to the reversion, 0 during it; nothing if no change is pending.
    [[nodiscard]] std::optional<std::chrono::milliseconds> left() const;
    // Keeps the pending change, and waits for a reversion in progress.
    void end();

private:
    void awaitEnd();

    const std::function<void()> revert_;
    mutable std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    enum class State { Idle, Pending, Reverting } state_ = State::Idle;
    bool isEnded_ = false;
    std::chrono::steady_clock::time_point due_;
    std::thread thread_; // runs while a change is pending, and during the reversion
};

} // namespace mural
