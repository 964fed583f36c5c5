// The session's handling of lost and restarted nodes.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/json/json_text.hpp"
#include "common/log/log.hpp"
#include "nodes/head/session/head_session.hpp"
#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {
namespace {

// Returns the first name of `wanted` that `has` does not contain.
std::string firstMissing(const std::string& wanted, const std::vector<std::string>& has) {
    std::istringstream words(wanted);
    for (std::string word; words >> word;)
        if (std::ranges::find(has, word) == has.end()) return word;
    return "";
}

std::string seconds(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f s", value);
    return text;
}

} // namespace

NodeRestarter::Hooks HeadSession::returnHooks() {
    NodeRestarter::Hooks hooks;
    if (options_.startNode) hooks.start = [this](int node) { return options_.startNode(*plans_.nodePlan(node)); };
    hooks.connected = [this](int node, StartingNode& starting) { linkAgain(node, starting); };
    hooks.introduce = [this](int node) { introduceAgain(node); };
    hooks.whyNever = [this](int) -> std::string {
        if (!nodes_.canJoin())
            return "programs have sent more than the " + std::to_string(config_.cacheBytes >> 20) +
                   " MiB of the rejoin log; a larger --cache-size holds more";
        return "";
    };
    // Only members know the state of time-multiplexed nodes, moving areas and zooms.
    hooks.turns = [this](int node) {
        const auto plan = plans_.nodePlan(node);
        return plan->pass.period > 1       ? StreamBroadcaster::Turns::OfFrames
               : followsAssignments(*plan) ? StreamBroadcaster::Turns::OfAreas
                                           : StreamBroadcaster::Turns::None;
    };
    hooks.tilesOfLost = [this](int node) -> std::string {
        const auto plan = plans_.nodePlan(node);
        if (plan->pass.range > 0) return plan->movesRange ? "other nodes take its draws" : "its draws are missing";
        return plan->movesArea ? "other nodes take its tiles" : "its tiles keep their last picture";
    };
    hooks.admitted = [this](int node, uint32_t view) { return admit(node, view); };
    hooks.isOver = [this](int node) { forgetNode(node); };
    hooks.gaveUp = [this](int node) {
        takeSpareFor(node);
        checkForNodes();
    };
    return hooks;
}

void HeadSession::linkAgain(int node, StartingNode& starting) {
    uint32_t incarnation = 0;
    bool isNewNode = false;
    {
        const std::lock_guard lock(mutex_);
        ready_[static_cast<size_t>(node)] = false;
        refusals_[static_cast<size_t>(node)].clear();
        rerouted_.erase(node);
        introduced_[static_cast<size_t>(node)] = false;
        incarnation = ++incarnations_[static_cast<size_t>(node)];
        statistics_.forgetClock(node);
        isNewNode = isNew(node);
    }
    const auto plan = plans_.nodePlan(node);
    NodeEvents& events = *this; // a private base: make_unique could not convert
    auto link = std::make_unique<NodeConnection>(NodeLocation{node, plan->where}, std::move(starting.node.connection),
                                                 std::move(starting.node.process), events);
    link->setJoinsBatches(deltaNodes_.contains(node));
    link->setJoinsGroup(multicastNodes_.contains(node));
    nodes_.replace(node, std::move(link));
    nodes_.link(node).unpackBy(plan->pictureCodec, plan->transferScale);
    nodes_.link(node).startReading();
    NodeSetup setup = setupFor(*plan);
    setup.isResyncing = true;
    setup.incarnation = incarnation;
    if (!isNewNode) setup.swapMembers = 0; // the other members of its swap barrier continue without it
    setup.skipsFrames = returns_->skipsFrames();
    setup.delta = false; // its snapshot is not delta-coded; ResetDictionary starts the batches
    nodes_.sendAlone(node, wire::HeadCommand::Setup, toJson(setup));
}

