// Processes of one bench, each with a pair of sockets to each other one. What is sent goes out by a thread of its own for each peer, from
// where it lies; what comes is read by who waits for it. The same for ours and for IceT, so that what differs is what they send and compute.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "common/clock.hpp"
#include "common/result.hpp"

namespace mural::bench {

// All ends, made before the processes are.
class RankSockets {
public:
    static Result<RankSockets> make(int ranks);
    [[nodiscard]] int ranks() const { return static_cast<int>(ends_.size()); }
    [[nodiscard]] int end(int own, int other) const { return ends_[static_cast<size_t>(own)][static_cast<size_t>(other)]; }
    void closeAll();
    // All but those of this process.
    void closeOthers(int own);

private:
    std::vector<std::vector<int>> ends_; // of a rank to each other; -1 to itself
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

    // The bytes stay where they are until sent(number) is true.
    uint64_t post(int to, uint64_t tag, std::span<const std::byte> bytes);
    void waitSent(int to, uint64_t number);
    // The next message of that tag; others stay.
    RankMessage take(int from, uint64_t tag);
    // Straight to where it is wanted; how many bytes came.
    size_t takeInto(int from, uint64_t tag, std::span<std::byte> into);
    // Whether something of that tag can be taken, or begins to come.
    bool waiting(int from, uint64_t tag);
    // Until anything comes from one of them.
    void waitForAny(const std::vector<int>& from);

    void barrier();
    [[nodiscard]] uint64_t bytesSent() const { return bytesSent_; }
    // Of the thread that sends to that rank, since it was last asked.
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
        std::deque<RankMessage> came; // read while another was waited for
        std::thread sender;
    };
    void send(Peer& peer);
    static void readAll(Peer& peer, std::span<std::byte> into);

    const int own_;
    std::vector<std::unique_ptr<Peer>> peers_;
    uint64_t bytesSent_ = 0;
};

} // namespace mural::bench
