#include "nodes/head/membership/rejoin_log.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "streamcodec/wire/record_walk.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural {

namespace {

constexpr int64_t kSliceMs = 100;

} // namespace

RejoinLog::RejoinLog(uint64_t maxBytes, MakeStream makeStream)
    : maxBytes_(maxBytes),
      makeStream_(std::move(makeStream)),
      snapshot_(makeStream_(static_cast<size_t>(maxBytes))),
      thread_([this] { work(); }) {}

RejoinLog::~RejoinLog() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        changed_.notify_all();
    }
    thread_.join();
}

void RejoinLog::append(uint32_t stream, std::span<const std::byte> payload) {
    ++appended_;
    Entry entry{stream, {payload.begin(), payload.end()}, 0};
    const std::lock_guard lock(mutex_);
    programs_.insert(wire::clientOf(stream));
    if (!complete_) tooLarge_.insert(wire::clientOf(stream)); // it may share objects with the overflowed programs
    waitingBytes_ += payload.size();
    entries_.push_back(std::move(entry));
    if (complete_ && waitingBytes_ > maxBytes_) overflow();
    changed_.notify_all();
}

void RejoinLog::programGone(uint32_t client) {
    ++appended_;
    const std::lock_guard lock(mutex_);
    programs_.erase(client);
    entries_.push_back({0, {}, client});
    changed_.notify_all();
}

uint64_t RejoinLog::pause() {
    const std::lock_guard lock(mutex_);
    pauses_.insert(appended_);
    return appended_;
}

void RejoinLog::overflow() {
    complete_ = false;
    tooLarge_ = programs_;
}

void RejoinLog::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(
            lock, [this] { return stop_ || (!entries_.empty() && (pauses_.empty() || taken_ < *pauses_.begin())); });
        if (stop_) return;
        const Entry entry = std::move(entries_.front());
        entries_.pop_front();
        waitingBytes_ -= entry.payload.size();
        const bool wanted = complete_;
        inHand_ = true;
        lock.unlock();
        countFrames(entry);
        if (wanted || entry.clientGone != 0) take(entry);
        const bool fits = snapshot_->serves();
        logBytes_ = snapshot_->sizeBytes();
        lock.lock();
        inHand_ = false;
        ++taken_;
        if (entry.clientGone != 0) tooLarge_.erase(entry.clientGone);
        if (!fits && complete_) overflow();
        if (!complete_ && (!fits || logBytes_ > 0))
            snapshot_ = makeStream_(static_cast<size_t>(maxBytes_)), frames_.clear(), logBytes_ = 0;
        if (!complete_ && tooLarge_.empty()) complete_ = true;
        changed_.notify_all();
    }
}

void RejoinLog::countFrames(const Entry& entry) {
    if (entry.clientGone != 0) {
        frames_.erase(entry.clientGone);
        return wall_.clientGone(entry.clientGone);
    }
    wire::RecordWalk walk(entry.payload);
    wire::RecordView r;
    while (walk.next(r)) {
        wall_.record(entry.stream, r);
        if (r.opcode == wire::kOpSwap || r.opcode == wire::kOpFrontPicture)
            frames_[wire::clientOf(entry.stream)] = wire::argumentWord(r, 1);
    }
}

void RejoinLog::take(const Entry& entry) {
    if (entry.clientGone != 0) return snapshot_->clientGone(entry.clientGone);
    snapshot_->append(entry.stream, entry.payload);
}

Result<RejoinLog::Snapshot> RejoinLog::snapshot(uint64_t position, Deadline deadline) {
    std::unique_lock lock(mutex_);
    while (!stop_ && (taken_ < position || inHand_) && !deadline.passed())
        changed_.wait_for(lock, std::chrono::milliseconds(kSliceMs));
    const bool there = complete_ && taken_ == position && !inHand_;
    Result<Snapshot> result = Error{complete_ ? "its snapshot was not ready in time"
                                              : "programs have sent more than the " + std::to_string(maxBytes_ >> 20) +
                                                    " MiB of the rejoin log; a larger --cache-size holds more"};
    if (there) {
        lock.unlock(); // the thread is paused, and no other thread touches the log
        {
            // Locked after `lock` was released: a snapshot of a later position waits for earlier ones.
            const std::lock_guard alone(snapshots_);
            Snapshot snapshot{snapshot_->snapshot(), {}, wall_};
            for (const auto& [client, frame] : frames_) snapshot.frames.push_back({client, frame});
            result = std::move(snapshot);
        }
        lock.lock();
    }
    pauses_.erase(pauses_.find(position));
    changed_.notify_all();
    return result;
}

uint64_t RejoinLog::sizeBytes() const {
    const std::lock_guard lock(mutex_);
    return logBytes_ + waitingBytes_;
}

} // namespace mural
