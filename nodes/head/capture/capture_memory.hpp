// The head's side of the memory that it shares with one captured program (common/ipc/capture_ring.hpp).
//
// The program may write anything anywhere in it at any time, so the head trusts nothing. It keeps offsets and its own
// positions in private memory and only copies them out. It reads indices of the ring once and checks them.
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

#include "common/ipc/capture_ring.hpp"
#include "common/base/result.hpp"
#include "nodes/output/pixel_format.hpp"
#include "streamcodec/wire/replies.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural {

// Counters of the program, for the report.
struct CaptureCounts {
    uint64_t verifiedFrames = 0;
    uint64_t verifiedPixels = 0;
    uint64_t differingPixels = 0;
    uint64_t squaredDifference = 0;
    uint32_t largestDifference = 0;
    std::array<uint64_t, capture::kUncomparedReasons> uncomparedFrames{}; // by capture::Uncompared
    uint64_t callsUnsupported = 0;
    std::map<std::string, uint64_t> unsupportedBy; // number of unsupported calls by command
    uint64_t roundTrips = 0;
    std::map<std::string, uint64_t> tripsBy;           // number of round trips by command
    std::array<uint64_t, capture::kWaits> waitNs{};    // by capture::Wait
    capture::Wait waitingFor = capture::Wait::Nothing; // current wait of a running program
    uint64_t frameCpuNs = 0;
    uint64_t frameCpuFrames = 0;
};

// Threads: one for publications and chunks, and one for replies. Driver events and the progress words may come from any
// thread.
class CaptureMemory {
public:
    // Requires powers of two.
    static Result<std::unique_ptr<CaptureMemory>> create(uint32_t chunkCount = capture::kDefaultChunks,
                                                         uint32_t replyBytes = capture::kReplyBytes);
    CaptureMemory(const CaptureMemory&) = delete;
    CaptureMemory& operator=(const CaptureMemory&) = delete;
    ~CaptureMemory();

    // Returns the descriptor for the program. Its file description differs from the head's own and has a lock. The
    // kernel releases the lock with the program's last descriptor and mapping.
    [[nodiscard]] int fdToPass() const { return programFd_.get(); }
    void passed() { programFd_ = FileDescriptor(); } // call after the descriptor was sent to the program
    // Returns whether no process has the memory open or mapped. Requires passed(). A program may close all descriptors,
    // but does not unmap memory that is unknown to it.
    [[nodiscard]] bool programGone() const;

    struct Range {
        std::span<const std::byte> bytes;
        uint32_t chunk = 0;
        uint16_t stream = 0;
        bool lastOfChunk = false;
    };
    enum class Next { Empty, Ready, Bad };
    Next next(Range& range);       // the oldest publication that was not taken
    bool take(const Range& range); // releases the publication; false: the ring of freed chunks is corrupt
    [[nodiscard]] uint32_t publishedTail() const;
    [[nodiscard]] uint32_t takenHead() const { return publishedHead_; }
    void waitPublished(capture::Reader how, int64_t timeoutNs); // returns at once if a publication exists
    void wakePump() const;

    // Writes as much as fits. Returns the number of bytes.
    size_t writeReply(std::span<const std::byte> bytes);
    void waitReplyRoom(int64_t timeoutNs) const;
    // Stores the reply to a request with capture::kPrefetched. The program reads it when it needs the value.
    void answerAhead(uint32_t request, uint64_t value);

    // Returns false if all slots hold events that the program has not read.
    bool putDriverEvent(const wire::DriverEvent& event, const std::string& text);

    // Returns the format of the window if the program itself puts this frame's picture into it, otherwise nullopt.
    [[nodiscard]] std::optional<PixelFormat> ownWindow(uint32_t window, uint32_t frame) const;

    // Sets the frames that the program may be ahead, and wakes its waiting threads.
    void setLatency(uint32_t frames);
    void setFramesDone(uint32_t frames);
    void setFramesShown(uint32_t frames);
    // Announces that windows of the program show an overlay from now on. Returns false if the program reads its
    // windows: endOverlay() then follows when none shows it.
    bool beginOverlay();
    void endOverlay();
    void beat() { shared_->headBeat.fetch_add(1, std::memory_order_relaxed); } // heartbeat of the head
    void setHeadGone();                                                        // also wakes the waiters on all words
    std::atomic<uint32_t>& livenessWord() { return shared_->headLiveness; }    // the word of a LivenessMark
    [[nodiscard]] CaptureCounts counts() const;
    // A part of the counters, for the statistics of frames.
    [[nodiscard]] std::array<uint64_t, capture::kWaits> waitNs() const;
    // Names of the X displays on which the program has windows, by number.
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
    uint64_t publicationsAt_, freedAt_, repliesAt_, driverEventsAt_, chunksAt_, totalBytes_;
    uint32_t publishedHead_ = 0;
    uint32_t freedTail_ = 0;
    uint32_t replyTail_ = 0;
    std::mutex driverEventMutex_;
    uint32_t driverEventTail_ = 0;
};

} // namespace mural
