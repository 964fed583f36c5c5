#include "nodes/head/balancing/part_prediction.hpp"

#include <algorithm>

namespace mural {

namespace {

constexpr double kNewShare = 1.0 / 8; // of a frame in the mean

double sizeOf(const Viewport& part) { return part.w * part.h; }
double sizeOf(const Range& part) { return part.end - part.start; }

double lengthInBoth(double firstStart, double firstEnd, double secondStart, double secondEnd) {
    return std::max(0.0, std::min(firstEnd, secondEnd) - std::max(firstStart, secondStart));
}
double sizeInBoth(const Viewport& a, const Viewport& b) {
    return lengthInBoth(a.x, a.x + a.w, b.x, b.x + b.w) * lengthInBoth(a.y, a.y + a.h, b.y, b.y + b.h);
}
double sizeInBoth(const Range& a, const Range& b) { return lengthInBoth(a.start, a.end, b.start, b.end); }

std::optional<double> known(double ns) { return ns < 0 ? std::nullopt : std::optional(ns); }

} // namespace

void PartPrediction::measured(int node, uint32_t drawn, double busyNs) {
    if (busyNs < 0) return;
    Times& times = ofNodes_[node];
    if (times.drawn != drawn) return; // drawn with a part that the node no longer has
    times.meanNs = times.meanNs < 0 ? busyNs : times.meanNs + (busyNs - times.meanNs) * kNewShare;
    times.latestNs = times.meanNs;
}

template <class Part>
void PartPrediction::predict(std::span<const int> nodes, uint32_t number, std::span<const Part> before,
                             std::span<const Part> after) {
    std::map<int, double> predicted;
    for (const int node : nodes) {
        double sumNs = 0;
        for (const int other : nodes) {
            const Part& from = before[static_cast<size_t>(other)];
            const double shared = sizeInBoth(after[static_cast<size_t>(node)], from);
            if (shared <= 0) continue;
            const double ns = ofNodes_[other].latestNs;
            if (ns < 0 || sumNs < 0)
                sumNs = -1;
            else
                sumNs += ns * shared / sizeOf(from);
        }
        predicted[node] = sumNs;
    }
    for (const auto& [node, ns] : predicted) {
        Times& times = ofNodes_[node];
        times = {number, -1, times.latestNs, ns};
    }
}

void PartPrediction::moved(std::span<const int> nodes, uint32_t number, std::span<const Viewport> before,
                           std::span<const Viewport> after) {
    predict(nodes, number, before, after);
}

void PartPrediction::moved(std::span<const int> nodes, uint32_t number, std::span<const Range> before,
                           std::span<const Range> after) {
    predict(nodes, number, before, after);
}

std::optional<double> PartPrediction::measuredNs(int node) const {
    const auto found = ofNodes_.find(node);
    return found == ofNodes_.end() ? std::nullopt : known(found->second.meanNs);
}

std::optional<double> PartPrediction::predictedNs(int node) const {
    const auto found = ofNodes_.find(node);
    return found == ofNodes_.end() ? std::nullopt : known(found->second.predictedNs);
}

} // namespace mural
