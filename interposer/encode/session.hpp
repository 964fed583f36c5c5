// The connection to the head: one per process, opened with the first context. It owns the mapping, hands out chunks,
// publishes records, and waits for credit and replies. After the end of the head every call becomes a no-op, and the
// program continues alone. A forked child has no session until it creates a context.
#pragma once

#include <cstdint>

#include "common/ipc/capture_ring.hpp"
#include "interposer/context/thread_state.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

class Session {
public:
    // Returns the process's session. Connects once, if `mural run` has named a head. Null: no capture.
    static Session* get();
    // Like get(), but never connects.
    static Session* current();

    [[nodiscard]] const capture::Welcome& welcome() const { return welcome_; }
    [[nodiscard]] bool alive() const { return __atomic_load_n(&alive_, __ATOMIC_ACQUIRE); }
    [[nodiscard]] capture::CaptureHeader* header() { return header_; }
    // Key of the session's name (common/ipc/window_mark.hpp).
    [[nodiscard]] uint64_t nameKey() const { return nameKey_; }
    // Returns the number of an X display for the head. The head treats equal names as the same display.
    uint32_t displayNumber(const char* name);
    // GL extensions that all nodes have, each surrounded by spaces.
    [[nodiscard]] const char* nodeExtensions() const { return extensions_; }

    // Makes all completed records of the thread visible to the head. `last`: the chunk is used up. `hurry`: the head
    // must read them now and not after its nap.
    void publish(ThreadState& t, bool last, bool hurry = true);
    // Gives the thread a new chunk, after publish(t, true). Returns false if the head has ended.
    bool takeChunk(ThreadState& t);
    // Blocks until the number of pending frames is within the latency, which the head may change meanwhile. Frames
    // faster than capture::kAheadNs may exceed it.
    void waitForCredit();
    // Blocks until all frames of this process are in its windows (--display app). The wait is bounded.
    void waitShown();
    // Waits, with a limit, until the program's windows show no overlay. They show none from then on.
    void hideOverlay();

    // Blocks until the picture of a frame is in the window. Requires announceOwnPut() for the frame, and published
    // records. The wait is bounded.
    void takePictures(uint32_t frame);

    // Begins a request to the nodes, one at a time per process. The round trip counts under `by`, the requesting
    // function.
    uint32_t beginRequest(const char* by);
    // Reads the header of the reply. Returns false if the head has ended; the request is then over.
    bool answerHeader(uint32_t request, wire::ReplyHeader& header);
    // Reads the next bytes of the reply.
    bool answerBytes(void* into, uint64_t sizeBytes);
    void endRequest();
    // Returns the id of a request with a deferred reply (interposer/readback/deferred_replies.hpp).
    uint32_t nextDeferred() {
        return capture::kDeferred |
               (__atomic_add_fetch(&lastDeferred_, 1, __ATOMIC_RELAXED) & (capture::kDeferred - 1));
    }
    // Blocks until the reply has arrived, or the nodes had none. Counts a round trip if the head is not sending it
    // already. Returns false if the head has ended.
    bool waitDeferred(uint32_t request, const char* by);
    // Reads deferred replies that have arrived, so that the head need not store them.
    void takeArrived();
    // Returns the id of a prefetch request, which causes no round trip. prefetchedReply() blocks until its reply has
    // arrived. It returns false if the head has ended or a later reply has replaced this one.
    uint32_t nextAhead() { return capture::kPrefetched | __atomic_add_fetch(&lastAhead_, 1, __ATOMIC_RELAXED); }
    bool prefetchedReply(uint32_t request, uint64_t& value);

    // Call after each frame of the thread. Adds up the thread's CPU time.
    void countFrameCpu(ThreadState& t);
    uint32_t nextFrame() { return __atomic_add_fetch(&framesSubmitted_, 1, __ATOMIC_RELAXED); }
    // Returns whether the nodes have sent driver events that no thread has taken yet.
    [[nodiscard]] bool hasDriverEvents() const {
        return header_ && header_->driverEventTail.load(std::memory_order_relaxed) !=
                              __atomic_load_n(&driverEventsTaken_, __ATOMIC_RELAXED);
    }
    // Takes the oldest driver event; false: none. `text` needs room for capture::kDriverEventTextBytes and a
    // terminator. One thread at a time.
    bool takeDriverEvents(wire::DriverEvent& event, char* text);
    void die(const char* why);

private:
    bool connect();
    bool takeDeferred(const wire::ReplyHeader& header);
    bool takePicture(const wire::ReplyHeader& header);
    [[nodiscard]] bool replyWaits() const;
    bool headAlive();
    [[nodiscard]] bool publishLocked(ThreadState& t, bool last); // false: no records, or no room
    void wakeReader(bool fromNap);
    [[nodiscard]] bool mayGoAhead(uint32_t submitted, uint32_t done, int64_t nowNs) const;
    [[nodiscard]] uint32_t latency() const { return header_->latency.load(std::memory_order_relaxed); }
    [[nodiscard]] uint32_t framesSubmitted() const { return __atomic_load_n(&framesSubmitted_, __ATOMIC_RELAXED); }

    capture::CaptureHeader* header_ = nullptr;
    capture::Welcome welcome_{};
    const char* extensions_ = "";
    uint64_t nameKey_ = 0;
    bool alive_ = false;
    uint32_t framesSubmitted_ = 0;                    // of all threads
    int64_t submittedNs_[capture::kAheadFrames] = {}; // submission time of frame n at index n modulo kAheadFrames
    uint32_t lastRequest_ = 0;
    uint32_t lastAhead_ = 0;
    uint32_t lastDeferred_ = 0;
    uint32_t driverEventsTaken_ = 0;
    uint32_t picturesTaken_ = 0; // latest frame whose picture was taken; guarded by the request lock
};

// Returns true if the thread has a context and the head lives, so that Mural captures the thread's calls.
[[nodiscard]] inline bool capturing(const ThreadState& t) {
    const Session* s = Session::current();
    return t.context && s && s->alive();
}

} // namespace mural
