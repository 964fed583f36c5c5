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
        changed_.wait(lock, [this] {
            return stop_ || dueRequest() || (!entries_.empty() && (pauses_.empty() || taken_ < *pauses_.begin()));
        });
        if (stop_) return;
        if (const auto request = dueRequest()) {
            serve(*request, lock);
            continue;
        }
        const Entry entry = std::move(entries_.front());
        entries_.pop_front();
        waitingBytes_ -= entry.payload.size();
        const bool wanted = complete_;
        lock.unlock();
        countFrames(entry);
        if (wanted || entry.clientGone != 0) take(entry);
        const bool fits = snapshot_->serves();
        logBytes_ = snapshot_->sizeBytes();
        lock.lock();
        ++taken_;
        if (entry.clientGone != 0) tooLarge_.erase(entry.clientGone);
        if (!fits && complete_) overflow();
        if (!complete_ && (!fits || logBytes_ > 0))
            snapshot_ = makeStream_(static_cast<size_t>(maxBytes_)), frames_.clear(), logBytes_ = 0;
        if (!complete_ && tooLarge_.empty()) complete_ = true;
        changed_.notify_all();
    }
}

std::shared_ptr<RejoinLog::Request> RejoinLog::dueRequest() const {
    const auto due =
        std::ranges::find_if(requests_, [this](const auto& r) { return r->position == taken_ && !r->hasBegun; });
    return due == requests_.end() ? nullptr : *due;
}

// The memory of all snapshots comes from the malloc arena of this thread, so it is used again. Other threads would each
// keep the memory of a snapshot in an arena of their own.
void RejoinLog::serve(Request& request, std::unique_lock<std::mutex>& lock) {
    request.hasBegun = true;
    if (complete_) {
        lock.unlock();
        Snapshot made{snapshot_->snapshot(), {}, wall_};
        for (const auto& [client, frame] : frames_) made.frames.push_back({client, frame});
        lock.lock();
        request.snapshot = std::move(made);
    }
    request.isDone = true;
    changed_.notify_all();
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
    const auto request = std::make_shared<Request>(Request{position, false, false, {}});
    std::unique_lock lock(mutex_);
    requests_.push_back(request);
    changed_.notify_all();
    while (!stop_ && !request->isDone && (request->hasBegun || !deadline.passed()))
        changed_.wait_for(lock, std::chrono::milliseconds(kSliceMs));
    std::erase(requests_, request);
    pauses_.erase(pauses_.find(position));
    changed_.notify_all();
    if (request->snapshot) return std::move(*request->snapshot);
    return Error{complete_ ? "its snapshot was not ready in time"
                           : "programs have sent more than the " + std::to_string(maxBytes_ >> 20) +
                                 " MiB of the rejoin log; a larger --cache-size holds more"};
}

uint64_t RejoinLog::sizeBytes() const {
    const std::lock_guard lock(mutex_);
    return logBytes_ + waitingBytes_;
}

} // namespace mural
