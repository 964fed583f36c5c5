// Changes of the session's plan: the operations `plan`, `layout` and `undo`. The control thread calls them.
//
// The control thread makes the new plan and the difference. The session's thread starts the new nodes, which receive
// the state of the programs and draw in silence. When all of them have caught up, one position in the stream makes them
// members and ends the membership of the others (exchangeMembers). Until then nothing has changed, so a failure only
// ends the new nodes.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <unistd.h>

#include "common/log/log.hpp"
#include "nodes/head/planning/delta_plan.hpp"
#include "nodes/head/planning/make_plan.hpp"
#include "nodes/head/session/head_session.hpp"
#include "nodes/session/plan_fields.hpp"
#include "nodes/session/session_secret.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;
using Kind = ControlArgument::Kind;

// The sum stays below the patience of mural ctl.
constexpr int64_t kJoinMs = 16'000;       // until all new nodes have caught up
constexpr int64_t kCancelMs = 2'000;      // until they have ended after a failure
constexpr int64_t kExchangeMs = 4'000;    // until the connections of all nodes accept data
constexpr int64_t kSettleMs = 4'000;      // until all nodes have passed an earlier change
constexpr int64_t kLastFramesMs = 10'000; // until a node has finished its last frames
constexpr int64_t kProcessEndMs = 500;    // from its Goodbye to the end of its process

constexpr int kSpareAttempts = 6;
constexpr int64_t kSparePauseMs = 5'000; // between two attempts
constexpr size_t kMaxHistory = 16;
constexpr int64_t kMostRevertSeconds = 3600;
constexpr int kRevertAttempts = 6;
constexpr int64_t kRevertPauseMs = 5'000; // between two attempts
constexpr const char* kRevertAfter = "revert-after";
constexpr const char* kOff = "off";

std::vector<ControlArgument> withTerms(std::vector<ControlArgument> arguments) {
    arguments.push_back({"dry-run", Kind::Truth, false, "only report the nodes that would start and end"});
    arguments.push_back({kRevertAfter, Kind::Whole, false, "seconds after which the change reverts, unless kept"});
    return arguments;
}

std::string nameOf(const std::string& name, size_t index) { return name.empty() ? std::to_string(index) : name; }

// Returns an error if --verify would compare different pictures.
Result<void> checkVerification(const SessionConfig& config) {
    const PassCounts& p = config.passes;
    if (config.verifyEvery > 0 && (p.stereo != StereoMode::Off || p.samples > 1 || !p.zoom.none()))
        return Error{"--verify compares with the program's own picture, which stereo, subpixels and zoom change"};
    return {};
}

// Returns the canvases of the file with their layouts.
Json canvasesJson(const BalancePlan& plan) {
    Json canvases = Json::array();
    for (size_t c = 0; c < plan.config.canvases.size(); ++c) {
        const config::ResolvedCanvas& canvas = plan.config.canvases[c];
        Json layouts = Json::array();
        std::string shown = kOff;
        for (size_t i = 0; i < canvas.layouts.size(); ++i) {
            const config::Index layout = canvas.layouts[i];
            const std::string name = layout == config::kNone
                                         ? kOff
                                         : nameOf(plan.config.layouts[config::at(layout)].name, config::at(layout));
            layouts.push_back(name);
            if (plan.input.activeLayouts[c] == static_cast<config::Index>(i)) shown = name;
        }
        canvases.push_back({{"canvas", nameOf(canvas.name, c)}, {"layout", shown}, {"layouts", layouts}});
    }
    return canvases;
}

} // namespace

