#include "nodes/head/session/plan_sequence.hpp"

#include <algorithm>
#include <cstdlib>

#include "nodes/head/session/canvas_composition.hpp"

namespace mural {
namespace {

std::vector<int> picturesOf(const SessionPlan& plan) {
    std::vector<int> pictures;
    for (const NodePlan& node : plan.nodes) pictures.push_back(node.picture);
    return pictures;
}

// Returns the zoom of each picture relative to the program's.
std::vector<Zoom> sizesOf(const SessionPlan& plan) {
    std::vector<Zoom> sizes;
    for (const NodePlan& node : plan.nodes) {
        sizes.resize(std::max(sizes.size(), static_cast<size_t>(node.picture) + 1));
        if (!node.isVacant) sizes[static_cast<size_t>(node.picture)] = node.pass.shown;
    }
    return sizes;
}

std::string plantOf() {
    const char* const plant = std::getenv("MURAL_PLANT"); // fault injection, for tests of the tests
    return plant != nullptr ? plant : "";
}

} // namespace

SessionStage::SessionStage(SessionConfig sessionConfig, SessionPlan sessionPlan, const SessionPlan& outputs,
                           PictureAssembler::Deliver deliver, LoadBalancer::Announce announce)
    : config(std::move(sessionConfig)),
      plan(std::move(sessionPlan)),
      takesPictures(headTakesPictures(config, plan)),
      ownsWallWindows(headShowsWall(config, plan)),
      pictures(picturesOf(plan), composeFirst(plan), std::move(deliver), composeOthers(plan, outputs), sizesOf(plan)),
      balancer(plan, std::move(announce), plantOf()) {}

PlanSequence::PlanSequence(SessionConfig config, SessionPlan plan, Hooks hooks)
    : hooks_(std::move(hooks)), outputs_(plan) {
    current_ = addStage(std::move(config), std::move(plan));
    entries_.push_back({current_, {}, {}, false});
}

std::shared_ptr<SessionStage> PlanSequence::current() const {
    const std::lock_guard lock(stagesMutex_);
    return current_;
}

std::shared_ptr<SessionStage> PlanSequence::of(int node) const {
    const std::lock_guard lock(stagesMutex_);
    return ofNodes_[static_cast<size_t>(node)];
}

void PlanSequence::assign(int node, std::shared_ptr<SessionStage> stage) {
    const std::lock_guard lock(stagesMutex_);
    ofNodes_.resize(std::max(ofNodes_.size(), static_cast<size_t>(node) + 1));
    ofNodes_[static_cast<size_t>(node)].swap(stage); // the earlier stage ends after the lock is released
}

std::shared_ptr<SessionStage> PlanSequence::addStage(SessionConfig config, SessionPlan plan) {
    const auto itself = std::make_shared<SessionStage*>(nullptr); // the address, once it is known
    auto stage = std::make_shared<SessionStage>(
        std::move(config), std::move(plan), outputs_,
        [this, itself](WindowPicture picture) { deliver(**itself, std::move(picture)); }, announceOf(itself));
    *itself = stage.get();
    const auto count = static_cast<int>(stage->plan.nodes.size());
    for (int node = nodeCount(); node < count; ++node) assign(node, stage);
    nodeCount_.store(std::max(count, nodeCount()), std::memory_order_release);
    return stage;
}

// Assignments of an earlier stage have no receiver, and those of a later one wait for its change.
LoadBalancer::Announce PlanSequence::announceOf(const std::shared_ptr<SessionStage*>& stage) {
    const auto ifCurrent = [this, stage](const auto& announce, const auto&... values) {
        const std::lock_guard lock(announceMutex_);
        if (announce && current().get() == *stage) announce(values...);
    };
    return {[this, ifCurrent](const ViewportAssignment& areas) { ifCurrent(hooks_.announce.viewports, areas); },
            [this, ifCurrent](const RangeAssignment& ranges) { ifCurrent(hooks_.announce.ranges, ranges); },
            [this, ifCurrent](uint32_t client, double rate) { ifCurrent(hooks_.announce.pace, client, rate); },
            [this, ifCurrent](uint32_t client, uint32_t window) { ifCurrent(hooks_.announce.redraw, client, window); }};
}

std::shared_ptr<SessionStage> PlanSequence::prepare(SessionConfig config, SessionPlan plan) {
    const int before = nodeCount();
    auto stage = addStage(std::move(config), std::move(plan));
    for (const NodePlan& node : stage->plan.nodes)
        if (node.isVacant || node.node >= before) stage->pictures.nodeLost(node.node); // until it joins
    // Nodes of prepared stages that never became current have ended.
    for (int node = static_cast<int>(current()->plan.nodes.size()); node < before; ++node) assign(node, stage);
    return stage;
}

void PlanSequence::change(const std::shared_ptr<SessionStage>& next, std::set<int> kept,
                          const std::vector<int>& leaving, uint32_t view) {
    {
        const std::lock_guard lock(announceMutex_);
        const std::lock_guard stages(stagesMutex_);
        current_ = next;
    }
    for (const NodePlan& node : next->plan.nodes) {
        if (of(node.node) == next || kept.contains(node.node) || std::ranges::count(leaving, node.node) > 0) continue;
        if (!node.isVacant) { // a lost node of both stages
            next->pictures.nodeLost(node.node);
            next->balancer.nodeLost(node.node);
        }
        assign(node.node, next);
    }
    const std::lock_guard lock(mutex_);
    std::erase_if(entries_, [](const Entry& entry) { return entry.isOver; });
    Entry& before = entries_.back();
    before.draining = kept;
    before.draining.insert(leaving.begin(), leaving.end());
    before.isOver = before.draining.empty();
    entries_.push_back({next, {}, {}, false});
    kept_ = std::move(kept);
    view_ = view;
}

bool PlanSequence::isSettled() const {
    const std::lock_guard lock(mutex_);
    return std::ranges::all_of(entries_, [&](const Entry& e) { return e.isOver || &e == &entries_.back(); });
}

// Called with the lock of the stage's pictures.
void PlanSequence::deliver(const SessionStage& stage, WindowPicture picture) {
    hooks_.isWhole(picture);
    picture.isOnWall = stage.ownsWallWindows;
    const std::lock_guard lock(mutex_);
    for (Entry& entry : entries_) {
        if (entry.stage.get() != &stage) {
            if (entry.isOver) continue;
            const auto own = std::ranges::find(entries_, &stage, [](const Entry& e) { return e.stage.get(); });
            if (own != entries_.end()) own->held.push_back(std::move(picture));
            return;
        }
        return hooks_.output(std::move(picture));
    }
}

// The node's messages have passed the end of its stage: a change, its Goodbye or its loss.
void PlanSequence::passed(int node) {
    std::vector<std::shared_ptr<SessionStage>> over;
    {
        const std::lock_guard lock(mutex_);
        bool isNext = true; // all earlier stages are over
        for (Entry& entry : entries_) {
            if (isNext)
                for (; !entry.held.empty(); entry.held.pop_front()) hooks_.output(std::move(entry.held.front()));
            if (entry.draining.erase(node) > 0 && entry.draining.empty()) {
                entry.isOver = true;
                over.push_back(entry.stage);
                if (entry.stage->ownsWallWindows && !current()->ownsWallWindows) hooks_.closeWall();
            }
            isNext = isNext && entry.isOver;
        }
    }
    for (const auto& stage : over) stage->pictures.release();
}

std::vector<std::shared_ptr<SessionStage>> PlanSequence::stagesInUse() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::shared_ptr<SessionStage>> found;
    for (const Entry& entry : entries_)
        if (!entry.isOver) found.push_back(entry.stage);
    return found;
}

