#include "nodes/head/membership/node_restarter.hpp"

#include "streamcodec/wire/node_messages.hpp"

#include <algorithm>
#include <poll.h>
#include <utility>

#include "common/log/log.hpp"

namespace mural {
namespace {

constexpr int64_t kStopPatienceMs = 10'000;

} // namespace

NodeRestarter::NodeRestarter(ReturnTerms terms, StreamBroadcaster& nodes, Hooks hooks)
    : terms_(std::move(terms)), set_(nodes), hooks_(std::move(hooks)), nodes_(nodes.size()) {}

NodeRestarter::~NodeRestarter() {
    stop([] {});
}

// ---- what becomes of nodes

std::string NodeRestarter::memberLost(int node) {
    const std::string never = terms_.tries == 0 || !hooks_.start ? "" : hooks_.whyNever(node);
    const int64_t nowNs = monotonicNowNs();
    const std::lock_guard lock(mutex_);
    Node& n = at(node);
    n.phase = Phase::Over;
    n.lostNs = nowNs;
    // skipped frames may have caused the loss
    if (!n.isRetired && n.tries > 0 && nowNs - n.memberNs <= terms_.steadyMs * kNsPerMs) skipsFrames_ = false;
    std::string tiles = hooks_.tilesOfLost(node);
    if (terms_.tries == 0 || !hooks_.start || stopped_ || n.isRetired) return tiles;
    if (!never.empty()) return tiles + ": " + never;
    if (nowNs - n.memberNs > terms_.steadyMs * kNsPerMs) n.tries = 0;
    n.givesUp = n.tries >= terms_.tries;
    if (n.givesUp)
        return tiles + ": it was restarted " + std::to_string(n.tries) + " times, and lost again soon each time";
    n.phase = Phase::Waiting;
    n.nextNs = nowNs + terms_.pausesMs[std::min(static_cast<size_t>(n.tries), terms_.pausesMs.size() - 1)] * kNsPerMs;
    return tiles + " until it rejoins";
}

Result<void> NodeRestarter::canRestart(int node) const {
    if (terms_.tries == 0 || !hooks_.start)
        return Error{"nodes of this session are not restarted; start it with --restart-nodes 1 or more"};
    if (const std::string never = hooks_.whyNever(node); !never.empty()) return Error{never};
    const std::lock_guard lock(mutex_);
    const Node& n = nodes_[static_cast<size_t>(node)];
    if (n.phase != Phase::Member) return Error{"it is no member at the moment; try again when it has joined"};
    const bool isSteady = monotonicNowNs() - n.memberNs > terms_.steadyMs * kNsPerMs;
    if (n.tries > 0 && !isSteady)
        return Error{"it joined less than " + std::to_string(terms_.steadyMs / 1000) + " s ago; try again later"};
    return {};
}

Result<void> NodeRestarter::retire(int node) {
    const std::lock_guard lock(mutex_);
    Node& n = at(node);
    if (n.phase != Phase::Member && n.phase != Phase::Waiting && n.phase != Phase::Over)
        return Error{"it is being restarted; try again when it has joined"};
    n.isRetired = true;
    if (n.phase == Phase::Waiting) n.problem = "it was removed"; // tick() ends its restarts
    return {};
}

Result<void> NodeRestarter::leave(int node) {
    const std::lock_guard lock(mutex_);
    Node& n = at(node);
    if (n.phase != Phase::Member) return Error{"it is no member at the moment; see mural ctl nodes"};
    n.isRetired = true;
    return {};
}

void NodeRestarter::stay(int node) {
    const std::lock_guard lock(mutex_);
    at(node).isRetired = false;
}

Result<void> NodeRestarter::bringBack(int node) {
    if (terms_.tries == 0 || !hooks_.start)
        return Error{"nodes of this session are not restarted; start it with --restart-nodes 1 or more"};
    if (const std::string never = hooks_.whyNever(node); !never.empty()) return Error{never};
    const std::lock_guard lock(mutex_);
    Node& n = at(node);
    if (stopped_) return Error{"the session is ending"};
    if (n.phase == Phase::Member) return Error{"it is a member already; see mural ctl nodes"};
    if (n.phase != Phase::Over) return Error{"it is being restarted already; see mural ctl nodes"};
    n.isRetired = false;
    n.tries = 0;
    n.lostNs = n.nextNs = monotonicNowNs();
    n.phase = Phase::Waiting;
    return {};
}

void NodeRestarter::addGroup(const std::shared_ptr<NodeGroup>& group) {
    const int64_t nowNs = monotonicNowNs();
    const std::lock_guard lock(mutex_);
    for ([[maybe_unused]] const int node : group->nodes()) {
        Node& n = nodes_.emplace_back();
        n.phase = Phase::Waiting;
        n.lostNs = n.nextNs = nowNs;
        n.group = group;
    }
}

// The attempt at the start of the session counts as the first one.
void NodeRestarter::notThere(int node) {
    const int64_t nowNs = monotonicNowNs();
    const std::lock_guard lock(mutex_);
    Node& n = at(node);
    n.lostNs = nowNs;
    n.phase = Phase::Waiting;
    n.nextNs = nowNs + terms_.pausesMs[std::min<size_t>(1, terms_.pausesMs.size() - 1)] * kNsPerMs;
}

bool NodeRestarter::lostWhileRestarting(int node, const std::string& why) {
    const std::lock_guard lock(mutex_);
    Node& n = at(node);
    if (n.phase != Phase::Readying && n.phase != Phase::Ready && n.phase != Phase::CatchingUp) return false;
    if (n.problem.empty()) n.problem = why;
    if (n.catchUp) n.catchUp->linkLost();
    return true;
}

void NodeRestarter::ready(int node) {
    const std::lock_guard lock(mutex_);
    Node& n = at(node);
    if (n.phase != Phase::Readying) return;
    n.phase = Phase::Ready;
    if (n.group) n.group->ready(node);
}

void NodeRestarter::synchronized(int node, const wire::SynchronizedMessage& message) {
    const std::lock_guard lock(mutex_);
    if (at(node).catchUp) at(node).catchUp->synchronized(message);
}

void NodeRestarter::turns(uint32_t number, const std::vector<std::byte>& turns) {
    const std::lock_guard lock(mutex_);
    for (Node& n : nodes_)
        if (n.catchUp) n.catchUp->phaseState(number, turns);
}

bool NodeRestarter::skipsFrames() const {
    const std::lock_guard lock(mutex_);
    return skipsFrames_;
}

bool NodeRestarter::becomesMember(int node) {
    const std::lock_guard lock(mutex_);
    Node& n = at(node);
    if (n.phase != Phase::CatchingUp || !n.problem.empty() || stopped_) return false;
    becomeMember(n);
    return true;
}

Result<void> NodeRestarter::exchange(const NodeGroup* group, const std::vector<int>& leaving) {
    const std::lock_guard lock(mutex_);
    if (stopped_) return Error{"the session is ending"};
    const std::vector<int> joining = group ? group->nodes() : std::vector<int>();
    for (const int node : joining)
        if (at(node).phase != Phase::CatchingUp || !at(node).problem.empty())
            return Error{set_.link(node).describe() + " was lost meanwhile"};
    for (const int node : leaving)
        if (at(node).phase != Phase::Member && at(node).phase != Phase::Waiting && at(node).phase != Phase::Over)
            return Error{set_.link(node).describe() + " is being restarted; try again when it has joined"};
    for (const int node : joining) becomeMember(at(node));
    for (const int node : leaving) {
        at(node).isRetired = true;
        if (at(node).phase == Phase::Waiting) at(node).phase = Phase::Over;
    }
    return {};
}

// Requires mutex_.
void NodeRestarter::becomeMember(Node& n) {
    n.phase = Phase::Member;
    n.memberNs = monotonicNowNs();
    n.numbers = {static_cast<double>(n.memberNs - n.lostNs) / static_cast<double>(kNsPerS), n.catchUp->snapshotBytes(),
                 n.catchUp->queuedBytes(), n.catchUp->framesGiven()};
    n.group = nullptr;
}

bool NodeRestarter::awaited() const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(nodes_,
                               [](const Node& n) { return n.phase != Phase::Member && n.phase != Phase::Over; });
}

