#include "balancer/planner/frame_planner.hpp"

#include "balancer/compound/plan_frame.hpp"

namespace mural::balance {

namespace {

using compound::RenderContext;

bool isSameWork(const RenderContext& a, const RenderContext& b) {
    return a.channel == b.channel && a.destination == b.destination && a.viewport == b.viewport && a.area == b.area &&
           a.part == b.part && a.range == b.range && a.zoom == b.zoom && a.pixel == b.pixel &&
           a.subPixel == b.subPixel && a.phase == b.phase && a.period == b.period;
}

} // namespace

FramePlanner::FramePlanner(ResolvedConfig config, compound::FrameInput first, Equalizers equalizers)
    : config_(std::move(config)), input_(std::move(first)), equalizers_(std::move(equalizers)) {
    input_.compounds.resize(config_.compounds.size());
    for (const config::ResolvedCompound& c : config_.compounds) hasPeriods_ |= c.period.value_or(1) != 1;
}

Equalizer* FramePlanner::find(std::string_view id) const {
    for (const auto& e : equalizers_)
        if (e->id() == id) return e.get();
    return nullptr;
}

void FramePlanner::addStatistics(const FrameStatistics& statistics) {
    for (const auto& e : equalizers_) e->observe(statistics);
}

const FrameChange& FramePlanner::next() {
    const FrameContext context{config_, input_};
    for (const auto& e : equalizers_) e->update(context, input_.compounds);
    change_.frame = input_.frameNumber;
    if (isSamePlan()) {
        plan_.frameNumber = input_.frameNumber++;
        change_.changes.clear();
        return change_;
    }
    isInputChanged_ = false;
    plannedStates_ = input_.compounds;
    std::swap(plan_, previous_);
    plan_ = compound::planFrame(config_, input_, std::move(plan_));
    ++input_.frameNumber;
    compare();
    return change_;
}

// A plan depends on the states and, with periods, on the frame number.
bool FramePlanner::isSamePlan() const { return !isInputChanged_ && !hasPeriods_ && plannedStates_ == input_.compounds; }

// Contexts of both plans have the same order: by root, eye, and place in the tree.
void FramePlanner::compare() {
    change_.changes.clear();
    using Kind = ContextChange::Kind;
    const auto& now = plan_.contexts;
    const auto& before = previous_.contexts;
    std::vector<bool> found(before.size(), false);
    size_t hint = 0;
    for (size_t i = 0; i < now.size(); ++i) {
        const auto isSame = [&](const RenderContext& c) {
            return c.compound == now[i].compound && c.eye == now[i].eye;
        };
        auto at = hint < before.size() && isSame(before[hint]) ? before.begin() + static_cast<ptrdiff_t>(hint)
                                                               : std::find_if(before.begin(), before.end(), isSame);
        const auto index = static_cast<Index>(i);
        if (at == before.end()) {
            change_.changes.push_back({Kind::Appeared, now[i].compound, now[i].eye, index});
            continue;
        }
        hint = static_cast<size_t>(at - before.begin()) + 1;
        found[hint - 1] = true;
        if (!isSameWork(*at, now[i])) change_.changes.push_back({Kind::Changed, now[i].compound, now[i].eye, index});
    }
    for (size_t i = 0; i < before.size(); ++i)
        if (!found[i]) change_.changes.push_back({Kind::Vanished, before[i].compound, before[i].eye, kNone});
}

} // namespace mural::balance
