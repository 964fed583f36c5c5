#include "balancer/simulation/measures.hpp"

#include <algorithm>
#include <numeric>

namespace mural::simulation {

namespace {

double meanOfLast(const std::vector<double>& values, size_t count) {
    const size_t n = std::min(count, values.size());
    return n == 0 ? 0 : std::accumulate(values.end() - static_cast<long>(n), values.end(), 0.) / static_cast<double>(n);
}

} // namespace

Measures measuresOf(const Outcome& outcome, const Outcome& even) {
    Measures m;
    const std::vector<double>& all = outcome.efficiency;
    if (all.empty()) return m;
    m.mean = meanOfLast(all, all.size());
    m.travel = meanOfLast(outcome.travel, outcome.travel.size());
    std::vector<double> sorted = all;
    std::sort(sorted.begin(), sorted.end());
    m.fifth = sorted[sorted.size() / 20];
    const double final = meanOfLast(all, 10);
    int worse = 0;
    for (size_t f = 0; f < all.size(); ++f) {
        if (outcome.travel[f] > 1e-9) m.lastMove = static_cast<int>(f);
        if (all[f] < .95 * final) m.settled = static_cast<int>(f) + 1;
        if (f < even.longest.size() && outcome.longest[f] > 1.01 * even.longest[f]) ++worse;
    }
    m.worseThanEven = worse / static_cast<double>(all.size());
    return m;
}

int framesToFollow(const Outcome& outcome, int step, int latency) {
    const double goal = .9 * meanOfLast(outcome.efficiency, 10);
    const int seen = step + latency;
    for (auto f = static_cast<size_t>(seen); f < outcome.efficiency.size(); ++f)
        if (outcome.efficiency[f] >= goal) return static_cast<int>(f) - seen;
    return static_cast<int>(outcome.efficiency.size());
}

} // namespace mural::simulation
