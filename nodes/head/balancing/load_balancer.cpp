#include "nodes/head/balancing/load_balancer.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "balancer/equalizers/make_equalizers.hpp"
#include "balancer/equalizers/random_equalizer.hpp"
#include "common/base/clock.hpp"
#include "nodes/head/planning/balance_plan.hpp"
#include "nodes/head/planning/compound_pass.hpp"

namespace mural {
namespace {

using balance::Effect;
using balance::LeafStatistics;
using compound::RenderContext;
using config::at;
using config::Index;
using config::kNone;

// Limit of the assignments with which no frame has been drawn yet. A window that is never cleared keeps its areas, so
// further assignments would have no effect.
constexpr size_t kMaxIssues = 64;
constexpr size_t kRatedFrames = 32;
constexpr int kMaxRedraws = 2; // a program that redraws only a part never shows full resolution
constexpr uint32_t kSeed = 20261123;

bool plantsAreas(const std::string& plant) { return plant == "areas" || plant == "early" || plant == "uncleared"; }
bool plantsRanges(const std::string& plant) { return plant == "shares" || plant == "lateshare"; }

// Returns the equalizers that take effect in the session.
balance::FramePlanner::Equalizers equalizersOf(const BalancePlan& plan, const std::string& plant) {
    auto all = balance::makeEqualizers(plan.config, plan.choice);
    std::erase_if(all,
                  [&](const auto& e) { return std::ranges::find(plan.equalizers, e->id()) == plan.equalizers.end(); });
    for (auto& e : all) {
        const bool planted = (e->effect() == Effect::Viewports && plantsAreas(plant)) ||
                             (e->effect() == Effect::Ranges && plantsRanges(plant));
        if (planted) e = std::make_unique<balance::RandomEqualizer>(*e, plan.config, kSeed);
    }
    return all;
}

compound::DisplaySizes scaled(compound::DisplaySizes sizes, double x, double y) {
    for (PixelViewport& c : sizes.channels) {
        const auto edge = [](int at, double scale) { return static_cast<int>(std::lround(at * scale)); };
        const int x0 = edge(c.x, x), y0 = edge(c.y, y);
        c = {x0, y0, edge(c.right(), x) - x0, edge(c.top(), y) - y0};
    }
    return sizes;
}

Division divisionBy(Effect effect) {
    if (effect == Effect::Viewports) return Division::Areas;
    if (effect == Effect::Zooms) return Division::Zooms;
    return effect == Effect::Ranges ? Division::Ranges : Division::Frames;
}

// Returns a zoom of few distinct values, with a difference in time of at most 2 %. Times vary from frame to frame, and
// the zoom need not follow that.
double stepOf(double zoom) {
    constexpr double kSteps = 32; // per octave
    return std::min(1., std::exp2(std::round(std::log2(zoom) * kSteps) / kSteps));
}

} // namespace

LoadBalancer::LoadBalancer(const SessionPlan& plan, Announce announce, const std::string& plant)
    : announce_(std::move(announce)),
      nodes_(plan.nodes),
      times_(plan.nodes.size()),
      isRandom_(plantsAreas(plant) || plantsRanges(plant)) {
    for (const NodePlan& node : nodes_) {
        areas_.ofNodes.push_back(node.area.value_or(Viewport{}));
        ranges_.ofNodes.push_back(node.pass.share);
        if (node.isVacant) times_.lost(node.node);
    }
    if (movesZooms()) areas_.zooms.assign(nodes_.size(), 1);
    if (!plan.balance || plan.balance->equalizers.empty()) return;
    fileSizes_ = plan.balance->input.sizes;
    wall_ = plan.balance->wall;
    planner_ = std::make_unique<balance::FramePlanner>(plan.balance->config, plan.balance->input,
                                                       equalizersOf(*plan.balance, plant));
    for (const auto& e : planner_->equalizers()) {
        if (e->effect() == Effect::Usage) continue;
        Watched& w = watched_.emplace_back();
        w.equalizer = e.get();
        w.nodes = nodesOf(plan, *e);
        w.totals.id = e->id();
        w.totals.kind = e->kind();
        w.totals.division = divisionBy(e->effect());
    }
}

ViewportAssignment LoadBalancer::viewports() const {
    const std::lock_guard lock(mutex_);
    return areas_;
}

void LoadBalancer::frameDone(int node, const wire::FrameDoneMessage& message, int64_t nowNs) {
    if (!isActive()) return;
    const std::lock_guard lock(mutex_);
    if (times_.follow(message)) {
        resize();
        program_ = {};
        isCoarse_ = false;
        issues_.clear();
        advance(false);
    }
    times_.worked(node, message.busyNs);
    if (const auto given = givenUp_.find(node); given != givenUp_.end() && message.width > 0)
        given->second.latest[{message.client, message.window}] = message.areas;
    if (isRandom_) advance(false);
    if (!times_.follows(message)) return;
    for (Watched& w : watched_) {
        const auto first = std::ranges::find_if(w.nodes, [&](int n) { return times_.isAlive(n); });
        const uint32_t number = w.totals.division == Division::Ranges ? message.shares : message.areas;
        if (first != w.nodes.end() && *first == node && number != std::exchange(w.drawn, number)) ++w.totals.taken;
    }
    if (isRandom_) return;
    const auto frame = times_.finished(node, message);
    if (!frame) return;
    observe(*frame, message.frame, nowNs);
    if (issues_.size() < kMaxIssues) advance(false);
}

bool LoadBalancer::movesZooms() const { return std::ranges::any_of(nodes_, &NodePlan::movesZoom); }

void LoadBalancer::frameSent(const SentFrame& frame) {
    const std::lock_guard lock(mutex_);
    if (!times_.known() || frame.client != times_.client() || frame.window != times_.window()) return;
    program_.sent(frame);
    observeStill(monotonicNowNs());
}

void LoadBalancer::tick(int64_t nowNs) {
    if (!movesZooms()) return;
    const std::lock_guard lock(mutex_);
    observeStill(nowNs);
    requestRedraw(nowNs);
}

// The nodes cannot draw the frame again, because it may change objects that it depends on. The program can.
void LoadBalancer::requestRedraw(int64_t nowNs) {
    const bool isFull = std::ranges::all_of(areas_.zooms, [](double zoom) { return zoom == 1; }); // not frozen
    if (!announce_.redraw || !isCoarse_ || !isFull || redraws_ >= kMaxRedraws || !program_.isIdle(nowNs)) return;
    ++redraws_;
    isCoarse_ = false;
    announce_.redraw(times_.client(), times_.window());
}

// Only equalizers of zooms use this, and at once: their next frame depends on it.
void LoadBalancer::observeStill(int64_t nowNs) {
    const bool isStill = program_.isStill(nowNs);
    if (!isActive() || isRandom_ || isStill == isStill_) return;
    isStill_ = isStill;
    balance::FrameStatistics statistics;
    statistics.frameNumber = measured_;
    for (const Index root : planner_->config().roots) statistics.roots.push_back({root, 0, isStill_});
    for (const auto& e : planner_->equalizers())
        if (e->effect() == Effect::Zooms) e->observe(statistics);
    if (issues_.size() < kMaxIssues) advance(false);
}

void LoadBalancer::answered() {
    if (!isActive() || !isRandom_) return;
    const std::lock_guard lock(mutex_);
    if (times_.known()) advance(false);
}

// The program's picture has the place of the first canvas, whose size in the file may differ.
void LoadBalancer::resize() {
    if (wall_.w <= 0 || wall_.h <= 0) return;
    planner_->changeInput().sizes =
        scaled(fileSizes_, double(times_.width()) / wall_.w, double(times_.height()) / wall_.h);
}

// Plans the next frame and announces what changed. `repeats` announces unchanged parts, too: after a loss or a return
// nodes may have reset theirs.
void LoadBalancer::advance(bool repeats) {
    planner_->next();
    ViewportAssignment areas = areas_;
    RangeAssignment ranges = ranges_;
    findParts(areas, ranges);
    const bool movesAreas = std::ranges::any_of(nodes_, followsAssignments);
    const bool movesRanges = std::ranges::any_of(nodes_, &NodePlan::movesRange);
    // Without a window the areas have no pixels to align to. The first frame of a window replaces them.
    const bool hasAreas =
        movesAreas && (repeats || (times_.known() && (areas.ofNodes != areas_.ofNodes || areas.zooms != areas_.zooms)));
    const bool hasRanges = movesRanges && (repeats || ranges.ofNodes != ranges_.ofNodes);
    for (Watched& w : watched_) {
        const auto moved = [&](int n) {
            const auto i = static_cast<size_t>(n);
            return w.totals.division == Division::Ranges  ? ranges.ofNodes[i] != ranges_.ofNodes[i]
                   : w.totals.division == Division::Zooms ? areas.zoomOf(i) != areas_.zoomOf(i)
                                                          : areas.ofNodes[i] != areas_.ofNodes[i];
        };
        if (!repeats && !issues_.empty() && std::ranges::any_of(w.nodes, moved)) ++w.totals.moves;
        if (hasAreas && w.totals.division == Division::Areas)
            w.prediction.moved(w.nodes, areas.number + 1, areas_.ofNodes, areas.ofNodes);
        if (hasRanges && w.totals.division == Division::Ranges)
            w.prediction.moved(w.nodes, ranges.number + 1, ranges_.ofNodes, ranges.ofNodes);
    }
    if (hasAreas) {
        ++areas.number;
        areas_ = std::move(areas);
        announce_.viewports(areas_);
    }
    if (hasRanges) {
        ++ranges.number;
        ranges_ = std::move(ranges);
        announce_.ranges(ranges_);
    }
    if (!isRandom_ && (hasAreas || hasRanges || issues_.empty()))
        issues_.push_back({areas_.number, ranges_.number, leavesOfPlan()});
    announcePace();
}

// Announces the lowest rate of the framerate equalizers.
void LoadBalancer::announcePace() {
    double pace = 0;
    for (Watched& w : watched_) {
        if (w.totals.division != Division::Frames) continue;
        const double rate = planner_->input().compounds[at(w.equalizer->compound())].maxFps;
        if (rate > 0) pace = pace > 0 ? std::min(pace, rate) : rate;
        if (std::exchange(w.totals.framesPerSecond, rate) != rate) ++w.totals.moves;
    }
    if (pace == pace_ && times_.client() == pacedClient_) return;
    if (!announce_.pace) return;
    if (times_.client() != pacedClient_ && pace_ > 0) announce_.pace(pacedClient_, 0);
    pace_ = pace;
    pacedClient_ = times_.client();
    announce_.pace(pacedClient_, pace_);
}

// Sets the areas, ranges and zooms of the nodes that change. A task without a context draws nothing.
void LoadBalancer::findParts(ViewportAssignment& areas, RangeAssignment& ranges) const {
    constexpr size_t kEyeCount = 3;
    const auto& contexts = planner_->plan().contexts;
    std::vector<const RenderContext*> found(planner_->config().compounds.size() * kEyeCount);
    const auto key = [](Index compound, Eye eye) { return at(compound) * kEyeCount + static_cast<size_t>(eye); };
    for (const RenderContext& c : contexts) found[key(c.compound, c.eye)] = &c;
    for (size_t i = 0; i < nodes_.size(); ++i) {
        const NodePlan& node = nodes_[i];
        if (!node.task) continue;
        if (node.movesZoom)
            areas.zooms[i] = stepOf(zoomChangeOf(planner_->config(), planner_->input().compounds, node.task->compound));
        if (node.movesArea) {
            const DrawTask& task = *planOf(node.collector).task;
            const RenderContext* c = found[key(task.compound, task.eye)];
            const bool draws = c != nullptr && c->view != kNone && !c->part.empty() && !c->range.empty();
            areas.ofNodes[i] =
                draws ? compose(planner_->config().views[at(c->view)].viewport, c->part) : Viewport{0, 0, 0, 0};
            snap(areas.ofNodes[i]);
        }
        if (node.movesRange) {
            const RenderContext* c = found[key(node.task->compound, node.task->eye)];
            const bool draws = c != nullptr && c->view != kNone && !c->part.empty() && !c->range.empty();
            const double end = node.pass.share.start;
            ranges.ofNodes[i] = draws ? Range{c->range.start, std::min(1., c->range.end)} : Range{end, end};
        }
    }
}

// Moves edges onto pixels of the followed window, so that neighbours agree exactly.
void LoadBalancer::snap(Viewport& area) const {
    if (!times_.known() || area.empty()) return;
    const PixelViewport window{0, 0, times_.width(), times_.height()};
    // Edges of a zoomed plan may lie between pixels. Neighbours may differ by a rounding error, also where that
    // decides.
    constexpr double kNudge = 1e-6; // in pixels
    if (!areas_.zooms.empty()) area.x += kNudge / window.w, area.y += kNudge / window.h;
    const PixelViewport pixels = intersect(apply(window, area), window);
    area = pixels.empty() ? Viewport{0, 0, 0, 0} : relativeTo(pixels, window);
}

std::vector<LeafStatistics> LoadBalancer::leavesOfPlan() const {
    std::vector<LeafStatistics> leaves;
    for (const compound::ChannelPlan& channel : planner_->plan().channels)
        for (const compound::PlannedTask& task : channel.tasks) {
            if (task.kind != config::Task::Draw || task.context == kNone) continue;
            const RenderContext& c = planner_->plan().contexts[at(task.context)];
            const bool isKnown =
                std::ranges::any_of(leaves, [&](const LeafStatistics& l) { return l.compound == c.compound; });
            if (isKnown) continue; // both eyes have one part
            leaves.push_back(balance::leafOf(c, planner_->input().sizes));
            if (const auto zoom = drawnZoomOf(c.compound)) leaves.back().zoom = *zoom;
        }
    return leaves;
}

// Returns the announced zoom of the nodes of a compound. Empty: it never changes.
std::optional<Zoom> LoadBalancer::drawnZoomOf(Index compound) const {
    for (size_t i = 0; i < nodes_.size(); ++i)
        if (nodes_[i].task && nodes_[i].task->compound == compound && nodes_[i].movesZoom)
            return compose(zoomOf(planner_->config(), compound), Zoom{areas_.zooms[i], areas_.zooms[i]});
    return {};
}

// True if some node of the compound drew this frame without its zoom.
bool LoadBalancer::isUnzoomed(const FrameTimes::Frame& frame, Index compound) const {
    for (size_t i = 0; i < nodes_.size(); ++i)
        if (nodes_[i].task && nodes_[i].task->compound == compound && frame.busyNs[i] >= 0 &&
            (frame.done[i].flags & wire::kDrawnUnzoomed) != 0)
            return true;
    return false;
}

// Returns the parts that the nodes drew in this frame; null if they drew different or older ones.
const LoadBalancer::Issue* LoadBalancer::issueOf(const FrameTimes::Frame& frame) const {
    std::optional<uint32_t> viewports, ranges;
    for (size_t i = 0; i < nodes_.size(); ++i) {
        if (frame.busyNs[i] < 0) continue;
        const wire::FrameDoneMessage& done = frame.done[i];
        const bool follows = followsAssignments(nodes_[i]);
        if (follows && viewports.value_or(done.areas) != done.areas) return nullptr;
        if (nodes_[i].movesRange && ranges.value_or(done.shares) != done.shares) return nullptr;
        if (follows) viewports = done.areas;
        if (nodes_[i].movesRange) ranges = done.shares;
    }
    const auto issue = std::ranges::find_if(issues_, [&](const Issue& i) {
        return viewports.value_or(i.viewports) == i.viewports && ranges.value_or(i.ranges) == i.ranges;
    });
    return issue == issues_.end() ? nullptr : &*issue;
}

// Returns the busy time in ns of the nodes of each compound, summed over the eyes; negative: none of them counts.
std::vector<double> LoadBalancer::busyByCompound(const FrameTimes::Frame& frame) const {
    std::vector<double> busy(planner_->config().compounds.size(), -1);
    for (size_t i = 0; i < nodes_.size(); ++i) {
        if (!nodes_[i].task || frame.busyNs[i] < 0) continue;
        // a frame without divided draws tells nothing about ranges
        if (nodes_[i].movesRange && (frame.done[i].flags & wire::kNotSplit)) continue;
        double& sum = busy[at(nodes_[i].task->compound)];
        sum = std::max(0., sum) + frame.busyNs[i];
    }
    // An equalizer of areas that has only the collectors divides the time of the slowest node of each.
    for (const NodePlan& node : nodes_) {
        if (!node.task || !node.movesArea || node.movesRange || node.collector == node.node) continue;
        const double own = busy[at(node.task->compound)];
        double& first = busy[at(planOf(node.collector).task->compound)];
        if (first >= 0) first = std::max(first, own);
    }
    return busy;
}

void LoadBalancer::observe(const FrameTimes::Frame& frame, uint32_t number, int64_t nowNs) {
    const Issue* const issue = issueOf(frame);
    const int64_t frameNs = program_.finished(number, nowNs);
    if (issue == nullptr) return;
    const std::vector<double> busy = busyByCompound(frame);
    balance::FrameStatistics statistics;
    statistics.frameNumber = measured_++;
    for (LeafStatistics leaf : issue->leaves) {
        if (busy[at(leaf.compound)] < 0 || drawsInTurn(leaf.compound)) continue;
        leaf.busySeconds = leaf.end = 1e-9 * busy[at(leaf.compound)];
        if (isUnzoomed(frame, leaf.compound)) leaf.zoom = zoomOf(planner_->config(), leaf.compound);
        statistics.leaves.push_back(leaf);
    }
    addTurns(frame, statistics);
    for (const Index root : planner_->config().roots)
        statistics.roots.push_back({root, 1e-9 * static_cast<double>(frameNs), isStill_});
    while (&issues_.front() != issue) issues_.pop_front();
    if (statistics.leaves.empty()) return;
    isCoarse_ = isCoarse(statistics);
    if (!isCoarse_) redraws_ = 0;
    countFrame(frame);
    planner_->addStatistics(statistics);
}

bool LoadBalancer::isCoarse(const balance::FrameStatistics& statistics) const {
    constexpr double kSame = .999;
    return std::ranges::any_of(statistics.leaves, [&](const LeafStatistics& leaf) {
        const Zoom full = zoomOf(planner_->config(), leaf.compound);
        return drawnZoomOf(leaf.compound) && (leaf.zoom.x < kSame * full.x || leaf.zoom.y < kSame * full.y);
    });
}

bool LoadBalancer::drawsInTurn(Index compound) const {
    return std::ranges::any_of(
        nodes_, [&](const NodePlan& n) { return n.task && n.task->compound == compound && n.pass.period > 1; });
}

// Adds the nodes that draw frames in turn. The busiest node of each picture and range has drawn this frame; the others
// have skipped it.
void LoadBalancer::addTurns(const FrameTimes::Frame& frame, balance::FrameStatistics& statistics) const {
    std::map<std::pair<int, int>, size_t> drawing; // node by picture and range
    for (size_t i = 0; i < nodes_.size(); ++i) {
        if (!nodes_[i].task || nodes_[i].pass.period < 2 || frame.busyNs[i] < 0) continue;
        const auto [entry, isNew] = drawing.try_emplace({nodes_[i].picture, nodes_[i].pass.range}, i);
        if (!isNew && frame.busyNs[i] > frame.busyNs[entry->second]) entry->second = i;
    }
    for (const auto& [part, i] : drawing) {
        LeafStatistics& leaf = statistics.leaves.emplace_back();
        leaf.compound = nodes_[i].task->compound;
        leaf.busySeconds = leaf.end = 1e-9 * frame.busyNs[i];
    }
}

void LoadBalancer::countFrame(const FrameTimes::Frame& frame) {
    for (Watched& w : watched_) {
        double sum = 0, longest = 0, alive = 0;
        for (const int node : w.nodes) {
            const double busy = frame.busyNs[static_cast<size_t>(node)];
            if (busy < 0) continue;
            const wire::FrameDoneMessage& done = frame.done[static_cast<size_t>(node)];
            w.prediction.measured(node, w.totals.division == Division::Ranges ? done.shares : done.areas, busy);
            sum += busy;
            longest = std::max(longest, busy);
            ++alive;
        }
        if (longest <= 0) continue;
        ++w.totals.frames;
        if (w.totals.division == Division::Frames || w.totals.division == Division::Zooms) continue; // divide nothing
        w.efficiencies.push_back(sum / (alive * longest));
        if (w.efficiencies.size() > kRatedFrames) w.efficiencies.pop_front();
    }
}

void LoadBalancer::windowGone(uint32_t client, uint32_t window) {
    const std::lock_guard lock(mutex_);
    times_.windowGone(client, window);
    for (auto& [node, given] : givenUp_)
        std::erase_if(given.latest, [&](const auto& entry) {
            return entry.first.first == client && (window == wire::kAllWindows || entry.first.second == window);
        });
}

// The nodes of both eyes draw one part, so both must live. A moving area needs its collector, and all ranges of it,
// unless they can move to the others.
void LoadBalancer::updateAvailable(int node) {
    const auto lives = [&](const NodePlan& n) { return times_.isAlive(n.node) && !givenUp_.contains(n.node); };
    const auto needs = [](const NodePlan& a, const NodePlan& b) {
        if (!b.task) return false;
        const bool isInArea = a.movesArea && a.collector == b.collector;
        return a.task->compound == b.task->compound || (isInArea && (!a.movesRange || b.node == b.collector));
    };
    const NodePlan& changed = planOf(node);
    if (!changed.task) return;
    for (const NodePlan& other : nodes_) {
        if (!other.task || (other.collector != changed.collector && !needs(other, changed))) continue;
        planner_->changeInput().compounds[at(other.task->compound)].isAvailable =
            std::ranges::all_of(nodes_, [&](const NodePlan& n) { return !needs(other, n) || lives(n); });
    }
}

void LoadBalancer::nodeLost(int node) {
    const std::lock_guard lock(mutex_);
    if (planOf(node).isVacant) return;
    times_.lost(node);
    givenUp_.erase(node);
    if (!isActive()) return;
    updateAvailable(node);
    advance(true);
}

void LoadBalancer::nodeJoined(int node) {
    const std::lock_guard lock(mutex_);
    if (!times_.joined(node) || !isActive()) return;
    updateAvailable(node);
    advance(true);
}

Result<void> LoadBalancer::giveUp(int node) {
    const std::lock_guard lock(mutex_);
    if (!isActive() || !planOf(node).movesArea) return Error{"no other node takes its part of the picture"};
    givenUp_[node] = {};
    updateAvailable(node);
    advance(true);
    givenUp_[node].number = areas_.number;
    if (areas_.ofNodes[static_cast<size_t>(node)].empty()) return {};
    givenUp_.erase(node);
    updateAvailable(node);
    advance(true);
    return Error{"its equalizer does not give its part of the picture to other nodes"};
}

void LoadBalancer::takeBack(int node) {
    const std::lock_guard lock(mutex_);
    if (givenUp_.erase(node) == 0) return;
    updateAvailable(node);
    advance(true);
}

bool LoadBalancer::hasGivenUp(int node) const {
    const std::lock_guard lock(mutex_);
    const auto given = givenUp_.find(node);
    if (given == givenUp_.end()) return false;
    if (!times_.known()) return true;
    const auto& latest = given->second.latest;
    return !latest.empty() && std::ranges::all_of(latest, [&](const auto& entry) {
        return entry.second >= given->second.number && entry.second > 0;
    });
}

} // namespace mural
