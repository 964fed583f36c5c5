#include "nodes/head/session/head_session.hpp"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <thread>

#include "common/json/json_text.hpp"
#include "common/log/log.hpp"
#include "nodes/head/frames/picture_place.hpp"
#include "nodes/head/membership/kept_streams.hpp"
#include "nodes/head/remote/remote_walls.hpp"
#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/node_messages.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

constexpr int64_t kTickMs = 50;
constexpr int64_t kStartTickMs = 5;             // while nodes start or catch up
constexpr int64_t kProgressNs = 200 * kNsPerMs; // at most 5 lines per second
constexpr int64_t kOutputProgressMs = 20'000;   // below the silence after which `mural run` gives up the head
constexpr int64_t kRemotePatienceMs = 3000;     // for remote walls to show the last picture
constexpr int64_t kProcessPatienceMs = 2000;    // time between a node's Bye and the end of its process

std::vector<NodeClock> clocksOf(const SessionPlan& plan) {
    std::vector<NodeClock> clocks;
    for (const NodePlan& node : plan.nodes) clocks.push_back(NodeClock::ofNode(node.reach == NodeReach::SharedMemory));
    return clocks;
}

std::map<int, std::string> absencesOf(const std::vector<LaunchedNode>& nodes) {
    std::map<int, std::string> absences;
    for (size_t i = 0; i < nodes.size(); ++i)
        if (!nodes[i].connection) absences[static_cast<int>(i)] = nodes[i].absence;
    return absences;
}

} // namespace

HeadSession::HeadSession(SessionConfig config, SessionPlan plan, std::vector<LaunchedNode> nodes,
                         ControlChannel& control, HeadOptions options)
    : config_(std::move(config)),
      control_(control),
      options_(std::move(options)),
      statistics_(clocksOf(plan)),
      overlay_(makeOverlay(options_.overlay, config_.overlay)),
      overlayMode_(config_.overlay),
      pacer_([this](uint32_t client, uint32_t finished, uint32_t shown) {
          if (serving_) programs_->credit(client, finished, shown);
      }),
      frames_(static_cast<int>(nodes.size()),
              [this](uint32_t client, uint32_t finished, uint32_t shown) { pacer_.add(client, finished, shown); }),
      answers_(static_cast<int>(nodes.size()),
               [this](uint32_t client, Reply reply) {
                   if (serving_) programs_->reply(client, std::move(reply));
               }),
      plans_(config_, std::move(plan),
             {[this](const WindowPicture& picture) {
                  frames_.delayPicture(picture.client, picture.frame);
                  frames_.isOn(picture.client, picture.window, picture.nativeWindow);
              },
              [this](WindowPicture picture) { output_->add(std::move(picture)); },
              [this] { output_->closeWall(); },
              {[this](const ViewportAssignment& areas) {
                   nodes_.scheduleBeforeNextPacket(wire::HeadCommand::ViewportAssignment, bytesOf(areas));
               },
               [this](const RangeAssignment& ranges) {
                   nodes_.scheduleBeforeNextPacket(wire::HeadCommand::RangeAssignment, bytesOf(ranges));
               },
               [this](uint32_t client, double framesPerSecond) { pacer_.setPace(client, framesPerSecond); },
               [this](uint32_t client, uint32_t window) {
                   wantedRedraw_ = {client, window};
               }}}),
      advice_(config_, static_cast<int>(nodes.size())),
      absences_(absencesOf(nodes)),
      views_(nodes.size()),
      facts_(nodes.size()),
      ready_(nodes.size(), false),
      introduced_(nodes.size(), true),
      incarnations_(nodes.size(), 0),
      refusals_(nodes.size()),
      totals_(nodes.size()) {
    NodeEvents& events = *this; // make_unique can't convert to a private base
    for (int node = 0; node < nodeCount(); ++node) {
        LaunchedNode& launched = nodes[static_cast<size_t>(node)];
        totals_[static_cast<size_t>(node)].node = node;
        ready_[static_cast<size_t>(node)] = !launched.connection; // the start does not wait for an absent node
        nodes_.add(std::make_unique<NodeConnection>(NodeLocation{node, launched.plan.where},
                                                    std::move(launched.connection), std::move(launched.process),
                                                    events));
    }
    ReturnTerms terms;
    spares_ = config_.spareHosts;
    terms.tries = spares_.empty() ? config_.restartNodes : std::min(config_.restartNodes, 1);
    terms.readyPatienceMs = options_.readyPatienceMs;
    if (terms.tries > 0 && options_.startNode) {
        RejoinLog::MakeStream makeStream = makeCapturedStream;
        if (isNative())
            makeStream = [isOneMachine = isOneMachine()](size_t most) { return makeNativeStream(most, isOneMachine); };
        nodes_.setRejoinLog(std::make_unique<RejoinLog>(static_cast<uint64_t>(config_.cacheBytes), makeStream));
    }
    returns_ = std::make_unique<NodeRestarter>(std::move(terms), nodes_, returnHooks());
    // other displays need no pictures in any plan
    if (plans_.current()->takesPictures || config_.display == Display::Windows)
        output_ = std::make_unique<PictureOutput>(outputConfig(), std::move(options_.file));
}

