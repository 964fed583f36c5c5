// Warnings before the end of a batch job, and the moment to end the run in order before the batch system ends it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace mural {

class JobDeadline {
public:
    // Recordings and reports need this time; Slurm sends SIGKILL KillWait (30 s) after the time limit.
    static constexpr int64_t kEndBeforeS = 10;

    struct Notice {
        std::string line; // for the user
        bool isOver;      // the run ends now
    };

    explicit JobDeadline(std::string job) : job_(std::move(job)) {}

    // Returns a notice 5 minutes, 1 minute and kEndBeforeS before the end, once each: again if the end moves to later.
    // endNs: the end of the job; nothing: no limit. Times are readings of monotonicNowNs().
    std::optional<Notice> check(std::optional<int64_t> endNs, int64_t nowNs);

private:
    const std::string job_; // its number
    int stage_ = 0;         // number of notices given
};

} // namespace mural
