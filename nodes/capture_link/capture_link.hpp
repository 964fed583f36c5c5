// The connection of a program to a head, without GL, for replayed programs and those with the native API: the program's
// side of a capture's shared memory (common/ipc/capture_ring.hpp). Used by one thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/ipc/capture_ring.hpp"
#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "streamcodec/wire/replies.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural {

class CaptureLink {
public:
    static Result<std::unique_ptr<CaptureLink>> connect(const std::string& session, capture::ProgramKind kind,
                                                        Deadline deadline);
    CaptureLink(const CaptureLink&) = delete;
    CaptureLink& operator=(const CaptureLink&) = delete;
    ~CaptureLink();

    [[nodiscard]] const capture::Welcome& welcome() const { return welcome_; }
    [[nodiscard]] bool headGone() const { return header_->headGone.load() != 0; }

    // These functions do not block. After a failure, wait on the word that follows the function.
    bool publish(uint16_t thread, std::span<const std::byte> packet); // false: no chunk is free
    [[nodiscard]] const std::atomic<uint32_t>& chunkWord() const { return header_->freedTail; }
    [[nodiscard]] bool allTaken() const; // wait on chunkWord()

    void submitted(uint32_t frame) { header_->framesSubmitted.store(frame, std::memory_order_relaxed); }
    bool mayGoOn(uint32_t submittedFrame); // applies the session's current latency
    [[nodiscard]] const std::atomic<uint32_t>& framesWord() const { return header_->framesDone; }

    // Receives each reply. Without it, replies are dropped.
    using TakeReply = std::function<void(const wire::ReplyHeader& header, std::span<const std::byte> bytes)>;
    void onReply(TakeReply take) { takeReply_ = std::move(take); }
    void requested() { ++requested_; }
    [[nodiscard]] uint64_t unanswered(); // takes received replies; returns the number of missing ones
    [[nodiscard]] const std::atomic<uint32_t>& answersWord() const { return header_->replyTail; }

    // Ends the program. Only gone() may be called afterwards. It returns true after the head has detected the end and
    // informed the nodes.
    void leave();
    bool gone(int64_t sliceMs);

private:
    CaptureLink(FileDescriptor socket, const capture::Welcome& welcome, capture::CaptureHeader* header,
                size_t sizeBytes);
    void takeAnswers();

    FileDescriptor socket_; // closed by the head after it has detected the end
    const capture::Welcome welcome_;
    capture::CaptureHeader* header_; // null: the program has left
    const size_t sizeBytes_;
    uint64_t requested_ = 0;
    uint64_t answered_ = 0;
    wire::ReplyHeader reply_{};
    size_t replyHeaderBytes_ = 0; // received bytes of reply_
    uint64_t replyBytes_ = 0;     // missing bytes after the header
    TakeReply takeReply_;
    std::vector<std::byte> replyContent_; // received bytes, if takeReply_ is set
};

} // namespace mural