HeadSession::~HeadSession() {
    tearingDown_ = finishing_ = true;
    provisional_.end();
    if (spareMove_.joinable()) spareMove_.join();
    if (redrawing_.joinable()) redrawing_.join();
    controlServer_.reset();
    server_.reset();
    if (output_) output_->drop();
    nodes_.loseAll("the head ends");
    returns_->stop([] {});
    if (remoteWalls_) remoteWalls_->end(); // its threads ask for programs
    if (programs_) programs_->endAll();
    nodes_.end();
    output_.reset();  // its thread calls the program table
    preview_.reset(); // its thread reads the plan
}

int HeadSession::run() {
    if (const auto up = bringUp(); !up) {
        control_.error(up.error().message);
        return 1;
    }
    serve();
    finish();
    SessionNumbers last = numbers();
    if (options_.lastPicture) last.lastPicture = options_.lastPicture();
    control_.send(reportOf(last));
    return 0;
}

// ---- while it runs

void HeadSession::serve() {
    while (!finishRequested(Deadline::inMs(returns_->awaited() ? kStartTickMs : kTickMs))) tick();
}

bool HeadSession::finishRequested(Deadline deadline) {
    const auto line = control_.receive(deadline);
    if (control_.broken() || (options_.interrupted && options_.interrupted())) return true;
    if (!line) return false;
    const Json command = parseJson(*line);
    const bool known = command.is_object() && command.value("command", Json()) == "finish";
    if (!known) log::warning(log::Topic::Session, "unknown command to the head: ", line->substr(0, 60));
    return known;
}

void HeadSession::watchNodes(int64_t nowNs) {
    nodes_.watch(nowNs, options_.silencePatienceMs * kNsPerMs, [this](int node, bool multicast) {
        bool isFirst = false; // a new node joins the group
        {
            const std::lock_guard lock(mutex_);
            const bool wasRerouted = rerouted_.erase(node) > 0;
            isFirst = multicast && !wasRerouted && totals_[static_cast<size_t>(node)].joins == 0;
            if (!multicast) rerouted_.insert(node);
        }
        log::line(log::Topic::Stream,
                  isFirst     ? log::Level::Debug
                  : multicast ? log::Level::Info
                              : log::Level::Warning,
                  nodes_.link(node).describe(),
                  multicast ? ": multicast works again"
                            : ": no reply to multicast; its stream uses TCP; see mural doctor --network");
    });
}

void HeadSession::tick() {
    const int64_t nowNs = monotonicNowNs();
    programs_->beat();
    watchNodes(nowNs);
    programs_->reap();
    beginPlanChange();
    watchStart(StartStep::FirstFrame);
    watchLaunches(nowNs);
    returns_->tick(nowNs);
    endLeftNodes(nowNs);
    reportProgress(nowNs);
    tickStatistics(nowNs);
    tickOverlay(nowNs);
    balancer()->tick(nowNs);
    redrawStillWindow();
}

// A display may not answer for a while, so another thread asks it.
void HeadSession::redrawStillWindow() {
    if (!wantedRedraw_ || isRedrawing_) return;
    const auto [client, window] = *std::exchange(wantedRedraw_, std::nullopt);
    const uint64_t native = frames_.nativeOf(client, window);
    if (native == 0 || !options_.requestRedraw) return;
    const auto target = nativeWindowOf(client, window, native);
    if (!target) return;
    if (redrawing_.joinable()) redrawing_.join();
    isRedrawing_ = true;
    redrawing_ = std::thread([this, target] {
        options_.requestRedraw(*target);
        isRedrawing_ = false;
    });
}