// The restarted node connects to the other nodes of its picture: to members, and among restarted nodes to those
// introduced earlier. The other nodes accept the connection without further notice.
void HeadSession::introduceAgain(int node) {
    const auto stage = plans_.of(node);
    const NodePlan& plan = stage->plan.nodes[static_cast<size_t>(node)];
    const auto barrier = swapMembersOf(stage->config, stage->plan, plan);
    nlohmann::json pictures = nlohmann::json::object(), swaps = nlohmann::json::object();
    {
        const std::lock_guard lock(mutex_);
        if (isNew(node) && !barrier.empty()) {
            const int leader = barrier.front()->node;
            swaps[std::to_string(leader)] = facts_[static_cast<size_t>(leader)].swapBarrier;
        }
        for (int other = plan.collector; other < plan.collector + plan.pass.ranges; ++other) {
            const auto index = static_cast<size_t>(other);
            if (other != node && introduced_[index] && ready_[index] && nodes_.link(other).alive())
                pictures[std::to_string(other)] = facts_[index].exchange;
        }
        introduced_[static_cast<size_t>(node)] = true;
    }
    if (plan.pass.ranges < 2 && swaps.empty()) return;
    nodes_.sendAlone(node, wire::HeadCommand::Exchange,
                     jsonText(nlohmann::json{{"pictures", pictures}, {"swaps", swaps}}));
}

// The restarted node's GL must support everything that has been announced to programs.
Result<void> HeadSession::takeAgain(int node, NodeCapabilities facts) {
    {
        const std::lock_guard lock(mutex_);
        const auto index = static_cast<size_t>(node);
        if (ready_[index]) return Error{"it sent two ready messages"};
        if (!facts_[index].renderer.empty() && facts.renderer != facts_[index].renderer)
            return Error{"its GL is now \"" + facts.renderer + "\" instead of \"" + facts_[index].renderer +
                         "\"; their pictures differ"};
        const std::string missing = firstMissing(promisedExtensions_, facts.extensions);
        if (facts.glVersion < promisedGlVersion_ || !missing.empty())
            return Error{"its GL lacks features that programs already use: " +
                         (missing.empty() ? "an older version" : "no " + missing)};
        log::debug(log::Topic::Node, "restarted node ", node, " is ready: ", facts.renderer, ", pid ", facts.pid);
        facts_[index] = std::move(facts);
        ready_[index] = true;
    }
    returns_->ready(node);
    return {};
}

// Called with the lock that orders packets.
StreamBroadcaster::Admission HeadSession::admit(int node, uint32_t view) {
    const std::lock_guard membership(membership_);
    if (returns_->becomesMember(node)) return admission(node, view);
    StreamBroadcaster::Admission refused;
    refused.refused = true;
    return refused;
}

// Requires membership_, and the lock that orders packets.
StreamBroadcaster::Admission HeadSession::admission(int node, uint32_t view) {
    StreamBroadcaster::Admission admission;
    answers_.nodeJoins(node, view);
    plans_.nodeJoins(node, view);
    frames_.nodeJoins(node);
    driverEvents_.nodeJoins(node);
    programs_->memberCame(node, nodes_.link(node).describe());
    const std::lock_guard lock(mutex_);
    views_.joins(node, view);
    admission.incarnation = incarnations_[static_cast<size_t>(node)];
    admission.first = true; // of time-multiplexed nodes or nodes with moving areas
    const auto plan = currentPlan();
    for (size_t other = 0; other < plan->nodes.size(); ++other)
        admission.first =
            admission.first &&
            (totals_[other].lost || (plan->nodes[other].pass.period < 2 && !followsAssignments(plan->nodes[other])));
    totals_[static_cast<size_t>(node)].lost = false;
    for (size_t other = 0; other < plan->nodes.size(); ++other)
        if (totals_[other].lost || !nodes_.link(static_cast<int>(other)).alive())
            admission.absent.push_back(static_cast<uint32_t>(other));
    return admission;
}

Result<void> HeadSession::nodeTurns(int /*node*/, uint32_t number, const std::vector<std::byte>& turns) {
    returns_->turns(number, turns);
    return {};
}

Result<void> HeadSession::nodeSynchronized(int node, const wire::SynchronizedMessage& message) {
    returns_->synchronized(node, message);
    return {};
}

