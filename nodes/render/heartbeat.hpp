// Sends heartbeats to the head every few seconds, even while the replay thread works. The head can thus distinguish a
// long frame from a stopped process. Ends this process if its replay hangs.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

#include "nodes/render/head_connection.hpp"

namespace mural {

class Heartbeat {
public:
    explicit Heartbeat(HeadConnection& line);
    Heartbeat(const Heartbeat&) = delete;
    Heartbeat& operator=(const Heartbeat&) = delete;
    ~Heartbeat();

    // Mark the start and the end of a packet's replay. Called by the replay thread.
    void begins();
    void ended() { workingSinceNs_ = 0; }

private:
    void beat();

    HeadConnection& line_;
    std::atomic<int64_t> workingSinceNs_{0}; // 0: waiting for the head
    std::mutex mutex_;
    std::condition_variable stopped_;
    bool stop_ = false;
    std::thread thread_;
};

} // namespace mural
