// Records what the head sends to the nodes while programs run, by a thread of its own. What goes wrong ends the recording and
// is said in one line; the session goes on.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "common/clock.hpp"
#include "recording/file_writer.hpp"

namespace mural::recording {

struct RecorderConfig {
    size_t queueBytes = size_t{64} << 20; // full: senders wait
    int64_t patienceMs = 5'000;           // while nothing of a full queue is taken: then the recording ends
    int64_t lastFrame = 0;                // of the wall: no packet behind it is recorded; 0: all
    int64_t wholeEveryMs = 1'000;         // what is older is in the file, whatever becomes of the head
    std::function<void(const std::string&)> say;
};

// begin() and finish() by one thread, the others by any.
class StreamRecorder {
public:
    // The file is there from now on.
    static Result<std::unique_ptr<StreamRecorder>> create(const std::string& path, RecorderConfig config);
    StreamRecorder(const StreamRecorder&) = delete;
    StreamRecorder& operator=(const StreamRecorder&) = delete;
    ~StreamRecorder(); // what has not been finished by then lacks its end

    void begin(const About& about); // before all packets
    void packet(uint32_t stream, std::span<const std::byte> payload);
    void event(const ClientEvent& event);
    // Everything that came is in the file, and its end; says so when that is not so by the deadline.
    WriterTotals finish(Deadline deadline);

private:
    StreamRecorder(std::string path, std::unique_ptr<FileWriter> writer, RecorderConfig config);
    void put(uint32_t stream, std::span<const std::byte> payload);
    void work();
    Result<void> writeAll(std::span<const std::byte> entries);
    void end(const std::string& why); // once

    const std::string path_;
    const std::unique_ptr<FileWriter> writer_; // the thread's, once that runs
    const RecorderConfig config_;
    const int64_t beganNs_ = monotonicNowNs();
    std::atomic<bool> ended_{false};
    std::atomic<int64_t> wholeFrames_{0}; // in the file

    std::mutex mutex_; // what follows
    std::condition_variable changed_;
    std::vector<std::byte> queue_; // entries
    bool finishing_ = false;
    bool stop_ = false;
    bool done_ = false;
    WriterTotals totals_;

    std::thread thread_; // last: it uses all of it
};

} // namespace mural::recording