Result<void> HeadSession::nodeInView(int node, uint32_t view, const std::vector<wire::ClientFrame>& frames) {
    answers_.nodeInView(node, view);
    plans_.nodeInView(node, view);
    {
        const std::lock_guard lock(mutex_);
        const bool itself = views_.since(node) == view;
        views_.reached(node, view);
        if (!itself) return {};
    }
    const NodeRestarter::Numbers numbers = returns_->numbers(node);
    frames_.nodeJoined(node, numbers.framesGiven, monotonicNowNs()); // plus the frames that it has drawn itself
    frames_.nodeJoined(node, frames, monotonicNowNs());
    plans_.of(node)->balancer.nodeJoined(node);
    if (statistics_.isOn()) announceStatistics(); // its Setup may be older than the request
    announceOverlay();                            // the same
    int64_t joins = 0;
    bool wasStopped = false, isNewNode = false;
    {
        const std::lock_guard lock(mutex_);
        isNewNode = newNodes_.erase(node) > 0;
        NodeTotals& totals = totals_[static_cast<size_t>(node)];
        joins = isNewNode ? 0 : ++totals.joins;
        wasStopped = stopped_.erase(node) > 0;
        totals.snapshotBytes = static_cast<int64_t>(numbers.snapshotBytes);
        totals.secondsToRejoin = numbers.secondsToRejoin;
    }
    feed_.publish(ControlTopic::Events, {{"event", "node-joined"}, {"node", node}, {"joins", joins}});
    const bool first = absences_.contains(node) && joins == 1;
    log::line(log::Topic::Node, isNewNode ? log::Level::Debug : log::Level::Info, nodes_.link(node).describe(),
              first || isNewNode ? " joined " : " rejoined ", seconds(numbers.secondsToRejoin),
              first                     ? " after the start of the session, with a snapshot of "
              : wasStopped || isNewNode ? " after its start, with a snapshot of "
                                        : " after its loss, with a snapshot of ",
              (numbers.snapshotBytes + numbers.queuedBytes + (1 << 19)) >> 20, " MiB");
    return {};
}

void HeadSession::loseMember(int node, const std::string& why) {
    std::string refusal;
    {
        const std::lock_guard lock(mutex_);
        refusal = refusals_[static_cast<size_t>(node)];
    }
    if (returns_->lostWhileRestarting(node, refusal.empty() ? why : refusal)) return;
    const std::lock_guard membership(membership_);
    log::warning(log::Topic::Node, nodes_.link(node).describe(), " was lost: ", why, "; ", returns_->memberLost(node));
    feed_.publish(ControlTopic::Events, {{"event", "node-lost"}, {"node", node}, {"text", why}});
    goOnWithout(node);
}

// Starts the session with the nodes that connected. Absent nodes are restarted like lost ones.
void HeadSession::goOnWithoutAbsent() {
    for (const auto& [node, why] : absences_) {
        const std::lock_guard membership(membership_);
        const bool taken = plans_.nodePlan(node)->movesArea;
        log::warning(log::Topic::Node, nodes_.link(node).describe(), " is not connected yet: it ", why,
                     taken ? "; other nodes take its tiles until it joins" : "; its tiles stay empty until it joins");
        returns_->notThere(node);
        goOnWithout(node);
    }
}

// Call with membership_ locked.
void HeadSession::goOnWithout(int node) {
    {
        const std::lock_guard lock(mutex_);
        totals_[static_cast<size_t>(node)].lost = true;
        views_.lost(node);
    }
    answers_.nodeLost(node);
    plans_.nodeLost(node);
    frames_.nodeLost(node, monotonicNowNs());
    programs_->memberLost(node);
    std::vector<std::pair<uint32_t, uint32_t>> waiting; // requests that wait for this node
    {
        const std::lock_guard lock(mutex_);
        for (const auto& entry : gone_) waiting.push_back(entry.first);
    }
    for (const auto& window : waiting) windowGone(window, node);
    if (noneIsLeft()) noNodeIsLeft();
}

void HeadSession::noNodeIsLeft() {
    if (wallLost_.exchange(true)) return; // programs have gone on alone
    log::error(log::Topic::Session,
               "all render nodes are lost: programs continue alone, without the wall; restart the session");
    programs_->refuseFrom("all render nodes of this session are lost; restart it");
    programs_->reportHeadGone();
    announce({{"event", "wall-lost"}});
}

// True if no node lives and none can be restarted.
bool HeadSession::noneIsLeft() {
    if (returns_->awaited() || isMovingToSpare_) return false;
    const std::lock_guard lock(mutex_);
    return std::ranges::all_of(totals_, [](const NodeTotals& totals) { return totals.lost; });
}

} // namespace mural
