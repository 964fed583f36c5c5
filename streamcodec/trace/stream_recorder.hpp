// Records the stream that the head sends to the nodes, on a thread of its own. An error ends the recording with one
// line; the session continues. The recording begins with the stream, or at a later position with a snapshot.
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/base/clock.hpp"
#include "streamcodec/snapshot/snapshot_packet.hpp"
#include "streamcodec/trace/frame_numbers.hpp"
#include "streamcodec/trace/trace_writer.hpp"

namespace mural::trace {

struct RecorderConfig {
    size_t queueBytes = size_t{64} << 20; // when full, senders wait
    int64_t patienceMs = 5'000;           // timeout without progress of a full queue; then the recording ends
    int64_t lastFrame = 0;                // wall frame after which nothing is recorded; 0: all frames
    int64_t wholeEveryMs = 1'000;         // older data is in the file even if the head dies
};

// The stream before the position at which a recording begins.
struct StreamBefore {
    std::vector<ClientEvent> programs; // that exist at the position
    std::vector<snapshot::SnapshotPacket> packets;
    WallFrames wall;
};

// Call begin(), beginAfter() and finish() on one thread; the others may be called from any thread.
class StreamRecorder {
public:
    // Creates the file.
    static Result<std::unique_ptr<StreamRecorder>> create(const std::string& path, RecorderConfig config);
    // Creates a recorder without a file. Packets wait in its queue for beginAfter().
    static std::unique_ptr<StreamRecorder> createWaiting(const std::string& path, RecorderConfig config);
    StreamRecorder(const StreamRecorder&) = delete;
    StreamRecorder& operator=(const StreamRecorder&) = delete;
    ~StreamRecorder(); // without finish() the file has no end

    void begin(const About& about); // call before any packet
    // Creates the file. It begins with the state before the first packet, and frames have numbers from 1. After an
    // error there is no file.
    Result<void> beginAfter(const About& about, StreamBefore before);
    void discard(); // drops all packets from now on, and lets waiting senders continue
    void packet(uint32_t stream, std::span<const std::byte> payload);
    void event(const ClientEvent& event);
    // Blocks until everything is written, including index and trailer. Reports an error if the deadline passes.
    WriterTotals finish(Deadline deadline);

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] bool hasEnded() const { return ended_; } // after an error
    [[nodiscard]] int64_t frames() const { return wholeFrames_; }
    [[nodiscard]] uint64_t fileBytes() const { return fileBytes_; }

private:
    StreamRecorder(std::string path, std::unique_ptr<TraceWriter> writer, RecorderConfig config);
    void put(uint32_t stream, std::span<const std::byte> payload);
    void work();
    Result<void> writeBefore();
    Result<void> writeAll(std::span<std::byte> entries);
    void end(const std::string& why); // reports once

    const std::string path_;
    std::unique_ptr<TraceWriter> writer_;      // owned by the thread once it runs, as the next two
    StreamBefore before_;                      // empty if the recording begins with the stream
    std::optional<FrameNumbers> frameNumbers_; // nothing if the recording begins with the stream
    const RecorderConfig config_;
    const int64_t beganNs_ = monotonicNowNs();
    std::atomic<bool> ended_{false};
    std::atomic<int64_t> wholeFrames_{0}; // in the file
    std::atomic<uint64_t> fileBytes_{0};

    std::mutex mutex_; // protects the following members
    std::condition_variable changed_;
    std::vector<std::byte> queue_; // serialised entries
    bool finishing_ = false;
    bool stop_ = false;
    bool done_ = false;
    WriterTotals totals_;

    std::thread thread_; // last member: it uses all others
};

} // namespace mural::trace
