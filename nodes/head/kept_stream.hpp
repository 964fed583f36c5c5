// What a node that comes late, or again, is given: the shortest stream that is known to bring it to where the others are
// (recording/kept). A thread of its own finds that, behind the stream: nobody who sends waits for it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <thread>
#include <vector>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "recording/kept/kept_packet.hpp"
#include "streamcodec/wire.hpp"

namespace mural::recording {
class KeptStream;
} // namespace mural::recording

namespace mural {

class KeptStream {
public:
    // mostBytes: of memory for what is kept, and as much again for what its thread has not come to.
    explicit KeptStream(uint64_t mostBytes);
    KeptStream(const KeptStream&) = delete;
    KeptStream& operator=(const KeptStream&) = delete;
    ~KeptStream();

    // One after another, under the lock that orders packets. Packets of programs only.
    void append(uint32_t stream, std::span<const std::byte> payload);
    void programGone(uint32_t client);
    // The place in the stream behind all of these, where the thread stops until there was a snapshot of it.
    [[nodiscard]] uint64_t hold();

    struct Snapshot {
        std::vector<recording::KeptPacket> packets; // in their order
        std::vector<wire::ClientFrame> frames;      // the last ones that programs have shown: nobody sees those of the packets
    };
    // Of the stream up to there; once for each place that was held, by any thread. Waits until the thread has come there. Errors: it
    // is too much to be kept; the deadline.
    Result<Snapshot> snapshot(uint64_t place, Deadline deadline);

    [[nodiscard]] bool complete() const { return complete_; } // false: what some program has sent was too much
    [[nodiscard]] uint64_t sizeBytes() const;

private:
    struct Entry {
        uint32_t stream = 0;
        std::vector<std::byte> payload;
        uint32_t clientGone = 0; // not a packet: this program has gone
    };
    void work();
    void take(const Entry& entry);
    void overflow(); // with the lock: nothing is kept of the programs that there are

    const uint64_t mostBytes_;
    uint64_t appended_ = 0; // by those who append

    mutable std::mutex mutex_; // for all up to the thread but what it says
    std::condition_variable changed_;
    std::deque<Entry> entries_; // that the thread has not come to
    uint64_t waitingBytes_ = 0;
    uint64_t taken_ = 0; // entries
    std::multiset<uint64_t> holds_; // the thread takes no entries from the first of these places on
    std::set<uint32_t> programs_;  // that have sent something
    std::set<uint32_t> tooLarge_;  // those of which nothing is kept any more
    std::atomic<bool> complete_{true};
    std::atomic<uint64_t> keptBytes_{0};
    bool inHand_ = false; // the thread is at work on an entry
    bool stop_ = false;

    std::unique_ptr<recording::KeptStream> kept_; // the thread's; a snapshot's while it is held up
    std::map<uint32_t, uint32_t> frames_;         // likewise: by program
    std::mutex snapshots_;                        // one at a time
    std::thread thread_;
};

} // namespace mural