bool NodeRestarter::isRestarting(int node) const {
    const std::lock_guard lock(mutex_);
    const Phase phase = nodes_[static_cast<size_t>(node)].phase;
    return phase != Phase::Member && phase != Phase::Over;
}

NodeRestarter::Numbers NodeRestarter::numbers(int node) const {
    const std::lock_guard lock(mutex_);
    return nodes_[static_cast<size_t>(node)].numbers;
}

// ---- Functions of the session's thread. Only this thread changes phases, except when a link ends. Hooks can therefore
// be called without the lock.

void NodeRestarter::tick(int64_t nowNs) {
    // only this thread adds nodes
    for (size_t node = 0; node < nodes_.size(); ++node) tickNode(static_cast<int>(node), nowNs);
}

void NodeRestarter::tickNode(int node, int64_t nowNs) {
    Phase phase = Phase::Over;
    std::shared_ptr<NodeResync> over;
    std::string problem;
    bool due = false, givesUp = false, isOver = false;
    std::shared_ptr<NodeGroup> group;
    Deadline readyBy = Deadline::never();
    {
        const std::lock_guard lock(mutex_);
        Node& n = at(node);
        phase = n.phase;
        if (phase != Phase::CatchingUp && n.catchUp && n.catchUp->done()) over = std::move(n.catchUp); // joined below
        due = nowNs >= n.nextNs && !n.catchUp;
        problem = n.problem;
        readyBy = n.readyBy;
        group = n.group;
        givesUp = std::exchange(n.givesUp, false);
        isOver = n.isDiscarded && !n.catchUp && set_.link(node).readerEnded();
        if (isOver) n.isDiscarded = false;
    }
    over.reset();
    if (givesUp) hooks_.gaveUp(node);
    if (isOver) hooks_.isOver(node);
    if (!problem.empty()) return fail(node, problem, nowNs);
    if (group && group->hasFailed() && cancels(node, phase)) return;
    switch (phase) {
    case Phase::Waiting:
        if (due && set_.link(node).readerEnded()) start(node, nowNs);
        return;
    case Phase::Starting: return pollStart(node, nowNs);
    case Phase::Readying:
        if (readyBy.passed())
            set_.link(node).lose("it was not ready within " + std::to_string(terms_.readyPatienceMs / 1000) + " s");
        return;
    case Phase::Ready:
        if (!group || group->areAllReady()) catchUp(node);
        return;
    case Phase::Member:
    case Phase::CatchingUp:
    case Phase::Over: return;
    }
}