void HeadSession::reportProgress(int64_t nowNs) {
    const FrameTotals totals = frames_.totals();
    // a change of the plan may move the wall windows to the nodes and back
    const bool isOutputs = config_.display == Display::App || !config_.out.empty();
    const int64_t onWall = isOutputs ? output_->totals().wallFrames : totals.wallFrames;
    if (config_.frames > 0 && onWall >= config_.frames && !framesReached_) {
        framesReached_ = true;
        announce({{"event", "frames-reached"}});
    }
    if (totals.wallFrames == lastProgressFrame_ || nowNs - lastProgressNs_ < kProgressNs) return;
    lastProgressNs_ = nowNs;
    lastProgressFrame_ = totals.wallFrames;
    const auto rates = meter_.sample(nowNs, totals.wallFrames, nodes_.bytesSent());
    announce({{"event", "frame"},
              {"frame", totals.wallFrames},
              {"framesPerSecond", rates.framesPerSecond},
              {"bytesPerFrame", rates.bytesPerFrame}});
}

// ---- what the nodes say

Result<void> HeadSession::nodeReady(int node, const std::string& json) {
    auto facts = nodeFactsFromJson(json);
    if (!facts) return facts.error();
    if (returns_->isRestarting(node)) return takeAgain(node, std::move(*facts));
    const auto index = static_cast<size_t>(node);
    const std::lock_guard lock(mutex_);
    if (ready_[index]) return Error{"it sent two ready messages"};
    if (!facts->ownStream.empty()) {
        nodes_.link(node).setByMulticast(false);
        log::warning(log::Topic::Stream, nodes_.link(node).describe(),
                     ": its stream uses TCP instead of multicast: ", facts->ownStream);
    }
    log::debug(log::Topic::Node, "node ", node, " is ready: ", facts->renderer, ", pid ", facts->pid);
    facts_[index] = std::move(*facts);
    ready_[index] = true;
    return {};
}

Result<void> HeadSession::nodeAnswer(int node, const wire::ReplyPartHeader& header, ByteBuffer bytes) {
    plans_.of(node)->balancer.answered();
    return answers_.answer(node, header, std::move(bytes));
}

Result<void> HeadSession::nodeFrameDone(int node, const wire::FrameDoneMessage& message) {
    const auto stage = plans_.of(node);
    if (stage->takesPictures) {
        stage->pictures.frameDone(node, message.client, message.window, message.frame);
        output_->waitForRoom();
    }
    {
        const std::lock_guard lock(mutex_);
        NodeTotals& totals = totals_[static_cast<size_t>(node)];
        totals.replaySeconds += static_cast<double>(message.replayNs) / static_cast<double>(kNsPerS);
        totals.readbackSeconds += static_cast<double>(message.readbackNs) / static_cast<double>(kNsPerS);
        totals.cpuSeconds = totals.replaySeconds + totals.readbackSeconds; // the node's Bye replaces this value
    }
    frameTimes_.add(node, message);
    stage->balancer.frameDone(node, message, monotonicNowNs());
    advice_.frameDone(message.flags, stage->plan.nodes[static_cast<size_t>(node)].pass.ranges > 1);
    return recordFrame(node, message, frames_.frameDone(node, message, monotonicNowNs()));
}

Result<void> HeadSession::nodePicture(int node, const wire::PictureHeader& header, ByteBuffer rows) {
    const auto stage = plans_.of(node);
    if (!stage->takesPictures) return Error{"it sent a picture that was not requested"};
    auto placed = placeOnWall(stage->plan.nodes[static_cast<size_t>(node)], header, std::move(rows));
    auto done =
        placed ? stage->pictures.part(node, placed->header, std::move(placed->rows)) : Result<void>(placed.error());
    output_->waitForRoom();
    return done;
}

// Takes effect after the message of the last node, because that node still sends frames of the window. Only then may
// another window become the main one, and the program's state be dropped.
Result<void> HeadSession::nodeWindowGone(int node, const wire::WindowGoneMessage& message) {
    windowGone({message.client, message.window}, node);
    return {};
}

void HeadSession::windowGone(const std::pair<uint32_t, uint32_t>& window, int node) {
    {
        const std::lock_guard lock(mutex_);
        const auto [entry, fresh] = gone_.try_emplace(window);
        if (fresh) entry->second = views_.awaited(node);
        std::vector<bool>& awaited = entry->second;
        if (static_cast<size_t>(node) < awaited.size()) awaited[static_cast<size_t>(node)] = false; // or it came later
        if (std::ranges::find(awaited, true) != awaited.end()) return;
        gone_.erase(entry);
    }
    const auto [client, id] = window;
    plans_.windowGone(client, id);
    if (id != wire::kAllWindows) {
        frames_.windowGone(client, id);
        if (output_) output_->windowGone(client, id);
        return;
    }
    frames_.clientGone(client);
    pacer_.clientGone(client);
    plans_.clientGone(client);
    if (output_) output_->clientGone(client);
}

