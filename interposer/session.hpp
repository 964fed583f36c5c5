// The connection to the head: one per process, opened with the first context. Owns the mapping, hands
// out chunks, publishes what was encoded, waits for credit and answers. When the head is gone every
// call becomes a no-op and the program goes on alone. A forked child has none until it makes a context.
#pragma once

#include <cstdint>

#include "common/capture_ring.hpp"
#include "interposer/thread_state.hpp"
#include "streamcodec/wire.hpp"

namespace mural {

class Session {
public:
    // The process's session; connects once, when `mural run` has named a head. Null: no capture.
    static Session* get();
    // Like get(), but never connects.
    static Session* current();

    [[nodiscard]] const capture::Welcome& welcome() const { return welcome_; }
    [[nodiscard]] bool alive() const { return __atomic_load_n(&alive_, __ATOMIC_ACQUIRE); }
    [[nodiscard]] capture::CaptureHeader* header() { return header_; }
    // Of the session's name (common/window_mark.hpp).
    [[nodiscard]] uint64_t nameKey() const { return nameKey_; }
    // The number by which the head knows the X display of this name. It takes the same name for the same display.
    uint32_t displayNumber(const char* name);
    // Extensions that all nodes have, with a space before and behind each.
    [[nodiscard]] const char* nodeExtensions() const { return extensions_; }

    // Makes all complete records of the thread visible to the head. `last`: the chunk is used up. `hurry`: the
    // head is to read it now, and not when its nap is over.
    void publish(ThreadState& t, bool last, bool hurry = true);
    // A fresh chunk for the thread (after publish(t, true)); false when the head is gone.
    bool takeChunk(ThreadState& t);
    // Blocks until no more frames are on their way than the session's latency allows. Frames faster than
    // capture::kAheadNs may be some more.
    void waitForCredit();
    // Blocks until all frames of this process are in its windows (--display app); bounded.
    void waitShown();

    // For a frame that announceOwnPut() has announced, after its records are published: until its picture is in the
    // window; bounded.
    void takePictures(uint32_t frame);

    // One question to the nodes at a time per process; `by` is the function that asks, counted under its name.
    uint32_t beginRequest(const char* by);
    // The head of the answer; false when the head died (the request is over then).
    bool answerHeader(uint32_t request, wire::ReplyHeader& header);
    // The next bytes of the answer.
    bool answerBytes(void* into, uint64_t sizeBytes);
    void endRequest();
    // The id of a question whose answer is taken later (interposer/owed_answers.hpp).
    uint32_t nextOwed() { return capture::kOwed | (__atomic_add_fetch(&lastOwed_, 1, __ATOMIC_RELAXED) & (capture::kOwed - 1)); }
    // Until it is here, or came as none; a round trip when it is not on its way from the head already. False: the head
    // died.
    bool waitOwed(uint32_t request, const char* by);
    // Takes what has come of such answers, so that the head need not keep them.
    void takeArrived();
    // The same for an answer that is read later: no round trip. Waits until it is there; false when the head died
    // or the answer's place has been taken by another's.
    uint32_t nextAhead() { return capture::kAskedAhead | __atomic_add_fetch(&lastAhead_, 1, __ATOMIC_RELAXED); }
    bool aheadAnswer(uint32_t request, uint64_t& value);

    // After each frame of the thread: what it costs the program.
    void countFrameCpu(ThreadState& t);
    uint32_t nextFrame() { return __atomic_add_fetch(&framesSubmitted_, 1, __ATOMIC_RELAXED); }
    // The nodes have told something that no thread has taken yet.
    [[nodiscard]] bool newsWaiting() const {
        return header_ && header_->newsTail.load(std::memory_order_relaxed) != __atomic_load_n(&newsTaken_, __ATOMIC_RELAXED);
    }
    // The oldest; false: there is none. text has room for capture::kNewsTextBytes and an end. One thread at a time.
    bool takeNews(wire::News& news, char* text);
    void die(const char* why);

private:
    bool connect();
    bool takeOwed(const wire::ReplyHeader& header);
    bool takePicture(const wire::ReplyHeader& header);
    [[nodiscard]] bool replyWaits() const;
    bool headAlive();
    [[nodiscard]] bool publishLocked(ThreadState& t, bool last); // false: there was nothing, or no room
    void wakeReader(bool fromNap);
    [[nodiscard]] bool mayGoAhead(uint32_t submitted, uint32_t done, int64_t nowNs) const;
    [[nodiscard]] uint32_t framesSubmitted() const { return __atomic_load_n(&framesSubmitted_, __ATOMIC_RELAXED); }

    capture::CaptureHeader* header_ = nullptr;
    capture::Welcome welcome_{};
    const char* extensions_ = "";
    uint64_t nameKey_ = 0;
    bool alive_ = false;
    uint32_t framesSubmitted_ = 0; // by all threads
    int64_t submittedNs_[capture::kAheadFrames] = {}; // of frame n at n modulo their number
    uint32_t lastRequest_ = 0;
    uint32_t lastAhead_ = 0;
    uint32_t lastOwed_ = 0;
    uint32_t newsTaken_ = 0;
    uint32_t picturesTaken_ = 0; // the latest frame among them; under the lock of questions
};

} // namespace mural
