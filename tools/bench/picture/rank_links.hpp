// Processes of one benchmark with a socket pair between any two. A thread per peer sends data in place; the waiting
// thread receives. Equal for Mural and IceT, so only their data and computation differ.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"

namespace mural::bench {

// All sockets, created before the processes.
class RankSockets {
public:
    static Result<RankSockets> make(int ranks);
    [[nodiscard]] int ranks() const { return static_cast<int>(ends_.size()); }
    [[nodiscard]] int end(int own, int other) const {
        return ends_[static_cast<size_t>(own)][static_cast<size_t>(other)];
    }
    void closeAll();
    // Closes the sockets of other processes.
    void closeOthers(int own);

private:
    std::vector<std::vector<int>> ends_; // per pair of ranks; -1 on the diagonal
};

struct RankMessage {
    uint64_t tag = 0;
    std::vector<std::byte> bytes;
};

class RankLinks {
public:
    RankLinks(const RankSockets& sockets, int own);
    ~RankLinks();
    RankLinks(const RankLinks&) = delete;

    [[nodiscard]] int own() const { return own_; }
    [[nodiscard]] int ranks() const { return static_cast<int>(peers_.size()); }

    // Sends bytes, which must stay valid until sent(number) is true.
    uint64_t post(int to, uint64_t tag, std::span<const std::byte> bytes);
    void waitSent(int to, uint64_t number);
    // Returns the next message with that tag; others stay queued.
    RankMessage take(int from, uint64_t tag);
    // Receives into the given memory; returns the number of bytes.
    size_t takeInto(int from, uint64_t tag, std::span<std::byte> into);
    // Returns true if a message with that tag is available, or begins to arrive.
    bool waiting(int from, uint64_t tag);
    // Blocks until data arrives from one of these ranks.
    void waitForAny(const std::vector<int>& from);

    void barrier();
    [[nodiscard]] uint64_t bytesSent() const { return bytesSent_; }
    // Returns bytes and time of the sending thread since the last call.
    std::pair<uint64_t, int64_t> takeTransfer(int to);

private:
    struct Posted {
        uint64_t tag;
        std::span<const std::byte> bytes;
    };
    struct Peer {
        int socket = -1;
        std::mutex mutex;
        std::condition_variable changed;
        std::deque<Posted> outgoing;
        uint64_t posted = 0, sent = 0, transferBytes = 0;
        int64_t transferNs = 0;
        bool stop = false;
        std::deque<RankMessage> came; // received while waiting for another message
        std::thread sender;
    };
    void send(Peer& peer);
    static void readAll(Peer& peer, std::span<std::byte> into);

    const int own_;
    std::vector<std::unique_ptr<Peer>> peers_;
    uint64_t bytesSent_ = 0;
};

} // namespace mural::bench
