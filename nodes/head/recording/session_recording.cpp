#include "nodes/head/recording/session_recording.hpp"

#include <nlohmann/json.hpp>

#include "common/log/log.hpp"

namespace mural {
namespace {

RecordingStatus statusOf(const trace::StreamRecorder& recorder, int64_t firstFrame) {
    return {recorder.path(), firstFrame, recorder.frames(), recorder.fileBytes(), !recorder.hasEnded()};
}

} // namespace

nlohmann::json recordingJson(const RecordingStatus& recording) {
    return {{"file", recording.file},
            {"firstFrame", recording.firstFrame},
            {"frames", recording.frames},
            {"bytes", recording.bytes},
            {"complete", recording.isComplete}};
}

void SessionRecording::beginAtStart(std::unique_ptr<trace::StreamRecorder> recorder, const trace::About& about) {
    recorder->begin(about);
    nodes_.setRecorder(recorder.get());
    const std::lock_guard lock(mutex_);
    events_ = recorder.get();
    recorder_ = std::move(recorder);
}

void SessionRecording::programCame(trace::ClientEvent program) {
    const std::lock_guard lock(mutex_);
    if (events_) events_->event(program);
    programs_[program.client] = std::move(program);
}

void SessionRecording::programGone(uint32_t client) {
    const std::lock_guard lock(mutex_);
    if (events_) events_->event({trace::Event::ClientGone, client, 0, ""});
    programs_.erase(client);
}

Result<RecordingStatus> SessionRecording::start(const std::string& file, const trace::About& about, Deadline deadline) {
    if (const auto current = status(); current && current->isComplete)
        return Error{"the session already records into " + current->file + "; end that with mural ctl record stop"};
    if (recorder_) // an error has ended it
        if (const auto stopped = stop(deadline); !stopped) return stopped.error();
    auto recorder = trace::StreamRecorder::createWaiting(file, {});
    std::vector<trace::ClientEvent> programs;
    // Programs of this moment precede their state in the file. Later ones follow in the order of the stream.
    const auto atPosition = [&] {
        const std::lock_guard lock(mutex_);
        for (const auto& [client, program] : programs_) programs.push_back(program);
        events_ = recorder.get();
    };
    auto snapshot = nodes_.beginRecording(*recorder, atPosition, deadline);
    Result<void> begun;
    int64_t firstFrame = 1;
    if (snapshot) {
        firstFrame = snapshot->wall.frames() + 1;
        begun =
            recorder->beginAfter(about, {std::move(programs), std::move(snapshot->packets), std::move(snapshot->wall)});
    } else {
        begun = Error{"trace " + file + " cannot begin: " + snapshot.error().message};
    }
    if (!begun) {
        abandon(std::move(recorder));
        return begun.error();
    }
    const std::lock_guard lock(mutex_);
    recorder_ = std::move(recorder);
    firstFrame_ = firstFrame;
    log::info(log::Topic::Trace, "trace ", file, ": the recording begins with frame ", firstFrame);
    return statusOf(*recorder_, firstFrame_);
}

// The destruction of a recorder requires that no sender uses it.
void SessionRecording::abandon(std::unique_ptr<trace::StreamRecorder> recorder) {
    constexpr int64_t kPatienceMs = 1000;
    {
        const std::lock_guard lock(mutex_);
        events_ = nullptr;
    }
    recorder->discard();
    if (!nodes_.endRecording(Deadline::inMs(kPatienceMs))) abandoned_.push_back(std::move(recorder));
}

Result<RecordingStatus> SessionRecording::stop(Deadline deadline) {
    if (!recorder_) return Error{"the session records nothing; begin with mural ctl record start FILE"};
    if (!nodes_.endRecording(deadline))
        return Error{"the recording continues: a node accepts no data at the moment; see mural stat, and try again"};
    const int64_t firstFrame = firstFrame_;
    auto recorder = take();
    RecordingStatus ended = complete(*recorder, firstFrame, deadline);
    // The destruction waits for a writer that is late, without a limit.
    if (recorder->hasEnded()) abandoned_.push_back(std::move(recorder));
    log::info(log::Topic::Trace, "trace ", ended.file, ": the recording ends after ", ended.frames, " frames, ",
              ended.bytes, " bytes");
    return ended;
}

void SessionRecording::finish(Deadline deadline) {
    if (!recorder_) return;
    const int64_t firstFrame = firstFrame_;
    abandoned_.push_back(take());
    complete(*abandoned_.back(), firstFrame, deadline);
}

std::unique_ptr<trace::StreamRecorder> SessionRecording::take() {
    const std::lock_guard lock(mutex_);
    events_ = nullptr;
    firstFrame_ = 1;
    return std::move(recorder_);
}

RecordingStatus SessionRecording::complete(trace::StreamRecorder& recorder, int64_t firstFrame, Deadline deadline) {
    const trace::WriterTotals totals = recorder.finish(deadline);
    RecordingStatus ended{recorder.path(), firstFrame, totals.frames, totals.fileBytes, !recorder.hasEnded()};
    if (recorder.hasEnded()) ended.frames = recorder.frames(), ended.bytes = recorder.fileBytes();
    const std::lock_guard lock(mutex_);
    latest_ = ended;
    return ended;
}

std::optional<RecordingStatus> SessionRecording::status() const {
    const std::lock_guard lock(mutex_);
    if (!recorder_) return std::nullopt;
    return statusOf(*recorder_, firstFrame_);
}

std::optional<RecordingStatus> SessionRecording::latest() const {
    if (auto current = status()) return current;
    const std::lock_guard lock(mutex_);
    return latest_;
}

} // namespace mural
