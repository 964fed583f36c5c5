#include "balancer/equalizers/cost_map/helper_count.hpp"

#include <algorithm>
#include <cmath>

namespace mural::balance {

namespace {

constexpr double kNewest = .2;      // of the newest frame in the means
constexpr int kFramesToChange = 12; // between two changes; a change needs a few frames to show its effect

} // namespace

void HelperCount::observe(double work, double assembly, size_t helpers) {
    ++frames_;
    work_ = work_ > 0 && std::abs(work - work_) < work_ ? (1 - kNewest) * work_ + kNewest * work : work;
    if (helpers == 0) return; // the last known time per helper stays
    const double each = assembly / static_cast<double>(helpers);
    assemblyPerHelper_ = hasAssembly_ ? (1 - kNewest) * assemblyPerHelper_ + kNewest * each : each;
    hasAssembly_ = true;
}

double HelperCount::frameTime(size_t helpers, bool drawsItself) const {
    const auto count = static_cast<double>(helpers);
    const double assembly = count * assemblyPerHelper_;
    if (!drawsItself) return helpers == 0 ? INFINITY : std::max(work_ / count, assembly);
    return (work_ + assembly) / (count + 1) > assembly ? (work_ + assembly) / (count + 1)
                                                       : std::max(assembly, work_ / std::max(count, 1.));
}

size_t HelperCount::choose(size_t all, bool drawsItself, double gain) {
    const size_t now = working(all);
    if (!hasAssembly_ || assemblyPerHelper_ <= 0 || frames_ < kFramesToChange) return now;
    size_t best = now;
    double least = frameTime(now, drawsItself) * (1 - gain);
    for (size_t count = drawsItself ? 0 : 1; count <= all; ++count) {
        const double time = frameTime(count, drawsItself);
        if (time >= least) continue;
        least = time;
        best = count;
    }
    if (best == now) return now;
    isChosen_ = true;
    chosen_ = best;
    frames_ = 0;
    return best;
}

} // namespace mural::balance
