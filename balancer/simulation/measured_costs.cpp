#include "balancer/simulation/measured_costs.hpp"

#include <algorithm>
#include <numeric>

namespace mural::simulation {

namespace {

// With n parts of work p and common work c per node: whole = sum(p) + c, measured = sum(p) + n * c.
std::vector<float> partsWithoutCommonWork(const std::vector<double>& measured, double whole) {
    const double sum = std::accumulate(measured.begin(), measured.end(), 0.0);
    const double common =
        measured.size() < 2 ? 0 : std::max(0.0, (sum - whole) / static_cast<double>(measured.size() - 1));
    std::vector<double> parts;
    for (const double m : measured) parts.push_back(std::max(0.0, m - common));
    const double rest = std::accumulate(parts.begin(), parts.end(), 0.0);
    std::vector<float> result;
    for (const double p : parts)
        result.push_back(static_cast<float>(rest > 0 ? p * whole / rest : whole / static_cast<double>(parts.size())));
    return result;
}

const std::vector<double>* workOf(const WorkByFrame& run, uint32_t frame, size_t nodes) {
    const auto found = run.find(frame);
    return found == run.end() || found->second.size() != nodes ? nullptr : &found->second;
}

size_t largestNodeCount(const WorkByFrame& run) {
    size_t most = 0;
    for (const auto& [frame, work] : run) most = std::max(most, work.size());
    return most;
}

} // namespace

void keepLeastWork(WorkByFrame& least, const WorkByFrame& other) {
    for (auto& [frame, work] : least) {
        const auto* again = workOf(other, frame, work.size());
        if (again == nullptr) continue;
        for (size_t node = 0; node < work.size(); ++node) work[node] = std::min(work[node], (*again)[node]);
    }
}

void smoothOverTime(WorkByFrame& work, size_t frames) {
    std::vector<const std::vector<double>*> before;
    const WorkByFrame measured = work;
    for (const auto& [frame, ofNodes] : measured) before.push_back(&ofNodes);
    const size_t reach = frames / 2;
    size_t at = 0;
    for (auto& [frame, ofNodes] : work) {
        // As many frames on each side, so that the first and the last frames keep their place in a slope.
        const size_t side = std::min({reach, at, before.size() - 1 - at});
        for (size_t node = 0; node < ofNodes.size(); ++node) {
            std::vector<double> window;
            for (size_t i = at - side; i <= at + side; ++i)
                if (node < before[i]->size()) window.push_back((*before[i])[node]);
            const auto middle = window.begin() + static_cast<std::ptrdiff_t>(window.size() / 2);
            std::ranges::nth_element(window, middle);
            ofNodes[node] = *middle;
        }
        ++at;
    }
}

Result<CostTrace> costsOf(const MeasuredRuns& runs, const std::string& name) {
    CostTrace trace;
    trace.name = name;
    trace.columns = runs.columns;
    trace.rows = runs.rows;
    trace.ranges = std::max<size_t>(1, largestNodeCount(runs.ranges));
    for (const auto& [frame, whole] : runs.whole) {
        const auto* cells = workOf(runs.cells, frame, runs.columns * runs.rows);
        const auto* ranges = workOf(runs.ranges, frame, trace.ranges);
        if (cells == nullptr || ranges == nullptr || whole.size() != 1) continue;
        if (!(whole.front() > 0)) return Error{"frame " + std::to_string(frame) + " has no work of a node"};
        trace.frames.push_back(
            {partsWithoutCommonWork(*cells, whole.front()), partsWithoutCommonWork(*ranges, whole.front())});
    }
    if (trace.frames.empty()) return Error{"the runs have no frame in common"};
    return trace;
}

} // namespace mural::simulation
