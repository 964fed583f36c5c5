// The rejoin log, from which restarted nodes receive snapshots: the shortest known stream to the current state
// (streamcodec/snapshot). A background thread reduces the log, so that senders never wait for it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <thread>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "streamcodec/snapshot/kept_stream.hpp"
#include "streamcodec/trace/wall_frames.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

class RejoinLog {
public:
    // Makes an empty log with this limit of bytes.
    using MakeStream = std::function<std::unique_ptr<snapshot::KeptStream>(size_t maxBytes)>;
    // maxBytes: memory for the reduced log, and as much again for entries that the thread has not processed.
    RejoinLog(uint64_t maxBytes, MakeStream makeStream);
    RejoinLog(const RejoinLog&) = delete;
    RejoinLog& operator=(const RejoinLog&) = delete;
    ~RejoinLog();

    // Appends a packet of a program. Call with the lock that orders packets.
    void append(uint32_t stream, std::span<const std::byte> payload);
    void programGone(uint32_t client);
    // Returns the current position of the stream. The thread pauses there until a snapshot of the position exists.
    [[nodiscard]] uint64_t pause();

    struct Snapshot {
        std::vector<snapshot::SnapshotPacket> packets; // in stream order
        std::vector<wire::ClientFrame> frames; // the last frame of each program; the frames in `packets` are not shown
        trace::WallFrames wall;                // the frames of the wall so far
    };
    // Returns the snapshot of a held position; once per pause(), from any thread. Waits until the log's thread reaches
    // the position and makes the snapshot. Errors: the log has overflowed; the deadline has passed.
    Result<Snapshot> snapshot(uint64_t position, Deadline deadline);

    [[nodiscard]] bool complete() const { return complete_; } // false: the log of some program has overflowed
    [[nodiscard]] uint64_t sizeBytes() const;

private:
    struct Entry {
        uint32_t stream = 0;
        std::vector<std::byte> payload;
        uint32_t clientGone = 0; // nonzero: not a packet, but the end of this program
    };
    struct Request { // of a snapshot
        uint64_t position = 0;
        bool hasBegun = false, isDone = false;
        std::optional<Snapshot> snapshot; // none: the log has overflowed
    };
    void work();
    [[nodiscard]] std::shared_ptr<Request> dueRequest() const; // with the lock held; null: none
    void serve(Request& request, std::unique_lock<std::mutex>& lock);
    void countFrames(const Entry& entry);
    void take(const Entry& entry);
    void overflow(); // with the lock held: discards the log of all current programs

    const uint64_t maxBytes_;
    const MakeStream makeStream_;
    uint64_t appended_ = 0; // accessed by appending threads only

    mutable std::mutex mutex_; // guards all members except the thread's own
    std::condition_variable changed_;
    std::deque<Entry> entries_; // not yet processed
    uint64_t waitingBytes_ = 0;
    uint64_t taken_ = 0;             // number of processed entries
    std::multiset<uint64_t> pauses_; // the thread pauses at the first of these positions
    std::vector<std::shared_ptr<Request>> requests_;
    std::set<uint32_t> programs_; // programs that have sent packets
    std::set<uint32_t> tooLarge_; // programs whose log was discarded
    std::atomic<bool> complete_{true};
    std::atomic<uint64_t> logBytes_{0};
    bool stop_ = false;

    std::unique_ptr<snapshot::KeptStream> snapshot_; // used by the thread only, as the next two
    std::map<uint32_t, uint32_t> frames_;            // last frame by program
    trace::WallFrames wall_;                         // includes programs whose log was discarded
    std::thread thread_;
};

} // namespace mural
