// The recording of a session's stream into a trace: from the start (--record), or from a later frame boundary on
// (`mural ctl record start`).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "nodes/head/broadcast/stream_broadcaster.hpp"
#include "nodes/head/recording/recording_status.hpp"
#include "streamcodec/trace/stream_recorder.hpp"

namespace mural {

// programCame(), programGone() and status() may be called from any thread. The other functions need one thread at a
// time.
class SessionRecording {
public:
    explicit SessionRecording(StreamBroadcaster& nodes) : nodes_(nodes) {}

    // Call before programs connect.
    void beginAtStart(std::unique_ptr<trace::StreamRecorder> recorder, const trace::About& about);
    // Call before the program's first packet, and after its end has been broadcast.
    void programCame(trace::ClientEvent program);
    void programGone(uint32_t client);

    // Begins a recording with the next frame of the wall. After an error nothing has changed.
    Result<RecordingStatus> start(const std::string& file, const trace::About& about, Deadline deadline);
    // Ends the recording and completes its file. Errors: there is none; a node accepts no data until the deadline.
    Result<RecordingStatus> stop(Deadline deadline);
    // Completes the file at the end of the session, when nothing is sent any more.
    void finish(Deadline deadline);

    // Returns the current recording; nothing if there is none.
    [[nodiscard]] std::optional<RecordingStatus> status() const;
    // Returns the numbers of the latest recording, also after its end.
    [[nodiscard]] std::optional<RecordingStatus> latest() const;

private:
    std::unique_ptr<trace::StreamRecorder> take(); // from now on there is no recording
    RecordingStatus complete(trace::StreamRecorder& recorder, int64_t firstFrame, Deadline deadline);
    void abandon(std::unique_ptr<trace::StreamRecorder> recorder);

    StreamBroadcaster& nodes_;
    std::vector<std::unique_ptr<trace::StreamRecorder>> abandoned_; // senders may still use them

    mutable std::mutex mutex_; // guards the members below
    std::map<uint32_t, trace::ClientEvent> programs_;
    std::unique_ptr<trace::StreamRecorder> recorder_; // null: none
    trace::StreamRecorder* events_ = nullptr;         // recorder of the events of programs from now on
    int64_t firstFrame_ = 1;
    std::optional<RecordingStatus> latest_; // of a completed recording
};

} // namespace mural