void HeadSession::addPlanOperations(ControlOperations& operations) {
    operations.add({"layout", "layout [CANVAS] [LAYOUT] [dry-run] [REVERT-AFTER]",
                    "show another layout on a canvas, or turn it off; without arguments: list the layouts",
                    withTerms({{"canvas", Kind::Text, false, "name of the canvas"},
                               {"layout", Kind::Text, false, "name of the layout, or off"}}),
                    [this](const Json& arguments) { return changeLayout(arguments); }});
    operations.add({"plan", "plan [OPTIONS] [dry-run] [REVERT-AFTER]",
                    "divide the work in another way, see mural change; without arguments: the current options",
                    withTerms({{"options", Kind::Object, false, "fields of the plan"}}),
                    [this](const Json& arguments) -> Result<Json> {
                        const auto options = arguments.find("options");
                        if (options == arguments.end())
                            return Json{{"options", planFieldsOf(plans_.current()->config)}};
                        auto config = withPlanFields(plans_.current()->config, *options);
                        if (!config) return config.error();
                        auto terms = termsOf(arguments);
                        if (!terms) return terms.error();
                        return changePlan(std::move(*config), *terms);
                    }});
    operations.add(
        {"move-nodes", "move-nodes FROM TO [dry-run] [REVERT-AFTER]", "run the nodes of a host on another one",
         withTerms({{"from", Kind::Text, true, "host, as mural ctl nodes shows it"},
                    {"to", Kind::Text, true, "host that takes over its nodes"}}),
         [this](const Json& arguments) -> Result<Json> {
             auto terms = termsOf(arguments);
             if (!terms) return terms.error();
             return moveNodes(arguments.at("from").get<std::string>(), arguments.at("to").get<std::string>(), *terms);
         }});
    operations.add({"keep", "", "keep the last change, which would otherwise revert", {}, [this](const Json&) {
                        return keepChange();
                    }});
    operations.add({"undo",
                    "undo [dry-run]",
                    "return to the plan before the last change",
                    {{"dry-run", Kind::Truth, false, "only report the nodes that would start and end"}},
                    [this](const Json& arguments) { return undoChange({arguments.value("dry-run", false)}); }});
}

Result<HeadSession::ChangeTerms> HeadSession::termsOf(const Json& arguments) {
    ChangeTerms terms;
    terms.isDryRun = arguments.value("dry-run", false);
    if (const auto after = arguments.find(kRevertAfter); after != arguments.end()) {
        terms.revertAfterSeconds = after->get<int64_t>();
        if (terms.revertAfterSeconds < 1 || terms.revertAfterSeconds > kMostRevertSeconds)
            return Error{"a change reverts after 1 to " + std::to_string(kMostRevertSeconds) + " s, not " +
                         std::to_string(terms.revertAfterSeconds)};
    }
    return terms;
}

Result<Json> HeadSession::keepChange() {
    if (!provisional_.keep()) return Error{"no change is about to revert"};
    log::info(log::Topic::Session, "the last change stays at the request of mural ctl keep");
    return Json::object();
}

// Called by the thread of provisional_.
void HeadSession::revertChange() {
    const ChangeTerms terms{false, 0, true};
    Result<Json> reverted = undoChange(terms);
    for (int attempt = 1; !reverted && attempt < kRevertAttempts && !finishing_; ++attempt) {
        for (const Deadline pause = Deadline::inMs(kRevertPauseMs); !pause.passed() && !finishing_;)
            poll(nullptr, 0, 20);
        if (!finishing_) reverted = undoChange(terms); // another change or the restart of a node was in progress
    }
    if (finishing_) return;
    if (reverted)
        log::info(log::Topic::Session, "the last change has been reverted, because nobody has kept it");
    else
        log::warning(log::Topic::Session, "the last change cannot be reverted: ", reverted.error().message);
}

Result<Json> HeadSession::moveNodes(const std::string& from, const std::string& to, ChangeTerms terms) {
    const auto stage = plans_.current();
    const bool isKnown = from != "local" && std::ranges::any_of(stage->plan.nodes, [&](const NodePlan& node) {
                             return !node.isVacant && node.where == from;
                         });
    if (!isKnown) return Error{"no node of the session runs on the host \"" + from + "\"; see mural ctl nodes"};
    if (to.empty() || to.find_first_of("= \t") != std::string::npos || to.front() == '-')
        return Error{"\"" + to + "\" is no name of a host"};
    SessionConfig config = stage->config;
    config.movedHosts.push_back(from + "=" + to);
    return changePlan(std::move(config), terms);
}

