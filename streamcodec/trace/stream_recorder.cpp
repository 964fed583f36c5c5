#include "streamcodec/trace/stream_recorder.hpp"

#include <chrono>
#include <filesystem>

#include "common/log/log.hpp"
#include "streamcodec/registry_digest.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::trace {
namespace {

std::chrono::nanoseconds leftOf(Deadline deadline) { return std::chrono::nanoseconds(deadline.leftNs(kNsPerS)); }

} // namespace

Result<std::unique_ptr<StreamRecorder>> StreamRecorder::create(const std::string& path, RecorderConfig config) {
    auto writer = TraceWriter::create(path);
    if (!writer) return writer.error();
    return std::unique_ptr<StreamRecorder>(new StreamRecorder(path, std::move(*writer), config));
}

std::unique_ptr<StreamRecorder> StreamRecorder::createWaiting(const std::string& path, RecorderConfig config) {
    return std::unique_ptr<StreamRecorder>(new StreamRecorder(path, nullptr, config));
}

StreamRecorder::StreamRecorder(std::string path, std::unique_ptr<TraceWriter> writer, RecorderConfig config)
    : path_(std::move(path)), writer_(std::move(writer)), config_(config) {}

StreamRecorder::~StreamRecorder() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        changed_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
}

void StreamRecorder::begin(const About& about) {
    if (const auto begun = writer_->begin(about, wire::kVersion, registryDigest()); !begun) end(begun.error().message);
    log::debug(log::Topic::Trace, path_, ": the recording begins");
    thread_ = std::thread([this] { work(); });
}

Result<void> StreamRecorder::beginAfter(const About& about, StreamBefore before) {
    if (ended_) return Error{"trace " + path_ + ": programs sent too much before the recording could begin; try again"};
    auto writer = TraceWriter::create(path_);
    if (!writer) return writer.error();
    if (auto begun = (*writer)->begin(about, wire::kVersion, registryDigest()); !begun) {
        std::error_code ignored;
        if (std::filesystem::is_regular_file(path_, ignored)) std::filesystem::remove(path_, ignored);
        return begun;
    }
    writer_ = std::move(*writer);
    frameNumbers_.emplace(std::move(before.wall));
    before_ = std::move(before);
    log::debug(log::Topic::Trace, path_, ": the recording begins after ", before_.packets.size(), " packets of state");
    thread_ = std::thread([this] { work(); });
    return {};
}

void StreamRecorder::discard() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
}

void StreamRecorder::packet(uint32_t stream, std::span<const std::byte> payload) {
    if (wire::clientOf(stream) != 0) put(stream, payload);
}

void StreamRecorder::event(const ClientEvent& event) { put(0, eventBytes(event)); }

void StreamRecorder::put(uint32_t stream, std::span<const std::byte> payload) {
    if (ended_) return;
    Deadline patience = Deadline::inMs(config_.patienceMs);
    std::unique_lock lock(mutex_);
    while (queue_.size() + entryBytes(payload.size()) > config_.queueBytes && !queue_.empty() && !ended_) {
        if (patience.passed()) {
            lock.unlock();
            return end("no block was written for " + std::to_string(config_.patienceMs / 1000) +
                       " s, the disk may be too slow; choose another place");
        }
        changed_.wait_for(lock, leftOf(patience));
    }
    if (ended_ || finishing_) return;
    appendEntry(queue_, {stream, static_cast<uint64_t>(monotonicNowNs() - beganNs_), payload});
    changed_.notify_all();
}

void StreamRecorder::end(const std::string& why) {
    if (ended_.exchange(true)) return;
    const std::string line = why.starts_with("trace ") ? why : "trace " + path_ + ": " + why;
    log::warning(log::Topic::Trace, line, "; the trace ends after ", wholeFrames_.load(),
                 " frames, the program continues");
}

void StreamRecorder::work() {
    if (const auto written = writeBefore(); !written) end(written.error().message);
    std::vector<std::byte> batch;
    Deadline wholeBy = Deadline::never();
    std::unique_lock lock(mutex_);
    while (!stop_) {
        if (queue_.empty() && finishing_) break;
        if (queue_.empty() && !wholeBy.passed()) {
            changed_.wait_for(lock, leftOf(wholeBy));
            continue;
        }
        batch.clear();
        batch.swap(queue_);
        changed_.notify_all();
        lock.unlock();
        Result<void> written = ended_ ? Result<void>() : writeAll(batch);
        if (written && wholeBy.passed() && !ended_) written = writer_->flush();
        wholeFrames_ = writer_->totals().frames;
        fileBytes_ = writer_->totals().fileBytes;
        if (!writer_->hasUnwritten() || ended_)
            wholeBy = Deadline::never();
        else if (wholeBy.atNs() == INT64_MAX || wholeBy.passed())
            wholeBy = Deadline::inMs(config_.wholeEveryMs);
        if (!written) end(written.error().message);
        lock.lock();
    }
    const bool orderly = finishing_;
    lock.unlock();
    if (orderly) {
        Result<void> written = ended_ ? Result<void>() : writer_->flush();
        if (!written) end(written.error().message);
        // Complete data is readable with its index, if there is room for it.
        written = writer_->finish();
        if (!written) end(written.error().message);
    }
    lock.lock();
    totals_ = writer_->totals();
    log::debug(log::Topic::Trace, path_, ": ", totals_.frames, " frames recorded");
    done_ = true;
    changed_.notify_all();
}

Result<void> StreamRecorder::writeBefore() {
    for (const ClientEvent& program : before_.programs)
        if (auto r = writer_->append({0, 0, eventBytes(program)}); !r) return r;
    for (const snapshot::SnapshotPacket& packet : before_.packets)
        if (auto r = writer_->append({packet.stream, 0, packet.payload}); !r) return r;
    before_ = {};
    return {};
}

Result<void> StreamRecorder::writeAll(std::span<std::byte> entries) {
    EntryWalk walk(entries);
    Entry entry;
    while (walk.next(entry)) {
        const bool late = config_.lastFrame > 0 && writer_->framesSeen() >= config_.lastFrame && entry.stream != 0;
        if (late) continue;
        ClientEvent event;
        if (frameNumbers_ && entry.stream != 0)
            frameNumbers_->apply(
                entry.stream,
                entries.subspan(static_cast<size_t>(entry.payload.data() - entries.data()), entry.payload.size()));
        else if (frameNumbers_ && parseEvent(entry.payload, event) && event.kind == Event::ClientGone)
            frameNumbers_->clientGone(event.client);
        if (auto r = writer_->append(entry); !r) return r;
    }
    return {};
}

WriterTotals StreamRecorder::finish(Deadline deadline) {
    std::unique_lock lock(mutex_);
    finishing_ = true;
    changed_.notify_all();
    while (thread_.joinable() && !done_ && !deadline.passed()) changed_.wait_for(lock, leftOf(deadline));
    if (done_) return totals_;
    stop_ = true;
    lock.unlock();
    end("its last blocks could not be written in time, the disk may be too slow");
    return {};
}

} // namespace mural::trace
