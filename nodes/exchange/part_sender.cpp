#include "nodes/exchange/part_sender.hpp"

#include <array>
#include <chrono>

#include "common/base/little_endian.hpp"

namespace mural {

namespace {

// In one composition a node sends at most two parts to another. Room for two compositions prevents a deadlock: the
// slowest node always has room.
constexpr size_t kMaxWaiting = 4;
constexpr int64_t kWriteMs = 60'000;            // the reader gives up the whole picture earlier
constexpr int64_t kLingerMs = 5'000;            // limit for the destructor
constexpr uint64_t kMinMeasuredBytes = 1 << 16; // smaller transfers only measure socket buffers

} // namespace

PartSender::PartSender(Connection& over) : over_(over), thread_([this] { run(); }) {}

PartSender::~PartSender() {
    {
        std::unique_lock lock(mutex_);
        stop_ = true;
        changed_.notify_all();
        changed_.wait_for(lock, std::chrono::milliseconds(kLingerMs),
                          [this] { return waiting_.empty() || !failure_.empty(); });
    }
    over_.close();
    thread_.join();
}

Result<void> PartSender::send(std::vector<std::byte> message, Deadline deadline) {
    std::unique_lock lock(mutex_);
    const auto ready = [this] { return waiting_.size() < kMaxWaiting || !failure_.empty(); };
    if (!changed_.wait_for(lock, std::chrono::nanoseconds(deadline.leftNs(3600 * kNsPerS)), ready))
        return Error{"it does not read pictures"};
    if (!failure_.empty()) return Error{failure_};
    waiting_.push_back(std::move(message));
    changed_.notify_all();
    return {};
}

LinkTransfer PartSender::takeTransfer() {
    const std::lock_guard lock(mutex_);
    return std::exchange(transfer_, {});
}

void PartSender::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return !waiting_.empty() || stop_; }); // the destructor ends the wait
        if (waiting_.empty()) return;
        const std::vector<std::byte>& message = waiting_.front(); // a deque keeps it in place while others are appended
        lock.unlock();
        std::array<std::byte, 4> size;
        storeLittle(size.data(), static_cast<uint32_t>(message.size()));
        const int64_t beganNs = monotonicNowNs();
        auto done = over_.write(size, Deadline::inMs(kWriteMs));
        if (done) done = over_.write(message, Deadline::inMs(kWriteMs));
        if (done) over_.flush();
        const int64_t tookNs = monotonicNowNs() - beganNs;
        lock.lock();
        if (done && message.size() >= kMinMeasuredBytes) {
            transfer_.bytes += message.size();
            transfer_.ns += tookNs;
        }
        if (!done) failure_ = done.error().message;
        waiting_.pop_front();
        changed_.notify_all();
        if (!done) return;
    }
}

} // namespace mural