// Called by the session's thread when a node stays lost. The move runs in a thread of its own, because it waits for
// this one.
void HeadSession::takeSpareFor(int node) {
    const std::string from = plans_.nodePlan(node)->where;
    const bool isBack = nodes_.link(node).alive() || returns_->isRestarting(node);
    if (spares_.empty() || from == "local" || finishing_ || isBack || hasLeft(node)) return;
    if (spareMove_.joinable()) {
        if (!isMovingToSpare_)
            spareMove_.join();
        else
            return waitingForSpare_.push_back(node);
    }
    const std::string to = spares_.front();
    spares_.erase(spares_.begin());
    log::info(log::Topic::Node, "the spare host ", to, " takes over the nodes of ", from);
    isMovingToSpare_ = true;
    spareMove_ = std::thread([this, from, to, node] {
        if (provisional_.keep())
            log::warning(log::Topic::Session, "the last change does not revert any more, because a host was lost");
        auto moved = moveNodes(from, to, {});
        for (int attempt = 1; !moved && attempt < kSpareAttempts && !finishing_; ++attempt) {
            // other nodes of the host may be in their restarts, or another change may be in progress
            for (const Deadline pause = Deadline::inMs(kSparePauseMs); !pause.passed() && !finishing_;)
                poll(nullptr, 0, 20);
            if (!finishing_) moved = moveNodes(from, to, {});
        }
        if (!moved && !finishing_)
            log::warning(log::Topic::Node, "the spare host ", to, " cannot take over the nodes of ", from, ": ",
                         moved.error().message);
        lostAfterMove_ = moved ? -1 : node;
        isMovingToSpare_ = false;
        checksForNodes_ = true;
    });
}

Result<Json> HeadSession::undoChange(ChangeTerms terms) {
    std::optional<SessionConfig> before;
    {
        const std::lock_guard lock(mutex_);
        if (!history_.empty()) before = history_.back();
    }
    if (!before) return Error{"no change has happened that can be undone"};
    const auto left = provisional_.left();
    const bool wasPending = !terms.isDryRun && provisional_.keep(); // the undo is its reversion
    auto done = changePlan(std::move(*before), terms);
    if (!done && wasPending) provisional_.begin(std::max(*left, std::chrono::milliseconds(kRevertPauseMs)));
    if (!done || terms.isDryRun) return done;
    const std::lock_guard lock(mutex_);
    for (int i = 0; i < 2 && !history_.empty(); ++i) history_.pop_back(); // the change, and its undo
    return done;
}

Result<Json> HeadSession::changeLayout(const Json& arguments) {
    const auto stage = plans_.current();
    if (stage->config.configFile.empty() || !stage->plan.balance)
        return Error{"this session has no canvases with layouts; start it with --config"};
    const std::string canvas = arguments.value("canvas", ""), layout = arguments.value("layout", "");
    if (canvas.empty() && layout.empty()) return Json{{"canvases", canvasesJson(*stage->plan.balance)}};
    if (canvas.empty() || layout.empty())
        return Error{"a layout is shown on a canvas; name both, such as mural ctl layout wall 2D"};
    SessionConfig config = stage->config;
    std::erase_if(config.layouts, [&](const std::string& other) { return other.starts_with(canvas + ":"); });
    config.layouts.push_back(canvas + ":" + layout);
    auto terms = termsOf(arguments);
    if (!terms) return terms.error();
    return changePlan(std::move(config), *terms);
}

