// One captured program: a thread that pumps its publications to the nodes, and a thread that hands it the
// nodes' answers. Its memory says whether it lives (CaptureMemory::programGone). The program may have
// closed its end of the socket; the head's end is closed with the client, which tells the player.
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

#include "nodes/head/arrival_pace.hpp"
#include "nodes/head/byte_buffer.hpp"
#include "nodes/head/capture_memory.hpp"
#include "nodes/head/node_set.hpp"
#include "streamcodec/wire.hpp"

namespace mural {

class CaptureEvents {
public:
    virtual ~CaptureEvents() = default;
    // From the pump's thread, as its last act; everything that the program had published is with the
    // nodes. problem: why the program was dropped, empty when it ended by itself. Not called when the
    // pump ends because of drain(): the program is still there then.
    virtual void programEnded(uint32_t client, const std::string& problem) = 0;
};

struct Reply {
    wire::ReplyHeader header{};
    ByteBuffer bytes;
    std::function<void()> written; // the program has all of it before it; may be empty
};

// All calls from any thread.
class CaptureClient {
public:
    CaptureClient(uint32_t id,
                  pid_t pid,
                  std::unique_ptr<CaptureMemory> memory,
                  NodeSet& nodes,
                  CaptureEvents& events);
    ~CaptureClient(); // stop()

    // An error: there are no threads for it.
    Result<void> start(FileDescriptor socket);
    // Pumps what is published at this moment, then ends the pump.
    void drain();
    // Ends both threads soon, whatever is left.
    void stop();

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
    bool pumpNext(CaptureMemory::Range& range); // false: nothing there, or a corrupt ring
    [[nodiscard]] bool drained() const;
    [[nodiscard]] bool programGone() const;
    void flushNodes(bool all = true);
    void drop(const std::string& problem);

    void writeReplies();
    bool writeAll(std::span<const std::byte> bytes);

    const uint32_t id_;
    const pid_t pid_;
    const std::string name_;
    const std::unique_ptr<CaptureMemory> memory_;
    NodeSet& nodes_;
    CaptureEvents& events_;
    FileDescriptor socket_;
    std::thread pumpThread_;
    std::thread replyThread_;
    size_t unflushedBytes_ = 0; // the pump's, as the next three
    bool arrived_ = false;      // something since it last waited
    int64_t arrivedNs_ = 0;     // when it last waited after something
    ArrivalPace pace_;
    std::atomic<bool> stop_{false};
    std::atomic<bool> draining_{false};
    std::atomic<uint32_t> drainTail_{0};
    std::atomic<bool> pumpEnded_{false};
    std::atomic<uint64_t> bytesSent_{0};

    std::mutex mutex_; // what follows
    std::condition_variable replyQueued_;
    std::deque<Reply> replies_;
    size_t replyQueueBytes_ = 0;
    std::string problem_;
};

} // namespace mural
