#include "transport/fabric/fabric_closing.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <vector>

namespace mural::fabric {

namespace {

constexpr int64_t kDrainMs = 10'000;
constexpr int64_t kExitMs = 1000;

class Closing {
public:
    void add(std::shared_ptr<Channel> channel) {
        {
            auto lock = channel->lock();
            if (channel->finished()) {
                channel->drain(lock, Deadline::inMs(0), stop_);
                return;
            }
        }
        const std::lock_guard lock(mutex_);
        try {
            std::thread([this, channel] { drain(channel); }).detach();
            draining_.push_back(std::move(channel));
        } catch (const std::system_error&) { // no thread available: a short wait is better than lost data
            auto channelLock = channel->lock();
            channel->drain(channelLock, Deadline::inMs(kExitMs), stop_);
        }
    }

    // Runs at process exit before libfabric's own cleanup. A forked child has the list but not the threads.
    ~Closing() {
        if (getpid() != ownerPid_) {
            new auto(std::move(draining_)); // leaks the parent's objects on purpose
            return;
        }
        std::unique_lock lock(mutex_);
        const auto none = [this] { return draining_.empty(); };
        if (changed_.wait_for(lock, std::chrono::milliseconds(kExitMs), none)) return;
        const auto left = draining_;
        lock.unlock();
        for (const auto& channel : left) {
            const auto channelLock = channel->lock();
            stop_ = true;
            channel->wakeAll();
        }
        lock.lock();
        changed_.wait_for(lock, std::chrono::milliseconds(kExitMs), none);
    }

private:
    void drain(std::shared_ptr<Channel> channel) {
        {
            auto lock = channel->lock();
            channel->drain(lock, Deadline::inMs(kDrainMs), stop_);
        }
        Channel* raw = channel.get();
        channel.reset();
        const std::lock_guard lock(mutex_); // destroys the endpoint, unless its connection still owns it
        draining_.erase(
            std::find_if(draining_.begin(), draining_.end(), [raw](const auto& each) { return each.get() == raw; }));
        changed_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<std::shared_ptr<Channel>> draining_;
    std::atomic<bool> stop_{false};
    pid_t ownerPid_ = getpid();
};

} // namespace

void drainInBackground(std::shared_ptr<Channel> channel) {
    static Closing closing;
    closing.add(std::move(channel));
}

} // namespace mural::fabric