std::vector<std::shared_ptr<SessionStage>> PlanSequence::stagesWith(int node) const {
    auto found = stagesInUse();
    std::erase_if(found, [node](const auto& stage) { return static_cast<size_t>(node) >= stage->plan.nodes.size(); });
    return found;
}

void PlanSequence::nodeJoins(int node, uint32_t view) { current()->pictures.nodeJoins(node, view); }

void PlanSequence::nodeInView(int node, uint32_t view) {
    for (const auto& stage : stagesWith(node)) stage->pictures.nodeInView(node, view);
    {
        const std::lock_guard lock(mutex_);
        if (view < view_ || kept_.erase(node) == 0) return;
        assign(node, entries_.back().stage);
    }
    passed(node);
}

void PlanSequence::nodeLost(int node) {
    for (const auto& stage : stagesWith(node)) {
        stage->pictures.nodeLost(node);
        stage->balancer.nodeLost(node);
    }
    {
        const std::lock_guard lock(mutex_);
        if (kept_.erase(node) > 0) assign(node, entries_.back().stage);
    }
    passed(node);
}

void PlanSequence::windowGone(uint32_t client, uint32_t window) {
    for (const auto& stage : stagesInUse()) stage->balancer.windowGone(client, window);
}

void PlanSequence::clientGone(uint32_t client) {
    for (const auto& stage : stagesInUse()) stage->pictures.clientGone(client);
}

} // namespace mural