// Prepares a change and carries it out. Errors: nothing has changed.
Result<Json> HeadSession::changePlan(SessionConfig config, ChangeTerms terms) {
    const int64_t beganNs = monotonicNowNs();
    if (const auto possible = checkVerification(config); !possible) return possible.error();
    const std::unique_lock changing(changing_, std::try_to_lock);
    if (!changing.owns_lock()) return Error{"another change is in progress; try again"};
    if (finishing_) return Error{"the session is ending"};
    if (const auto left = provisional_.left(); left && !terms.isDryRun && !terms.isReversion) {
        if (left->count() == 0) return Error{"the last change is being reverted; try again"};
        return Error{"the last change reverts in " + std::to_string((left->count() + 999) / 1000) +
                     " s; first run mural ctl keep, or mural ctl undo"};
    }
    const Deadline settled = Deadline::inMs(kSettleMs);
    while (!plans_.isSettled() && !settled.passed()) poll(nullptr, 0, 2);
    if (!plans_.isSettled()) return Error{"nodes have not finished the frames before the last change; try again"};
    char host[256] = "localhost";
    gethostname(host, sizeof(host) - 1);
    auto wanted = makePlan(config, host);
    if (!wanted) return wanted.error();
    const auto difference = [&] {
        const auto stage = plans_.current();
        return changeOf(
            {stage->config, stage->plan, plans_.outputs()}, config, *wanted,
            [this](int node) { return nodes_.link(node).alive() && !returns_->isRestarting(node); }, nodeCount());
    };
    auto change = difference();
    if (!change) return change.error();
    const auto nodesJson = [&] {
        return Json{{"joined", change->joining},
                    {"left", change->leaving},
                    {"kept", change->kept},
                    {"warnings", change->plan.warnings}};
    };
    if (terms.isDryRun) return nodesJson();
    const size_t members = change->joining.size() + change->kept.size();
    if (!change->joining.empty()) {
        if (const auto can = canTakeNodes(members); !can) return can.error();
    }
    SessionConfig before = plans_.current()->config;
    const bool skips = returns_->skipsFrames();
    Result<void> done = carryOut(config, *change);
    if (!done && returns_->skipsFrames() != skips) { // the frames of the new nodes depended on skipped ones
        change = difference();
        if (!change) return change.error();
        done = carryOut(config, *change);
    }
    if (!done) {
        checksForNodes_ = true; // the new nodes counted as nodes that may come
        return Error{"nothing has changed: " + done.error().message};
    }
    {
        const std::lock_guard lock(mutex_);
        history_.push_back(std::move(before));
        if (history_.size() > kMaxHistory) history_.pop_front();
    }
    int turns = 1;
    const auto plan = currentPlan();
    for (const NodePlan& node : plan->nodes) turns = std::max(turns, node.pass.period);
    if (programs_->latency() < static_cast<uint32_t>(turns))
        programs_->setLatency(static_cast<uint32_t>(turns)); // so that the turns overlap
    Json result = nodesJson();
    if (terms.revertAfterSeconds > 0) {
        provisional_.begin(std::chrono::seconds(terms.revertAfterSeconds));
        result["revertsInSeconds"] = terms.revertAfterSeconds;
    }
    result["seconds"] = static_cast<double>(monotonicNowNs() - beganNs) / static_cast<double>(kNsPerS);
    feed_.publish(ControlTopic::Events,
                  {{"event", "plan-changed"}, {"joined", result["joined"]}, {"left", result["left"]}});
    return result;
}

// Returns an error if the session cannot bring new nodes to the state of its programs.
Result<void> HeadSession::canTakeNodes(size_t members) {
    const std::string subject = "no node can join this session: ";
    if (!options_.startNode || !nodes_.hasRejoinLog())
        return Error{subject + "it keeps no state of its programs; start it with --restart-nodes 1 or more"};
    if (!nodes_.canJoin())
        return Error{subject + "programs have sent more than the " + std::to_string(config_.cacheBytes >> 20) +
                     " MiB of the rejoin log; start the session with a larger --cache-size"};
    if (members > 1 && !fetchesCopies_)
        return Error{subject + "it began with one node, so programs do not send the pixels that they copy from "
                               "windows; start it with two nodes, or with --record"};
    return {};
}

