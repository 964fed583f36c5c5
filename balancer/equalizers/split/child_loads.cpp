#include "balancer/equalizers/split/child_loads.hpp"

namespace mural::balance {

namespace {

Viewport around(const Viewport& a, const Viewport& b) {
    const double x = std::min(a.x, b.x), y = std::min(a.y, b.y);
    return {x, y, std::max(a.x + a.w, b.x + b.w) - x, std::max(a.y + a.h, b.y + b.h) - y};
}

} // namespace

ChildLoads::ChildLoads(const ResolvedConfig& config, Index compound)
    : children_(config.compounds[at(compound)].children),
      destination_(config.compounds[at(compound)].destination),
      childOf_(config.compounds.size(), -1),
      loads_(children_.size()) {
    for (const Index child : children_) channels_.push_back(config.compounds[at(child)].executing);
    for (size_t c = 0; c < config.compounds.size(); ++c) {
        executing_.push_back(config.compounds[c].executing);
        Index up = static_cast<Index>(c);
        while (up != kNone && config.compounds[at(up)].parent != compound) up = config.compounds[at(up)].parent;
        if (up == kNone) continue;
        const auto found = std::find(children_.begin(), children_.end(), up);
        childOf_[c] = static_cast<int>(found - children_.begin());
    }
}

void ChildLoads::addTime(size_t child, Index leaf, double seconds) {
    const Index channel = executing_[at(leaf)];
    for (ChannelTime& t : times_) {
        if (t.child != child || t.channel != channel) continue;
        t.seconds += seconds;
        loads_[child].seconds = std::max(loads_[child].seconds, t.seconds);
        return;
    }
    times_.push_back({child, channel, seconds});
    loads_[child].seconds = std::max(loads_[child].seconds, seconds);
}

bool ChildLoads::read(const FrameStatistics& statistics) {
    loads_.assign(children_.size(), {});
    times_.clear();
    bool any = false;
    for (const LeafStatistics& leaf : statistics.leaves) {
        const int found = at(leaf.compound) < childOf_.size() ? childOf_[at(leaf.compound)] : -1;
        if (found < 0 || leaf.viewport.empty() || leaf.range.empty()) continue;
        const auto child = static_cast<size_t>(found);
        ChildLoad& load = loads_[child];
        const Viewport interest =
            leaf.regionOfInterest ? intersect(*leaf.regionOfInterest, leaf.viewport) : leaf.viewport;
        if (load.hasDrawn) {
            load.area = around(load.area, leaf.viewport);
            load.interest = interest.empty()        ? load.interest
                            : load.interest.empty() ? interest
                                                    : around(load.interest, interest);
            load.range = {std::min(load.range.start, leaf.range.start), std::max(load.range.end, leaf.range.end)};
        } else {
            load.area = leaf.viewport;
            load.interest = interest;
            load.range = leaf.range;
        }
        load.hasDrawn = any = true;
        if (leaf.compound == children_[child])
            load.seconds += leaf.loadSeconds();
        else
            addTime(child, leaf.compound, leaf.loadSeconds());
    }
    assembly_ = statistics.assemblySeconds(destination_);
    if (any) toOwnArea();
    return any;
}

// The children cover the area and the range of their parent, so these are the union of all.
void ChildLoads::toOwnArea() {
    bool first = true;
    Viewport whole;
    Range all;
    for (const ChildLoad& load : loads_) {
        if (!load.hasDrawn) continue;
        whole = first ? load.area : around(whole, load.area);
        all = first ? load.range : Range{std::min(all.start, load.range.start), std::max(all.end, load.range.end)};
        first = false;
    }
    const double length = all.end - all.start;
    for (ChildLoad& load : loads_) {
        if (!load.hasDrawn) continue;
        load.area = relativeTo(load.area, whole);
        load.interest = load.interest.empty() ? Viewport{0, 0, 0, 0} : relativeTo(load.interest, whole);
        load.range = {(load.range.start - all.start) / length, (load.range.end - all.start) / length};
    }
}

} // namespace mural::balance