Result<void> HeadSession::nodeDriverEvent(int node, const wire::DriverEvent& event, const std::string& text) {
    if (serving_ && driverEvents_.isNew(node, event, text)) programs_->driverEvent(event, text);
    return {};
}

Result<void> HeadSession::nodeObjectRequest(int node, uint32_t client, ByteBuffer message) {
    Reply reply;
    reply.header.requestId = static_cast<uint32_t>(node);
    reply.header.kind = static_cast<uint32_t>(wire::ReplyKind::Object);
    reply.header.sizeBytes = message.size();
    reply.bytes = std::move(message);
    if (serving_) programs_->reply(client, std::move(reply));
    return {};
}

Result<void> HeadSession::nodeLog(int node, const std::string& text) {
    std::string line = text.substr(0, text.find('\n'));
    {
        const std::lock_guard lock(mutex_);
        if (!ready_[static_cast<size_t>(node)]) { // reason of a failed start, which is reported when the node has ended
            refusals_[static_cast<size_t>(node)] = line;
            return {};
        }
    }
    log::info(log::Topic::Node, "node ", node, ": ", line);
    return {};
}

Result<void> HeadSession::nodeGoodbye(int node, const std::string& json) {
    bool isLeaving = false;
    {
        const std::lock_guard lock(mutex_);
        isLeaving = leaving_.contains(node);
        if (!finishing_ && !isLeaving) return Error{"it ended without a request from the head"};
        readGoodbye(json, totals_[static_cast<size_t>(node)]);
    }
    if (isLeaving) memberLeft(node);
    return {};
}

void HeadSession::nodeLost(int node, const std::string& why) {
    if (tearingDown_) return;
    bool starting = false;
    {
        const std::lock_guard lock(mutex_);
        starting = !serving_;
        const std::string& refusal = refusals_[static_cast<size_t>(node)];
        if (starting && startFailure_.empty())
            startFailure_ = nodes_.link(node).describe() + " did not start: " + (refusal.empty() ? why : refusal);
    }
    if (!starting) loseMember(node, why);
}

// ---- end

void HeadSession::finish() {
    finishing_ = true;
    provisional_.end();
    if (spareMove_.joinable()) spareMove_.join();
    log::debug(log::Topic::Session, "the session ends: drains programs, nodes and outputs");
    returns_->stop([this] { watchNodes(monotonicNowNs()); });
    programs_->refuseFrom("the session is ending");
    programs_->drainAll(Deadline::inMs(options_.drainPatienceMs), [this] { watchNodes(monotonicNowNs()); });
    finishNodes();
    finishOutput();
    if (remoteWalls_) remoteWalls_->finish(Deadline::inMs(kRemotePatienceMs));
    controlServer_.reset();
    server_.reset();
    programs_->endAll();
    recording_.finish(Deadline::inMs(options_.recordPatienceMs));
    reportProgress(monotonicNowNs());
    const Deadline deadline = Deadline::inMs(kProcessPatienceMs);
    for (int node = 0; node < nodeCount(); ++node) {
        NodeConnection& link = nodes_.link(node);
        if (link.process() != nullptr && link.goodbyeReceived()) link.process()->waitEnded(deadline);
    }
    tearingDown_ = true;
    if (output_) output_->drop();
    nodes_.end();
    log::debug(log::Topic::Session, "the session has ended after ", frames_.totals().wallFrames, " frames");
}

void HeadSession::finishNodes() {
    constexpr int kSliceMs = 5;
    const int64_t beganNs = monotonicNowNs();
    const Deadline deadline = Deadline::inMs(options_.endPatienceMs);
    // Broadcasts on a separate thread, because a node that reads nothing would block this one, which watches the nodes.
    std::thread finishing([this] { nodes_.broadcast(wire::HeadCommand::Finish, {}); });
    while (!allReadersEnded()) {
        watchNodes(monotonicNowNs());
        loseSilentNodes(beganNs, deadline.passed());
        if (deadline.passed()) break; // a reader may hang in an output, which finishOutput() handles
        poll(nullptr, 0, kSliceMs);
    }
    finishing.join();
}

void HeadSession::finishOutput() {
    if (!output_) return;
    const Deadline deadline = Deadline::inMs(options_.outputPatienceMs);
    while (!output_->finish(Deadline::inMs(std::min(kOutputProgressMs, options_.outputPatienceMs)))) {
        if (deadline.passed()) {
            log::error(log::Topic::Output,
                       "the last pictures could not be written in time; the output may be incomplete");
            return;
        }
        log::info(log::Topic::Output, "still writing the last pictures");
    }
}

