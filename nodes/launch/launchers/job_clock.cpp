#include "nodes/launch/launchers/job_clock.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <ctime>

#include "common/base/clock.hpp"
#include "nodes/launch/launchers/node_process.hpp"

namespace mural::launch {
namespace {

constexpr int64_t kNone = INT64_MAX;
constexpr int64_t kReplyMs = 10'000; // squeue waits longer for a controller without a reply
constexpr int64_t kSliceMs = 50;
constexpr int64_t kNearPeriodMs = 5'000; // limits change most often shortly before them
constexpr int64_t kNearS = 300;
constexpr int64_t kLastTime = 1'000'000'000'000; // far after any job

} // namespace

std::optional<int64_t> timeIn(std::string_view text) {
    int64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || at != end || value <= 0 || value > kLastTime) return std::nullopt;
    return value;
}

std::vector<std::string> endTimeCommand(const std::string& job) {
    return {"env", "SLURM_TIME_FORMAT=%s", "squeue", "-h", "-j", job, "-o", "%e"};
}

JobClock::JobClock(std::vector<std::string> command, int64_t periodMs)
    : command_(std::move(command)), periodMs_(periodMs), endNs_(kNone) {
    thread_ = std::thread([this] {
        do ask();
        while (sleep(isNearEnd() ? std::min(periodMs_, kNearPeriodMs) : periodMs_));
    });
}

JobClock::~JobClock() {
    {
        const std::lock_guard lock(mutex_);
        isEnding_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

std::optional<int64_t> JobClock::endNs() const {
    const int64_t end = endNs_.load();
    return end == kNone ? std::nullopt : std::optional(end);
}

bool JobClock::isNearEnd() const {
    const auto end = endNs();
    return end && *end - monotonicNowNs() < kNearS * kNsPerS;
}

bool JobClock::sleep(int64_t ms) {
    std::unique_lock lock(mutex_);
    return !changed_.wait_for(lock, std::chrono::milliseconds(ms), [this] { return isEnding_; });
}

void JobClock::ask() {
    std::mutex guard;
    std::string reply;
    NodeCommand command;
    command.arguments = command_;
    command.takeLine = [&](std::string_view line) {
        const std::lock_guard lock(guard);
        reply = line;
    };
    const auto asking = NodeProcess::start(command);
    if (!asking) return;
    const Deadline deadline = Deadline::inMs(kReplyMs);
    std::optional<std::string> how;
    while (!(how = (*asking)->ended()))
        if (deadline.passed() || !sleep(kSliceMs)) return; // the earlier reply stays valid
    if (how != "exit status 0") return;
    const std::lock_guard lock(guard);
    const auto end = timeIn(reply);
    endNs_ = end ? monotonicNowNs() + (*end - time(nullptr)) * kNsPerS : kNone;
}

} // namespace mural::launch
