// Sends messages over one connection on its own thread, so that two nodes that send to each other never deadlock.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "transport/connection.hpp"

namespace mural {

// Bytes and time of a busy link, for bandwidth estimates.
struct LinkTransfer {
    uint64_t bytes = 0;
    int64_t ns = 0;
};

class PartSender {
public:
    explicit PartSender(Connection& over);
    // Sends queued messages first, unless the peer does not read.
    ~PartSender();

    // Waits while the queue is full. Errors: the connection failed, possibly at an earlier message.
    Result<void> send(std::vector<std::byte> message, Deadline deadline);
    // The transfer since the last call. Zero bytes: no usable measurement.
    LinkTransfer takeTransfer();

private:
    void run();

    Connection& over_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::vector<std::byte>> waiting_;
    std::string failure_; // empty: none
    LinkTransfer transfer_;
    bool stop_ = false;
    std::thread thread_;
};

} // namespace mural
