#include "nodes/head/membership/job_deadline.hpp"

#include <array>
#include <fmt/format.h>

#include "common/base/clock.hpp"

namespace mural {
namespace {

constexpr std::array<int64_t, 3> kNoticesS = {300, 60, JobDeadline::kEndBeforeS};

std::string durationText(int64_t seconds) {
    if (seconds < 60) return fmt::format("{} s", seconds);
    return fmt::format("{} min {} s", seconds / 60, seconds % 60);
}

} // namespace

std::optional<JobDeadline::Notice> JobDeadline::check(std::optional<int64_t> endNs, int64_t nowNs) {
    const int64_t left = endNs ? (*endNs - nowNs) / kNsPerS : INT64_MAX;
    int stage = 0;
    for (const int64_t notice : kNoticesS)
        if (left <= notice) ++stage;
    const bool isNew = stage > stage_;
    stage_ = stage;
    if (!isNew) return std::nullopt;
    const bool isOver = stage == static_cast<int>(kNoticesS.size());
    const std::string ends = fmt::format("Slurm job {} ends in {}", job_, durationText(left < 0 ? 0 : left));
    if (isOver) return Notice{ends + ": the run ends now, so that its files are complete", true};
    return Notice{fmt::format("{}; an operator can extend it: scontrol update JobId={} TimeLimit=+60", ends, job_),
                  false};
}

} // namespace mural
