// Tells the head every few seconds that this node lives, also while its replay thread is at work: so that the
// head can tell a long frame from a stopped process. A replay that hangs ends it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

#include "nodes/node/head_line.hpp"

namespace mural {

class Heartbeat {
public:
    explicit Heartbeat(HeadLine& line);
    Heartbeat(const Heartbeat&) = delete;
    Heartbeat& operator=(const Heartbeat&) = delete;
    ~Heartbeat();

    // The replay thread begins, or has ended, its work on a packet.
    void begins();
    void ended() { workingSinceNs_ = 0; }

private:
    void beat();

    HeadLine& line_;
    std::atomic<int64_t> workingSinceNs_{0}; // 0: it waits for the head
    std::mutex mutex_;
    std::condition_variable stopped_;
    bool stop_ = false;
    std::thread thread_;
};

} // namespace mural
