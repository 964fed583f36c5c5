// Sends messages over one connection by a thread of its own: two nodes that send to each other never wait for each other's reading.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "transport/connection.hpp"

namespace mural {

// How fast the link was, when it had enough to do.
struct LinkTransfer {
    uint64_t bytes = 0;
    int64_t ns = 0;
};

class PartSender {
public:
    explicit PartSender(Connection& over);
    // What was given still goes out, unless the other end takes nothing.
    ~PartSender();

    // Waits while too many are on their way. Errors: the connection broke, perhaps with a message before this one.
    Result<void> send(std::vector<std::byte> message, Deadline deadline);
    // Since it was last asked; no bytes: nothing that tells.
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
