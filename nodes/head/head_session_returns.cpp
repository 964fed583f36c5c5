// What the session does about nodes that are lost, and about those that come back.
#include <algorithm>
#include <sstream>

#include "nodes/head/head_session.hpp"

namespace mural {
namespace {

// Those of `wanted` that `has` lacks, by one name.
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

NodeReturns::Hooks HeadSession::returnHooks() {
    NodeReturns::Hooks hooks;
    if (options_.startNode) hooks.start = [this](int node) { return options_.startNode(plan_.nodes[static_cast<size_t>(node)]); };
    hooks.connected = [this](int node, StartingNode& starting) { linkAgain(node, starting); };
    hooks.whyNever = [this](int node) -> std::string {
        if (plan_.nodes[static_cast<size_t>(node)].pass.ranges > 1) return "nodes that share draws (--db) are not started again";
        if (!nodes_.canJoin()) return "programs have sent more than the " + std::to_string(config_.storeBytes >> 20) + " MiB that are kept to start a node again; --store gives more";
        return "";
    };
    // Nodes that only members can tell how the picture is divided: whose turn it is, or by which areas.
    hooks.turns = [this](int node) {
        const NodePlan& plan = plan_.nodes[static_cast<size_t>(node)];
        return plan.pass.period > 1 ? NodeSet::Turns::OfFrames : plan.queue >= 0 ? NodeSet::Turns::OfAreas : NodeSet::Turns::None;
    };
    hooks.tilesOfLost = [this](int node) { return std::string(plan_.nodes[static_cast<size_t>(node)].queue >= 0 ? "the others take its tiles" : "its tiles stay as they were"); };
    hooks.admitted = [this](int node, uint32_t view) { return admit(node, view); };
    hooks.gaveUp = [this](int, const std::string& line) {
        control_.say(line);
        const std::lock_guard membership(membership_);
        if (noneIsLeft()) noNodeIsLeft();
    };
    hooks.say = [this](const std::string& line) { control_.say(line); };
    return hooks;
}

void HeadSession::linkAgain(int node, StartingNode& starting) {
    {
        const std::lock_guard lock(mutex_);
        ready_[static_cast<size_t>(node)] = false;
        refusals_[static_cast<size_t>(node)].clear();
        rerouted_.erase(node);
    }
    const NodePlan& plan = plan_.nodes[static_cast<size_t>(node)];
    NodeEvents& events = *this; // a private base: make_unique could not convert
    auto link = std::make_unique<NodeLink>(NodePlace{node, plan.where}, std::move(starting.node.connection), std::move(starting.node.process), events);
    link->setJoinsBatches(economical_.contains(node));
    link->setJoinsGroup(multicastNodes_.contains(node));
    nodes_.replace(node, std::move(link));
    nodes_.link(node).startReading();
    NodeSetup setup = setupFor(plan);
    setup.catchesUp = true;
    setup.swapMembers = 0; // the others of its swap barrier go on without it
    setup.skipsFrames = returns_->skipsFrames();
    setup.economy = false; // what it is given first comes as it is; NewHistory says from where on in batches
    nodes_.sendSetup(node, toJson(setup));
}

// What programs were told of the nodes' GL must hold for this one.
Result<void> HeadSession::takeAgain(int node, NodeFacts facts) {
    {
        const std::lock_guard lock(mutex_);
        const auto index = static_cast<size_t>(node);
        if (ready_[index]) return Error{"it said twice that it is ready"};
        if (facts.renderer != facts_[index].renderer)
            return Error{"it draws by another GL now (" + facts.renderer + ") than before (" + facts_[index].renderer + "); its pictures would not fit the others'"};
        const std::string missing = firstMissing(promisedExtensions_, facts.extensions);
        if (facts.glVersion < promisedGlVersion_ || !missing.empty())
            return Error{"its GL has less than programs were promised: " + (missing.empty() ? "an older version" : "no " + missing)};
        facts_[index] = std::move(facts);
        ready_[index] = true;
    }
    returns_->ready(node);
    return {};
}

// Under the lock that orders packets.
NodeSet::Admission HeadSession::admit(int node, uint32_t view) {
    const std::lock_guard membership(membership_);
    if (!returns_->becomesMember(node)) return NodeSet::Admission::Refused;
    answers_.nodeJoins(node, view);
    pictures_.nodeJoins(node, view);
    frames_.nodeJoins(node);
    news_.nodeJoins(node);
    const std::lock_guard lock(mutex_);
    views_.joins(node, view);
    bool first = true; // of those that take turns, or have moving areas
    for (size_t other = 0; other < plan_.nodes.size(); ++other) first = first && (totals_[other].lost || (plan_.nodes[other].pass.period < 2 && plan_.nodes[other].queue < 0));
    totals_[static_cast<size_t>(node)].lost = false;
    return first ? NodeSet::Admission::FirstMember : NodeSet::Admission::Member;
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
    pictures_.nodeInView(node, view);
    {
        const std::lock_guard lock(mutex_);
        const bool itself = views_.since(node) == view;
        views_.reached(node, view);
        if (!itself) return {};
    }
    const NodeReturns::Numbers numbers = returns_->numbers(node);
    frames_.nodeJoined(node, numbers.framesGiven, monotonicNowNs()); // and what it has seen itself
    frames_.nodeJoined(node, frames, monotonicNowNs());
    dealer_.nodeJoined(node);
    {
        const std::lock_guard lock(mutex_);
        NodeTotals& totals = totals_[static_cast<size_t>(node)];
        ++totals.joins;
        totals.snapshotBytes = static_cast<int64_t>(numbers.snapshotBytes);
        totals.secondsToBack = numbers.secondsToBack;
    }
    control_.say(nodes_.link(node).describe() + " is back in the picture " + seconds(numbers.secondsToBack) + " after it was lost; it was given " +
                 std::to_string((numbers.snapshotBytes + numbers.queuedBytes + (1 << 19)) >> 20) + " MiB");
    return {};
}

void HeadSession::loseMember(int node, const std::string& why) {
    std::string refusal;
    {
        const std::lock_guard lock(mutex_);
        refusal = refusals_[static_cast<size_t>(node)];
    }
    if (returns_->lostOnItsWay(node, refusal.empty() ? why : refusal)) return;
    const std::lock_guard membership(membership_);
    {
        const std::lock_guard lock(mutex_);
        totals_[static_cast<size_t>(node)].lost = true;
        views_.lost(node);
    }
    control_.say(nodes_.link(node).describe() + " was lost: " + why + "; " + returns_->memberLost(node));
    answers_.nodeLost(node);
    pictures_.nodeLost(node);
    frames_.nodeLost(node, monotonicNowNs());
    dealer_.nodeLost(node);
    std::vector<std::pair<uint32_t, uint32_t>> waiting; // for this node's word
    {
        const std::lock_guard lock(mutex_);
        for (const auto& entry : gone_) waiting.push_back(entry.first);
    }
    for (const auto& window : waiting) windowGone(window, node);
    if (noneIsLeft()) noNodeIsLeft();
}

// And none comes back.
bool HeadSession::noneIsLeft() {
    if (returns_->awaited()) return false;
    const std::lock_guard lock(mutex_);
    return std::ranges::all_of(totals_, [](const NodeTotals& totals) { return totals.lost; });
}

} // namespace mural