Result<void> HeadSession::carryOut(SessionConfig config, PlanChange change) {
    if (static_cast<size_t>(nodeCount()) + change.joining.size() > NodeLinks::kMaxNodes)
        return Error{"the session has had " + std::to_string(nodeCount()) + " nodes and can have " +
                     std::to_string(NodeLinks::kMaxNodes) + "; start a new one"};
    for (const int node : change.leaving)
        if (returns_->isRestarting(node) && nodes_.link(node).alive())
            return Error{nodes_.link(node).describe() + " is being restarted; try again when it has joined"};
    const auto pending = std::make_shared<PendingChange>();
    pending->config = std::move(config);
    pending->change = std::move(change);
    {
        const std::lock_guard lock(mutex_);
        pending_ = pending;
    }
    const Deadline deadline = Deadline::inMs(kJoinMs);
    while (!pending->hasBegun && !finishing_) poll(nullptr, 0, 1);
    if (finishing_) return Error{"the session is ending"};
    if (!pending->group) return exchangeNodes(*pending);
    while (!pending->group->outcome() && !deadline.passed() && !finishing_) poll(nullptr, 0, 1);
    pending->group->fail(finishing_ ? "the session is ending"
                                    : "the new nodes have not caught up within " + std::to_string(kJoinMs / 1000) +
                                          " s; see mural stat");
    // Otherwise the exchange is in progress. It ends when all connections accept data: watchNodes() loses others.
    while (!pending->group->outcome() && !finishing_) poll(nullptr, 0, 1);
    const auto outcome = pending->group->outcome();
    if (outcome && *outcome) return {};
    const auto isEnding = [&] {
        return std::ranges::any_of(pending->change.joining, [this](int n) { return returns_->isRestarting(n); });
    };
    for (const Deadline end = Deadline::inMs(kCancelMs); isEnding() && !end.passed();) poll(nullptr, 0, 2);
    return outcome ? *outcome : Result<void>(Error{"the session is ending"});
}

// Called by the session's thread: only it starts nodes.
void HeadSession::beginPlanChange() {
    std::shared_ptr<PendingChange> pending;
    {
        const std::lock_guard lock(mutex_);
        pending = std::move(pending_);
    }
    if (!pending) return;
    const PlanChange& change = pending->change;
    const size_t count = change.joining.size();
    for (const int node : change.joining) {
        const NodePlan& plan = change.plan.nodes[static_cast<size_t>(node)];
        nodes_.add(std::make_unique<NodeConnection>(NodeLocation{node, plan.where}, nullptr, nullptr,
                                                    static_cast<NodeEvents&>(*this)));
        statistics_.addNode(NodeClock::ofNode(plan.reach == NodeReach::SharedMemory));
    }
    answers_.addNodes(count);
    frames_.addNodes(count);
    std::shared_ptr<NodeGroup> group;
    if (count > 0)
        group = std::make_shared<NodeGroup>(change.joining, [this, changeOfGroup = std::weak_ptr(pending)] {
            const auto held = changeOfGroup.lock(); // carryOut() keeps it until the outcome, or the session ends
            return held ? exchangeNodes(*held) : Result<void>(Error{"the session is ending"});
        });
    if (group) returns_->addGroup(group);
    pending->stage = plans_.prepare(pending->config, change.plan);
    if (nodes_.multicast() != nullptr)
        for (const int node : nodesForMulticast(pending->config.stream, change.plan)) multicastNodes_.insert(node);
    if (nodes_.hasDeltaStream()) {
        const auto planned =
            planDelta(pending->config, change.plan, [this](int node) { return multicastNodes_.contains(node); });
        deltaNodes_.insert(planned.nodes.begin(), planned.nodes.end());
    }
    if (exchangeSecret_.empty())
        if (const auto secret = makeSessionSecret()) exchangeSecret_ = toHex(secret.value());
    const std::lock_guard lock(mutex_);
    for (const int node : change.joining) {
        facts_.emplace_back();
        ready_.push_back(false);
        introduced_.push_back(true);
        incarnations_.push_back(0);
        refusals_.emplace_back();
        NodeTotals& totals = totals_.emplace_back();
        totals.node = node;
        totals.lost = true; // until it joins
        newNodes_.insert(node);
    }
    views_.addNodes(count);
    pending->group = std::move(group);
    pending->hasBegun = true;
}