void HeadSession::loseSilentNodes(int64_t sinceNs, bool all) {
    const int64_t nowNs = monotonicNowNs();
    for (int node = 0; node < nodeCount(); ++node) {
        NodeConnection& link = nodes_.link(node);
        const int64_t silentNs = nowNs - std::max(sinceNs, link.lastProgressNs(nowNs));
        const bool silent = silentNs > options_.goodbyePatienceMs * kNsPerMs;
        if (!link.goodbyeReceived() && (silent || all)) link.lose("it did not end in time with the session");
    }
}

bool HeadSession::allReadersEnded() {
    for (int node = 0; node < nodeCount(); ++node)
        if (!nodes_.link(node).readerEnded()) return false;
    return true;
}

std::vector<int> HeadSession::waitsFor(const ProgramStatus& program) {
    switch (program.counts.waitingFor) {
    case capture::Wait::Frames: return frames_.behind(program.id);
    case capture::Wait::Reply: return answers_.missing(program.id);
    case capture::Wait::Space: return nodes_.full();
    default: return {};
    }
}

std::string HeadSession::streamOf(const NodePlan& plan) {
    if (plan.reach == NodeReach::SharedMemory) return "memory";
    return nodes_.link(plan.node).byMulticast() && !rerouted_.contains(plan.node) ? "multicast" : "TCP";
}

SessionStatus HeadSession::status() {
    SessionStatus result;
    result.session = config_.session;
    result.runPid = getppid();
    result.headPid = getpid();
    result.nowNs = monotonicNowNs();
    const auto stage = plans_.current();
    result.columns = stage->config.columns;
    result.rows = stage->config.rows;
    result.display = nameOf(config_.display);
    result.wallFrames = frames_.totals().wallFrames;
    result.latency = programs_->latency();
    if (const auto left = provisional_.left()) result.revertsInSeconds = std::chrono::duration<double>(*left).count();
    result.recording = recording_.status();
    result.delta = nodes_.deltaCounts();
    result.equalizers = stage->balancer.totals();
    result.programs = programs_->status();
    for (ProgramStatus& program : result.programs) {
        program.progress = frames_.progressOf(program.id);
        program.waitsForNodes = waitsFor(program);
    }
    std::map<int, NodeMulticast::Losses> losses;
    if (const NodeMulticast* const multicast = nodes_.multicast()) {
        losses = multicast->losses();
        result.multicast = multicast->report().sender;
    }
    const std::lock_guard lock(mutex_);
    for (size_t i = 0; i < facts_.size(); ++i) {
        if (hasLeft(static_cast<int>(i))) continue;
        NodeConnection& link = nodes_.link(static_cast<int>(i));
        NodeStatus node{totals_[i],
                        link.location().where,
                        facts_[i].pid,
                        facts_[i].renderer,
                        0,
                        streamOf(*plans_.nodePlan(static_cast<int>(i)))};
        node.totals.frames = frames_.framesOf(node.totals.node);
        node.totals.pictureBytes = link.pictureBytes(); // the node's Bye holds the other numbers
        node.totals.pictureRawBytes = link.pictureRawBytes();
        node.returning = returns_->isRestarting(node.totals.node);
        node.isStopped = stopped_.contains(node.totals.node);
        if (const auto lost = losses.find(node.totals.node); lost != losses.end()) node.losses = lost->second;
        node.silentSeconds = static_cast<double>(link.silentNs(result.nowNs)) / static_cast<double>(kNsPerS);
        result.nodes.push_back(std::move(node));
    }
    return result;
}

SessionNumbers HeadSession::numbers() {
    SessionNumbers result;
    result.frames = frames_.totals();
    result.bytesSent = nodes_.bytesSent();
    result.delta = nodes_.deltaCounts();
    result.equalizers = balancer()->totals();
    result.programs = programs_->counts();
    if (output_) result.output = output_->totals();
    result.drawnWhole = advice_.drawnWhole();
    result.limits = advice_.limits();
    result.sharedDraws = advice_.sharedDraws();
    result.recording = recording_.latest();
    const std::lock_guard lock(mutex_);
    result.nodes = totals_;
    for (NodeTotals& totals : result.nodes) {
        totals.frames = frames_.framesOf(totals.node);
        totals.hasConnected = facts_[static_cast<size_t>(totals.node)].pid != 0;
        // An operator stopped it in order, or its change of the plan was refused.
        totals.lost = totals.lost && !stopped_.contains(totals.node) && !refusedNodes_.contains(totals.node);
    }
    return result;
}

} // namespace mural
