// One program towards a head, without GL: the shared memory of a capture (common/capture_ring.hpp) from the program's side.
// Used by one thread. Answers are taken and dropped.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "common/capture_ring.hpp"
#include "common/clock.hpp"
#include "common/result.hpp"
#include "streamcodec/wire.hpp"
#include "transport/file_descriptor.hpp"

namespace mural {

class CaptureLink {
public:
    static Result<std::unique_ptr<CaptureLink>> connect(const std::string& session, Deadline deadline);
    CaptureLink(const CaptureLink&) = delete;
    CaptureLink& operator=(const CaptureLink&) = delete;
    ~CaptureLink();

    [[nodiscard]] const capture::Welcome& welcome() const { return welcome_; }
    [[nodiscard]] bool headGone() const { return header_->headGone.load() != 0; }

    // Each returns at once; what it needs is waited for on the word beside it.
    bool publish(uint16_t thread, std::span<const std::byte> packet); // false: no chunk is free
    [[nodiscard]] const std::atomic<uint32_t>& chunkWord() const { return header_->freedTail; }
    [[nodiscard]] bool allTaken() const; // the same word

    void submitted(uint32_t frame) { header_->framesSubmitted.store(frame, std::memory_order_relaxed); }
    bool mayGoOn(uint32_t submittedFrame); // by the session's latency
    [[nodiscard]] const std::atomic<uint32_t>& framesWord() const { return header_->framesDone; }

    void asked() { ++asked_; }
    [[nodiscard]] uint64_t unanswered(); // so many questions, after what has come was dropped
    [[nodiscard]] const std::atomic<uint32_t>& answersWord() const { return header_->replyTail; }

    // The program ends here: nothing but gone() may follow, which is true once the head has seen that and the nodes
    // have heard of it.
    void leave();
    bool gone(int64_t sliceMs);

private:
    CaptureLink(FileDescriptor socket, const capture::Welcome& welcome, capture::CaptureHeader* header, size_t sizeBytes);
    void takeAnswers();

    FileDescriptor socket_; // says whether the head has seen the end
    const capture::Welcome welcome_;
    capture::CaptureHeader* header_; // null: the program has left
    const size_t sizeBytes_;
    uint64_t asked_ = 0;
    uint64_t answered_ = 0;
    wire::ReplyHeader reply_{};
    size_t replyHeaderBytes_ = 0; // that have come
    uint64_t replyBytes_ = 0;     // that are still to come, behind the header
};

} // namespace mural