void NodeRestarter::catchUp(int node) {
    hooks_.introduce(node);
    bool isInGroup = false;
    {
        const std::lock_guard lock(mutex_);
        isInGroup = at(node).group != nullptr;
    }
    std::optional<StreamBroadcaster::PhaseRequest> turns;
    // members of another plan have no state for the nodes of a group
    if (const auto kind = hooks_.turns(node); kind != StreamBroadcaster::Turns::None && !isInGroup)
        turns = {++phaseRequests_, [this, kind](int other) { return hooks_.turns(other) == kind; }, {}};
    const auto catchUp = std::make_shared<NodeResync>(set_, node, std::move(turns), joinOf(node));
    {
        const std::lock_guard lock(mutex_);
        at(node).catchUp = catchUp;
        at(node).phase = Phase::CatchingUp;
        if (!at(node).problem.empty()) catchUp->linkLost();
    }
    catchUp->start();
}

NodeResync::Join NodeRestarter::joinOf(int node) {
    const std::lock_guard lock(mutex_);
    if (const auto group = at(node).group) return [group, node] { return group->caughtUp(node); };
    return [this, node]() -> Result<bool> {
        const auto admitted = set_.admit(node, [this, node](uint32_t view) { return hooks_.admitted(node, view); });
        if (!admitted) return admitted.error();
        return true;
    };
}

// Ends a node of a group that has failed. Returns false for a member.
bool NodeRestarter::cancels(int node, Phase phase) {
    if (phase == Phase::Member || phase == Phase::Over) return false;
    if (phase != Phase::Waiting && phase != Phase::Starting) { // tick() ends it after its loss
        set_.link(node).lose("the change was cancelled");
        return true;
    }
    failGroup(node, "the change was cancelled");
    return true;
}

void NodeRestarter::failGroup(int node, const std::string& why) {
    std::shared_ptr<NodeGroup> group;
    {
        const std::lock_guard lock(mutex_);
        Node& n = at(node);
        n.phase = Phase::Over;
        n.isRetired = n.isDiscarded = true;
        n.starting.reset();
        group = std::move(n.group);
    }
    group->fail(why);
}

