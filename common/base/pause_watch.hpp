// Thread that measures how long this process is stopped (common/base/pauses.hpp). Each process has one, from the start
// of its work to the end.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <pthread.h>
#include <signal.h>
#include <thread>

#include "common/base/clock.hpp"
#include "common/base/pauses.hpp"

namespace mural {

class PauseWatch {
public:
    PauseWatch() {
        [[maybe_unused]] static const int once = pthread_atfork(nullptr, nullptr, endInChild);
        pauses::tick(monotonicNowNs());
        // The thread inherits the mask: signals of the process go to the threads that handle them.
        sigset_t all, before;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before);
        thread_ = std::thread([this] { watch(); });
        pthread_sigmask(SIG_SETMASK, &before, nullptr);
    }
    PauseWatch(const PauseWatch&) = delete;
    PauseWatch& operator=(const PauseWatch&) = delete;
    ~PauseWatch() {
        {
            const std::lock_guard lock(mutex_);
            stop_ = true;
        }
        stopped_.notify_all();
        thread_.join();
        pauses::endWatch();
    }

private:
    // A forked child has no such thread. The fork may have happened in the middle of a tick.
    static void endInChild() {
        pauses::lastTickNs.store(0);
        if (pauses::sequence.load() % 2 != 0) pauses::sequence.fetch_add(1);
    }

    void watch() {
        std::unique_lock lock(mutex_);
        while (!stopped_.wait_for(lock, std::chrono::nanoseconds(pauses::kTickNs), [this] { return stop_; }))
            pauses::tick(monotonicNowNs());
    }

    std::mutex mutex_;
    std::condition_variable stopped_;
    bool stop_ = false;
    std::thread thread_;
};

} // namespace mural
