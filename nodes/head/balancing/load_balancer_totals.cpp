// Totals and changes of the equalizers of a running session.
#include <algorithm>
#include <numeric>

#include "nodes/head/balancing/load_balancer.hpp"

namespace mural {
namespace {

double partOf(const Viewport& area) { return area.w * area.h; }
double partOf(const Range& range) { return range.end - range.start; }

std::optional<double> msOf(const std::optional<double>& ns) {
    constexpr double kNsInMs = 1e6;
    return ns ? std::optional(*ns / kNsInMs) : std::nullopt;
}

} // namespace

void LoadBalancer::count(Watched& w) const {
    w.totals.frozen = w.equalizer->isFrozen();
    w.totals.decision = w.equalizer->lastDecision().what;
    w.totals.efficiency = w.efficiencies.empty() ? 0
                                                 : std::accumulate(w.efficiencies.begin(), w.efficiencies.end(), 0.) /
                                                       static_cast<double>(w.efficiencies.size());
    w.totals.parameters.clear();
    for (const balance::Parameter& p : w.equalizer->parameters().all())
        w.totals.parameters.emplace_back(p.name, balance::textOf(p.value));
    w.totals.nodes.clear();
    double whole = 0;
    if (w.totals.division == Division::Zooms) w.totals.zoom = 1;
    for (const int node : w.nodes) {
        const auto i = static_cast<size_t>(node);
        if (w.totals.division == Division::Zooms) w.totals.zoom = std::min(w.totals.zoom, areas_.zoomOf(i));
        const double part = w.totals.division == Division::Frames   ? 1
                            : w.totals.division == Division::Ranges ? partOf(ranges_.ofNodes[i])
                                                                    : partOf(areas_.ofNodes[i]);
        NodeShare share{node, part, std::nullopt, msOf(w.prediction.measuredNs(node)),
                        msOf(w.prediction.predictedNs(node))};
        if (w.totals.division == Division::Areas) share.area = areas_.ofNodes[i];
        w.totals.nodes.push_back(share);
        whole += part;
    }
    for (NodeShare& share : w.totals.nodes) share.part = whole > 0 ? share.part / whole : 0;
}

Result<balance::Equalizer*> LoadBalancer::find(const std::string& name) const {
    if (!isActive()) return Error{"this session has no equalizers; start it with --balance"};
    if (balance::Equalizer* const found = planner_->find(name)) return found;
    std::string names;
    for (const auto& e : planner_->equalizers()) names += (names.empty() ? "" : ", ") + e->id();
    return Error{"equalizer \"" + name + "\" does not exist; the names are " + names};
}

Result<void> LoadBalancer::set(const std::string& name, const std::string& parameter, const std::string& value) {
    const std::lock_guard lock(mutex_);
    const auto found = find(name);
    if (!found) return found.error();
    return found.value()->set(parameter, value);
}

Result<void> LoadBalancer::freeze(const std::string& name, bool isFrozen) {
    const std::lock_guard lock(mutex_);
    const auto found = find(name);
    if (!found) return found.error();
    found.value()->freeze(isFrozen, planner_->input().compounds);
    return {};
}

std::vector<EqualizerTotals> LoadBalancer::totals() const {
    const std::lock_guard lock(mutex_);
    std::vector<EqualizerTotals> totals;
    for (Watched w : watched_) {
        count(w);
        totals.push_back(std::move(w.totals));
    }
    return totals;
}

} // namespace mural