void NodeRestarter::start(int node, int64_t nowNs) {
    {
        const std::lock_guard lock(mutex_);
        if (at(node).isRetired) return;
        ++at(node).tries;
    }
    log::debug(log::Topic::Node, "starts ", set_.link(node).describe(), " again");
    auto started = hooks_.start(node);
    if (!started) return fail(node, started.error().message, nowNs);
    const std::lock_guard lock(mutex_);
    at(node).starting = std::make_unique<StartingNode>(std::move(*started));
    at(node).phase = Phase::Starting;
}

void NodeRestarter::pollStart(int node, int64_t nowNs) {
    StartingNode& starting = *at(node).starting;
    const auto present = connected(starting);
    if (!present) {
        const std::string why = present.error().message;
        at(node).starting.reset();
        return fail(node, why, nowNs);
    }
    if (!present.value()) return;
    {
        const std::lock_guard lock(mutex_);
        at(node).phase = Phase::Readying;
        at(node).readyBy = Deadline::inMs(terms_.readyPatienceMs);
    }
    log::debug(log::Topic::Node, "restarted node ", node, " has connected");
    hooks_.connected(node, starting);
    at(node).starting.reset();
}

void NodeRestarter::fail(int node, const std::string& why, int64_t nowNs) {
    std::string line = set_.link(node).describe() + " did not rejoin: " + why + "; ";
    bool again = false, isInGroup = false;
    {
        const std::lock_guard lock(mutex_);
        Node& n = at(node);
        // the loss is caused by skipped frames: does not count as an attempt
        if (n.catchUp && n.catchUp->invalid() && std::exchange(skipsFrames_, false)) --n.tries;
        n.problem.clear();
        isInGroup = n.group != nullptr;
        again = n.tries < terms_.tries && !stopped_ && !n.isRetired && !isInGroup;
        n.phase = again ? Phase::Waiting : Phase::Over;
        const int64_t pauseMs = terms_.pausesMs[std::min(static_cast<size_t>(n.tries), terms_.pausesMs.size() - 1)];
        n.nextNs = nowNs + pauseMs * kNsPerMs;
        if (again)
            line += "next attempt in " + std::to_string(pauseMs / 1000) + " s (" + std::to_string(n.tries + 1) +
                    " of " + std::to_string(terms_.tries) + ")";
        else
            line +=
                "after " + std::to_string(n.tries) + (n.tries == 1 ? " try, " : " tries, ") + hooks_.tilesOfLost(node);
    }
    const std::string name = set_.link(node).describe();
    if (isInGroup) return failGroup(node, why.starts_with(name) ? why : name + ": " + why);
    log::warning(log::Topic::Node, line);
    if (!again) hooks_.gaveUp(node);
}

bool NodeRestarter::settled() const {
    const std::lock_guard lock(mutex_);
    for (size_t i = 0; i < nodes_.size(); ++i) {
        const NodeConnection& link = set_.link(static_cast<int>(i));
        if ((nodes_[i].catchUp && !nodes_[i].catchUp->done()) || (!link.alive() && !link.readerEnded())) return false;
    }
    return true;
}

// New members may have queued packets. These are sent before the nodes learn that the session ends.
void NodeRestarter::stop(const std::function<void()>& watch) {
    std::vector<int> ending;
    {
        const std::lock_guard lock(mutex_);
        if (stopped_) return;
        stopped_ = true;
        for (size_t i = 0; i < nodes_.size(); ++i) {
            Node& n = nodes_[i];
            if (n.phase == Phase::Member || n.phase == Phase::Over) continue;
            const bool linked = n.phase != Phase::Waiting && n.phase != Phase::Starting;
            if (linked) ending.push_back(static_cast<int>(i));
            if (n.catchUp) n.catchUp->linkLost();
            n.starting.reset();
            if (!linked) n.phase = Phase::Over;
        }
    }
    for (const int node : ending) set_.link(node).lose("the session ends");
    const Deadline deadline = Deadline::inMs(kStopPatienceMs);
    while (!settled() && !deadline.passed()) {
        watch();
        poll(nullptr, 0, 5);
    }
    const std::lock_guard lock(mutex_);
    for (Node& n : nodes_)
        if (n.phase != Phase::Member) n.phase = Phase::Over;
}

} // namespace mural
