// The head's side of the memory that one captured program shares (common/capture_ring.hpp).
// The program may write anything anywhere in it at any time. So nothing is believed: offsets and the
// head's own positions are kept here and only copied out, indices from the ring are read once and
// checked.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/capture_ring.hpp"
#include "common/result.hpp"
#include "nodes/output/pixel_format.hpp"
#include "streamcodec/wire.hpp"
#include "transport/file_descriptor.hpp"

namespace mural {

// The program's own counts, for the report.
struct CaptureCounts {
    uint64_t verifiedFrames = 0;
    uint64_t verifiedPixels = 0;
    uint64_t differingPixels = 0;
    uint64_t squaredDifference = 0;
    uint32_t largestDifference = 0;
    std::array<uint64_t, capture::kUncomparedReasons> uncomparedFrames{}; // by capture::Uncompared
    uint64_t callsUnsupported = 0;
    uint64_t roundTrips = 0;
    std::map<std::string, uint64_t> tripsBy; // command → round trips that it caused
    std::array<uint64_t, capture::kWaits> waitNs{}; // by capture::Wait
    capture::Wait waitingFor = capture::Wait::Nothing; // of a program that is there
    uint64_t frameCpuNs = 0;
    uint64_t frameCpuFrames = 0;
};

// Threads: one for publications and chunks, one for replies; news and the words of progress from any.
class CaptureMemory {
public:
    // Both powers of two.
    static Result<std::unique_ptr<CaptureMemory>> create(
        uint32_t chunkCount = capture::kDefaultChunks, uint32_t replyBytes = capture::kReplyBytes);
    CaptureMemory(const CaptureMemory&) = delete;
    CaptureMemory& operator=(const CaptureMemory&) = delete;
    ~CaptureMemory();

    // For the program. Its file description is another than the head's own, and locked: the kernel releases the lock
    // with the program's last descriptor and mapping.
    [[nodiscard]] int fdToPass() const { return programFd_.get(); }
    void passed() { programFd_ = FileDescriptor(); } // to the program, or on its way there
    // After passed(): nobody has it any more. A program may close all descriptors; it does not unmap what it does not know.
    [[nodiscard]] bool programGone() const;

    struct Range {
        std::span<const std::byte> bytes;
        uint32_t chunk = 0;
        uint16_t stream = 0;
        bool lastOfChunk = false;
    };
    enum class Next { Empty, Ready, Bad };
    Next next(Range& range); // the oldest publication, not taken yet
    bool take(const Range& range); // done with it; false: the ring of freed chunks is corrupt
    [[nodiscard]] uint32_t publishedTail() const;
    [[nodiscard]] uint32_t takenHead() const { return publishedHead_; }
    void waitPublished(capture::Reader how, int64_t timeoutNs); // returns at once when there is something
    void wakePump() const;

    // Writes as much as there is room for.
    size_t writeReply(std::span<const std::byte> bytes);
    void waitReplyRoom(int64_t timeoutNs) const;
    // The answer to a request with capture::kAskedAhead, for the program to find when it wants it.
    void answerAhead(uint32_t request, uint64_t value);

    // False: the program has not looked at what it was told before.
    bool putNews(const wire::News& news, const std::string& text);

    // The format of a window into which the program puts the pictures of this frame itself; nothing: it does not.
    [[nodiscard]] std::optional<PixelFormat> ownWindow(uint32_t window, uint32_t frame) const;

    void setFramesDone(uint32_t frames);
    void setFramesShown(uint32_t frames);
    void beat() { shared_->headBeat.fetch_add(1, std::memory_order_relaxed); } // the head runs
    void setHeadGone(); // and wakes whoever sleeps on any word
    std::atomic<uint32_t>& lifeWord() { return shared_->headLife; } // for a LifeMark
    [[nodiscard]] CaptureCounts counts() const;
    // Of the X displays on which the program has windows, by number.
    [[nodiscard]] std::vector<std::string> displayNames() const;

private:
    CaptureMemory(FileDescriptor fd, FileDescriptor programFd, std::byte* base, const capture::CaptureHeader& layout);
    [[nodiscard]] std::byte* at(uint64_t offset) const { return base_ + offset; }

    const FileDescriptor fd_;
    FileDescriptor programFd_;
    std::byte* base_;
    capture::CaptureHeader* shared_;
    uint32_t chunkCount_;
    uint32_t replyCapacity_;
    uint64_t publicationsAt_, freedAt_, repliesAt_, newsAt_, chunksAt_, totalBytes_;
    uint32_t publishedHead_ = 0;
    uint32_t freedTail_ = 0;
    uint32_t replyTail_ = 0;
    std::mutex newsMutex_;
    uint32_t newsTail_ = 0;
};

} // namespace mural
