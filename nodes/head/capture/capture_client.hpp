// One captured program, with two threads. The pump sends the program's publications to the nodes. The other thread
// writes the nodes' replies to the program.
//
// CaptureMemory::programGone detects the program's end, because the program may close its socket earlier. The head's
// end of the socket closes with this object, which informs the player.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <sys/types.h>
#include <thread>

#include "nodes/head/capture/arrival_rate.hpp"
#include "nodes/head/capture/frame_comparer.hpp"
#include "nodes/head/results/byte_buffer.hpp"
#include "nodes/head/capture/capture_memory.hpp"
#include "nodes/head/broadcast/stream_broadcaster.hpp"
#include "nodes/head/statistics/pump_spans.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

class CaptureEvents {
public:
    virtual ~CaptureEvents() = default;
    // Called by the pump's thread as its last action, after all publications of the program were sent to the nodes. Not
    // called if drain() ended the pump, because the program still exists then. problem: the reason for dropping the
    // program; empty: it ended by itself.
    virtual void programEnded(uint32_t client, const std::string& problem) = 0;
};

struct Reply {
    wire::ReplyHeader header{};
    ByteBuffer bytes;
    std::function<void()> written; // called after the complete reply was written to the program's memory; may be empty
};

// Receives the frames of all programs, compared with the previous ones.
struct SentFrames {
    std::atomic<bool> areWanted{false}; // otherwise frames are not compared
    // Called by the pump's thread before it sends any command of the next frame.
    std::function<void(const SentFrame&)> add;
};

// Thread-safe.
class CaptureClient {
public:
    // statistics: null: none. sentFrames: null: none.
    CaptureClient(uint32_t id, pid_t pid, capture::ProgramKind kind, std::unique_ptr<CaptureMemory> memory,
                  StreamBroadcaster& nodes, CaptureEvents& events, FrameStatistics* statistics, SentFrames* sentFrames);
    ~CaptureClient(); // calls stop()

    // Errors: no threads available.
    Result<void> start(FileDescriptor socket);
    // Ends the pump after everything published before this call was sent.
    void drain();
    // Ends both threads soon. Drops the remaining data.
    void stop();
    // Lets the pump detect the program's end now instead of at its next interval. No effect on a running program.
    void detectEnd();

    void reply(Reply reply);
    CaptureMemory& memory() { return *memory_; }
    [[nodiscard]] uint32_t id() const { return id_; }
    [[nodiscard]] pid_t pid() const { return pid_; }
    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] uint64_t bytesSent() const { return bytesSent_.load(std::memory_order_relaxed); } // to each node
    [[nodiscard]] bool pumpEnded() const { return pumpEnded_.load(std::memory_order_acquire); }
    [[nodiscard]] std::string describe() const; // "program 2 (glxgears, pid 77)"

private:
    void pump();
    void waitForMore();
    void reportEnd();
    void send(const CaptureMemory::Range& range);
    bool pumpNext(CaptureMemory::Range& range); // returns false if there is no publication, or the ring is corrupt
    [[nodiscard]] bool drained() const;
    [[nodiscard]] bool programGone() const;
    void flushNodes(bool all = true);
    void drop(const std::string& problem);

    void writeReplies();
    bool writeAll(std::span<const std::byte> bytes);

    const uint32_t id_;
    const pid_t pid_;
    const capture::ProgramKind kind_;
    const std::string name_;
    const std::unique_ptr<CaptureMemory> memory_;
    StreamBroadcaster& nodes_;
    CaptureEvents& events_;
    FileDescriptor socket_;
    std::thread pumpThread_;
    std::thread replyThread_;
    size_t unflushedBytes_ = 0; // used by the pump's thread, as the next six
    bool arrived_ = false;      // data arrived since the last wait
    int64_t arrivedNs_ = 0;     // start of the last wait after arrived data
    ArrivalRate pace_;
    PumpSpans spans_;
    SentFrames* const sentFrames_;
    FrameComparer frames_;
    std::atomic<bool> stop_{false};
    std::atomic<bool> draining_{false};
    std::atomic<uint32_t> drainTail_{0};
    std::atomic<bool> pumpEnded_{false};
    std::atomic<uint64_t> bytesSent_{0};

    std::mutex mutex_; // guards the members below
    std::condition_variable replyQueued_;
    std::deque<Reply> replies_;
    size_t replyQueueBytes_ = 0;
    std::string problem_;
};

} // namespace mural
