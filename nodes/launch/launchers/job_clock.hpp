// The end of a Slurm job. Slurm 22.05 has no variable for it, and operators change it, so squeue is asked at intervals.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace mural::launch {

// Reads seconds since 1970. Returns nothing for other texts: a job without a limit has the end "NONE".
std::optional<int64_t> timeIn(std::string_view text);

// Asks on a thread of its own, because squeue waits while the controller does not reply.
class JobClock {
public:
    // command: prints the end, in seconds since 1970. It runs every periodMs, and more often in the last minutes.
    explicit JobClock(std::vector<std::string> command, int64_t periodMs = 30'000);
    ~JobClock(); // within 100 ms
    JobClock(const JobClock&) = delete;
    JobClock& operator=(const JobClock&) = delete;

    // Returns the end of the job, by monotonicNowNs(). Nothing: no limit, or unknown. Thread-safe.
    [[nodiscard]] std::optional<int64_t> endNs() const;

private:
    void ask();
    [[nodiscard]] bool isNearEnd() const;
    bool sleep(int64_t ms); // returns false at the end of this object

    const std::vector<std::string> command_;
    const int64_t periodMs_;
    std::atomic<int64_t> endNs_; // kNone: no limit, or unknown
    std::mutex mutex_;           // guards isEnding_
    std::condition_variable changed_;
    bool isEnding_ = false;
    std::thread thread_;
};

// The command that prints the end of a job. The field %L does not follow a changed end.
std::vector<std::string> endTimeCommand(const std::string& job);

} // namespace mural::launch