// The one position of the change. Called by the thread of the last new node's resync, or by the control thread.
Result<void> HeadSession::exchangeNodes(PendingChange& pending) {
    const PlanChange& change = pending.change;
    StreamBroadcaster::MemberExchange exchange;
    exchange.joining = change.joining;
    Result<void> possible;
    std::unique_lock membership(membership_, std::defer_lock);
    exchange.atPosition = [&](uint32_t view) {
        membership.lock();
        possible = returns_->exchange(pending.group.get(), change.leaving);
        if (!possible) return false;
        std::set<int> kept;
        std::vector<int> draining; // leaving nodes whose loss is not handled yet
        {
            const std::lock_guard lock(mutex_);
            const int64_t nowNs = monotonicNowNs();
            for (const int node : change.kept)
                if (!totals_[static_cast<size_t>(node)].lost) kept.insert(node);
            for (const int node : change.leaving) {
                leavingSince_[node] = nowNs;
                if (totals_[static_cast<size_t>(node)].lost) continue;
                draining.push_back(node);
                leaving_.insert(node);
            }
        }
        exchange.leaving = draining;
        plans_.change(pending.stage, std::move(kept), draining, view);
        pacer_.endPaces(); // of the earlier plan's equalizers
        sentFrames_.areWanted = pending.stage->balancer.movesZooms();
        if (std::ranges::any_of(change.plan.nodes, followsAssignments))
            exchange.viewports = pending.stage->balancer.viewports();
        return true;
    };
    exchange.announce = [this](int node, uint32_t view) { return admission(node, view); };
    const auto done = nodes_.exchangeMembers(exchange, Deadline::inMs(kExchangeMs));
    if (!possible) return possible;
    if (!done) return done;
    log::info(log::Topic::Session, "the plan of the session has changed: new nodes ", change.joining.size(), ", ended ",
              exchange.leaving.size(), ", unchanged ", change.kept.size());
    return {};
}

// Ends the processes of nodes that have left with a change of the plan, and moves nodes that wait for a spare host.
void HeadSession::endLeftNodes(int64_t nowNs) {
    if (!isMovingToSpare_) {
        if (const int node = lostAfterMove_.exchange(-1); node >= 0) waitingForSpare_.push_back(node);
        for (const int node : std::exchange(waitingForSpare_, {})) takeSpareFor(node);
    }
    if (checksForNodes_.exchange(false)) checkForNodes();
    std::map<int, int64_t> leaving;
    {
        const std::lock_guard lock(mutex_);
        leaving = leavingSince_;
    }
    for (const auto& [node, sinceNs] : leaving) {
        NodeConnection& link = nodes_.link(node);
        if (!link.readerEnded()) {
            if (nowNs - std::max(sinceNs, link.lastProgressNs(nowNs)) > kLastFramesMs * kNsPerMs)
                link.lose("it did not finish its last frames in time");
            continue;
        }
        link.endAfterGoodbye(Deadline::inMs(kProcessEndMs));
        forgetNode(node);
        const std::lock_guard lock(mutex_);
        leavingSince_.erase(node);
    }
}

// Frees what a node has used that never joined or has left for good. Its number is not used again. Called by the
// session's thread, after the node's reader has ended.
void HeadSession::forgetNode(int node) {
    windowPictures_.forget(node);
    nodes_.retire(node);
    multicastNodes_.erase(node);
    deltaNodes_.erase(node);
    {
        const std::lock_guard lock(announceMutex_);
        overlayOfNodes_.erase(node);
    }
    const std::lock_guard lock(mutex_);
    if (newNodes_.erase(node) > 0) refusedNodes_.insert(node);
    std::vector<std::string>().swap(facts_[static_cast<size_t>(node)].extensions); // the largest part
}

// Called by the session's thread. A thread that exchanges nodes holds the lock while it waits for connections, and this
// thread must watch them.
void HeadSession::checkForNodes() {
    const std::unique_lock membership(membership_, std::try_to_lock);
    if (!membership.owns_lock())
        checksForNodes_ = true; // with the next tick
    else if (noneIsLeft())
        noNodeIsLeft();
}

bool HeadSession::hasLeft(int node) {
    const auto plan = currentPlan();
    const auto index = static_cast<size_t>(node);
    const bool isPlanned = index < plan->nodes.size() && !plan->nodes[index].isVacant;
    return !isPlanned && !nodes_.link(node).alive();
}

} // namespace mural
