// The start of a session: opens everything in order, until programs may connect.
#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/json/json_text.hpp"
#include "common/log/log.hpp"
#include "common/log/process_log.hpp"
#include "nodes/head/planning/delta_plan.hpp"
#include "nodes/head/remote/remote_walls.hpp"
#include "nodes/head/session/head_session.hpp"
#include "nodes/affinity/placement.hpp"
#include "nodes/session/session_secret.hpp"
#include "streamcodec/wire/head_messages.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

const char* explainTiling(Tiling tiling) {
    switch (tiling) {
    case Tiling::Culled:
        return "tiling culled: like exact, but shaders also discard geometry outside of a node's tiles; exact where "
               "windows and framebuffer objects have depth buffers";
    case Tiling::Lean:
        return "tiling lean: framebuffers of the tiles' size; up to 0.25 % of the pixels may differ, mostly by 1";
    case Tiling::Exact: break;
    }
    return "tiling exact: every node has a framebuffer of the whole picture and draws only its tiles; all pixels equal "
           "those of a single machine";
}

const char* explainCulling(CullingMode culling) {
    switch (culling) {
    case CullingMode::Auto: return "culling auto: nodes leave out vertices that cannot touch their tiles";
    case CullingMode::Audit:
        return "culling audit: nodes count the samples of all vertices that they leave out; one in a node's tiles is "
               "a fault";
    case CullingMode::Off: break;
    }
    return "culling off: every node processes all vertices";
}

bool hasOtherLayouts(const SessionPlan& plan) {
    return plan.balance && std::ranges::any_of(plan.balance->config.canvases,
                                               [](const auto& canvas) { return canvas.layouts.size() > 1; });
}

const char* whyOwnStreams(const std::string& stream) {
    return stream == "tcp" ? "--stream tcp" : "fewer than two other machines";
}

} // namespace

Result<void> HeadSession::bringUp() {
    log::debug(log::Topic::Session, "session ", config_.session, " begins with ", nodeCount(), " nodes, wall ",
               config_.columns, "x", config_.rows, ", display ", nameOf(config_.display));
    placement_ = placeOwnThreads(); // before its threads start, because they inherit the placement
    const auto plan = currentPlan();
    for (const NodePlan& node : plan->nodes) nodes_.link(node.node).unpackBy(node.pictureCodec, node.transferScale);
    nodes_.startReading();
    openMulticast();
    if (auto opened = openDeltaStream(); !opened) return opened;
    if (std::ranges::any_of(plan->nodes, [&](const NodePlan& n) {
            return n.pass.ranges > 1 || !swapMembersOf(config_, *plan, n).empty();
        })) {
        const auto secret = makeSessionSecret();
        if (!secret) return secret.error();
        exchangeSecret_ = toHex(secret.value());
    }
    for (const NodePlan& node : plan->nodes)
        if (nodes_.link(node.node).alive())
            nodes_.sendAlone(node.node, wire::HeadCommand::Setup, toJson(setupFor(node)));
    if (auto ready = awaitReady(); !ready) return ready;
    introduceNodes();
    measureClocks();
    openTables();
    goOnWithoutAbsent();
    openPreview();
    openWallInput();
    if (auto opened = openRemoteWalls(); !opened) return opened;
    auto server = CaptureServer::start({config_.session, config_.socketPath}, options_.registryDigest, *programs_);
    if (!server) return server.error();
    server_ = std::move(*server);
    openControl();
    announceReady();
    log::debug(log::Topic::Session, "programs may connect");
    return {};
}

PictureOutputConfig HeadSession::outputConfig() {
    const auto plan = currentPlan();
    PictureOutputConfig output;
    output.saveFrames = config_.saveFrames;
    output.lastFrame = config_.frames;
    output.toNativeWindows = config_.display == Display::App;
    output.pairs = plan->wall.stereo == StereoMode::Quad;
    output.statistics = &statistics_;
    output.overlay = overlay_;
    if (config_.overlayInFiles) {
        output.overlayInFiles.emplace();
        output.overlayInFiles->wallWidthMm = plan->size.width;
        output.overlayInFiles->wallHeightMm = plan->size.height;
    }
    output.beginOverlay = [this](uint32_t client) { return programs_->beginOverlay(client); };
    output.endOverlay = [this](uint32_t client) { programs_->endOverlay(client); };
    output.openWindow = [this](const WindowPicture& picture) { return openNativeWindow(picture); };
    if (config_.display == Display::Windows)
        output.openWall = [this] { return options_.openWall(wallPlace(0, currentPlan()->size)); };
    for (size_t i = 0; i < plan->canvases.size(); ++i) {
        const CanvasPlan& other = plan->canvases[i];
        OtherCanvas& canvas = output.canvases.emplace_back();
        canvas.name = other.name;
        canvas.pairs = other.wall.stereo == StereoMode::Quad;
        if (i < options_.canvasFiles.size()) canvas.file = options_.canvasFiles[i];
        if (headShowsCanvas(config_, other))
            canvas.openWall = [this, place = wallPlace(other.offsetX, other.size)] { return options_.openWall(place); };
    }
    output.offerToPages = [this](int64_t frame, const std::shared_ptr<const OwnedPicture>& picture) {
        if (preview_) preview_->offer(frame, picture);
        if (remoteWalls_) remoteWalls_->offer(frame, picture);
    };
    output.done = [this](uint32_t client, uint32_t frame) { frames_.pictureReleased(client, frame); };
    output.displayBlocked = [this](uint32_t client, bool isBlocked) { programs_->displayBlocked(client, isBlocked); };
    output.giveToProgram = [this](const WindowPicture& picture, const Picture& whole) {
        const auto done = [this, client = picture.client, frame = picture.frame] {
            frames_.pictureReleased(client, frame);
        };
        return programs_->giveOwnPicture(picture.client, picture.frame, picture.nativeWindow, whole, done);
    };
    return output;
}

NodeSetup HeadSession::setupFor(const NodePlan& plan) {
    const auto stage = plans_.of(plan.node);
    NodeSetup setup = setupOf(stage->config, stage->plan, plan);
    setup.exchangeSecret = exchangeSecret_;
    if (nodes_.link(plan.node).byMulticast() || nodes_.link(plan.node).joinsGroup()) {
        setup.stream = nodes_.multicast()->invitation();
        setup.streamSecret = toHex(nodes_.multicast()->secret());
    }
    if (isNative() && setup.glBackend == "auto") setup.glBackend = "egl"; // linked GL libraries have no OSMesa contexts
    setup.delta = nodes_.link(plan.node).inBatches();
    setup.cacheBytes = config_.cacheBytes;
    setup.log = log::environmentLevels();
    setup.recordsSpans = statistics_.isOn();
    const std::lock_guard lock(announceMutex_);
    setup.overlay = overlayOf(plan.node);
    return setup;
}

// Opens one stream for all nodes of other machines. Without it each node has its own connection.
void HeadSession::openMulticast() {
    std::vector<int> nodes = nodesForMulticast(config_.stream, *currentPlan());
    multicastNodes_.insert(nodes.begin(), nodes.end());
    std::erase_if(nodes, [this](int node) { return absences_.contains(node); });
    if (nodes.empty()) {
        multicastNodes_.clear(); // no group is created
        streamLine_ = config_.hosts.empty() ? ""
                                            : std::string("the stream is sent to each node over its own connection: ") +
                                                  whyOwnStreams(config_.stream);
        return;
    }
    NetworkPath path = nodes_.link(nodes.front()).path();
    for (const int node : nodes)
        path.datagramBytes = std::min(path.datagramBytes, nodes_.link(node).path().datagramBytes);
    auto multicast = NodeMulticast::open(config_.stream, path);
    if (!multicast) {
        multicastNodes_.clear();
        streamLine_ =
            "the stream is sent to each node over its own connection: no multicast: " + multicast.error().message +
            "; see mural doctor --network";
        if (!config_.explain) log::warning(log::Topic::Stream, streamLine_);
        return;
    }
    streamLine_ = "the stream is sent to " + std::to_string(nodes.size()) +
                  " nodes at once, with reliable multicast: " + (*multicast)->describe();
    log::debug(log::Topic::Stream, streamLine_);
    nodes_.multicastBy(std::move(*multicast));
    for (const int node : nodes) nodes_.link(node).setByMulticast(true);
}

Result<void> HeadSession::openDeltaStream() {
    const DeltaPlan plan =
        planDelta(config_, *currentPlan(), [this](int node) { return nodes_.link(node).byMulticast(); });
    deltaLine_ = plan.explain;
    log::debug(log::Topic::Stream, deltaLine_);
    if (plan.nodes.empty()) return {};
    delta::Limits limits;
    limits.cacheBytes = static_cast<uint64_t>(config_.cacheBytes);
    auto deltaStream = DeltaStream::open(limits);
    if (!deltaStream) return deltaStream.error();
    if (const char* const plant = std::getenv("MURAL_PLANT"); plant != nullptr && std::string_view(plant) == "held")
        (*deltaStream)->losesDeferredUploads();
    nodes_.setDeltaStream(std::move(*deltaStream));
    for (const int node : plan.nodes) nodes_.link(node).setInBatches(!absences_.contains(node));
    deltaNodes_.insert(plan.nodes.begin(), plan.nodes.end());
    return {};
}

// Sends addresses to the nodes. Nodes that draw ranges of one picture receive the addresses for its parts. Nodes of a
// swap barrier receive the address of its leader.
void HeadSession::introduceNodes() {
    Json pictures = Json::object(), swaps = Json::object();
    {
        const std::lock_guard lock(mutex_);
        for (size_t i = 0; i < facts_.size(); ++i) {
            if (!facts_[i].exchange.empty()) pictures[std::to_string(i)] = facts_[i].exchange;
            if (!facts_[i].swapBarrier.empty()) swaps[std::to_string(i)] = facts_[i].swapBarrier;
        }
    }
    if (pictures.empty() && swaps.empty()) return;
    const std::string text = jsonText(Json{{"pictures", pictures}, {"swaps", swaps}});
    nodes_.broadcast(wire::HeadCommand::Exchange, std::as_bytes(std::span(text.data(), text.size())));
    nodes_.flush();
}

Result<void> HeadSession::awaitReady() {
    const Deadline deadline = Deadline::inMs(options_.readyPatienceMs);
    while (true) {
        {
            const std::lock_guard lock(mutex_);
            if (!startFailure_.empty()) return Error{startFailure_};
            const auto missing = std::ranges::find(ready_, false);
            if (missing == ready_.end()) return checkSize();
            if (deadline.passed()) {
                const auto node = static_cast<int>(missing - ready_.begin());
                return Error{nodes_.link(node).describe() + " was not ready within " +
                             std::to_string(options_.readyPatienceMs / 1000) + " s; try --gl osmesa, or fewer nodes"};
            }
        }
        if (finishRequested(Deadline::inMs(10))) return Error{"the session was stopped before its nodes were ready"};
        watchStart(StartStep::GlReady);
    }
}

// Shows which nodes are late with a step of the start.
void HeadSession::watchStart(StartStep wanted) {
    if (!options_.progress) return;
    const int64_t nowNs = monotonicNowNs();
    for (int node = 0; node < nodeCount(); ++node) {
        if (nodes_.link(node).isHeard()) options_.progress->reached(node, StartStep::Checked, nowNs);
        const std::lock_guard lock(mutex_);
        const auto index = static_cast<size_t>(node);
        if (ready_[index] && !absences_.contains(node)) options_.progress->reached(node, StartStep::GlReady, nowNs);
        if (totals_[index].cpuSeconds > 0) options_.progress->reached(node, StartStep::FirstFrame, nowNs);
    }
    const auto why = [this](int node) {
        const NodeConnection& link = nodes_.link(node);
        return link.alive() ? std::string() : std::string("it was lost");
    };
    for (const std::string& line : options_.progress->news(wanted, nowNs, why)) log::info(log::Topic::Node, line);
}

// Ends the session if its batch job is over, or about to be.
void HeadSession::watchLaunches(int64_t nowNs) {
    constexpr int64_t kEveryNs = kNsPerS;
    if (nowNs - launchesWatchedNs_ < kEveryNs) return;
    launchesWatchedNs_ = nowNs;
    if (const auto notice = options_.watchJob ? options_.watchJob(nowNs) : std::nullopt) {
        log::warning(log::Topic::Session, notice->line);
        if (notice->isOver) announce({{"event", "job-over"}});
    }
    const std::string why = options_.whyLaunchesEnd ? options_.whyLaunchesEnd() : std::string();
    if (why.empty()) return;
    options_.whyLaunchesEnd = {};
    log::error(log::Topic::Session, why, "; the session ends");
    announce({{"event", "job-over"}});
}

// Checks the wall's size only: larger windows of programs are detected when they appear. Requires mutex_.
Result<void> HeadSession::checkSize() {
    const int64_t side = std::max(config_.width, config_.height);
    for (size_t i = 0; config_.tiling != Tiling::Lean && i < facts_.size(); ++i) {
        const int64_t maximum = facts_[i].maxPixels;
        if (maximum == 0 || side <= maximum) continue;
        return Error{nodes_.link(static_cast<int>(i)).describe() + " draws pictures with at most " +
                     std::to_string(maximum) + " pixels per side, but the wall has " + std::to_string(config_.width) +
                     "x" + std::to_string(config_.height) + "; choose a smaller --size"};
    }
    return {};
}

// The size that a program with the native API draws. 0 x 0: unknown.
compound::PixelSize HeadSession::sizeOfWall() const {
    if (config_.width > 0) return {config_.width, config_.height};
    const auto balance = currentPlan()->balance;
    return balance ? balance->wall : compound::PixelSize{0, 0};
}

void HeadSession::openTables() {
    ProgramTerms terms;
    capture::Welcome& welcome = terms.welcome;
    welcome.localRendering =
        config_.localRendering == LocalRendering::On ? capture::kLocalRenderingOn : capture::kLocalRenderingOff;
    welcome.verifyEvery = static_cast<uint32_t>(config_.verifyEvery);
    // A recording must play on any number of nodes. The program therefore fetches the pixels that it copies from a
    // window, as it does with several nodes. So do programs of a session that may get more nodes.
    const bool mayGrow = options_.recorder || hasOtherLayouts(*currentPlan());
    welcome.nodeCount = static_cast<uint32_t>(mayGrow ? std::max(nodeCount(), 2) : nodeCount());
    fetchesCopies_ = welcome.nodeCount > 1;
    welcome.displayApp = config_.display == Display::App ? 1 : 0;
    const compound::PixelSize wall = sizeOfWall();
    welcome.width = static_cast<uint32_t>(wall.w);
    welcome.height = static_cast<uint32_t>(wall.h);
    welcome.multicasts = nodes_.multicast() != nullptr ? 1 : 0;
    welcome.isOneMachine = isOneMachine() ? 1 : 0;
    if (isNative()) terms.kind = capture::ProgramKind::Native;
    {
        const std::lock_guard lock(mutex_);
        std::vector<NodeCapabilities> facts;
        for (size_t i = 0; i < facts_.size(); ++i)
            if (!absences_.contains(static_cast<int>(i))) facts.push_back(facts_[i]);
        welcome.nodeGlVersion = static_cast<uint32_t>(lowestGlVersion(facts));
        terms.extensions = commonExtensions(facts);
        promisedGlVersion_ = lowestGlVersion(facts);
        promisedExtensions_ = terms.extensions;
    }
    terms.latency = static_cast<uint32_t>(config_.latency);
    terms.chunkCount = options_.chunkCount;
    terms.statistics = &statistics_;
    sentFrames_.areWanted = balancer()->movesZooms();
    sentFrames_.add = [this](const SentFrame& frame) { balancer()->frameSent(frame); };
    terms.sentFrames = &sentFrames_;
    if (!config_.frameTimes.empty())
        if (const auto opened = frameTimes_.open(config_.frameTimes); !opened)
            log::warning(log::Topic::Session, opened.error().message); // mural run has checked the place
    if (options_.recorder) recording_.beginAtStart(std::move(options_.recorder), aboutTrace());
    ProgramTable::Events events;
    events.came = [this](const CaptureClient& client) {
        recording_.programCame({trace::Event::ClientCame, client.id(), client.pid(), client.name()});
    };
    events.countChanged = [this](size_t count) { announce({{"event", "clients"}, {"count", count}}); };
    events.gone = [this](uint32_t client) {
        driverEvents_.programGone(client);
        recording_.programGone(client);
    };
    programs_ = std::make_unique<ProgramTable>(std::move(terms), nodes_, std::move(events));
    for (int node = 0; node < nodeCount(); ++node)
        if (!absences_.contains(node)) programs_->memberCame(node, nodes_.link(node).describe());
    serving_ = true;
}

bool HeadSession::isOneMachine() const {
    const auto plan = currentPlan();
    return std::ranges::all_of(plan->nodes, [](const NodePlan& node) { return node.reach == NodeReach::SharedMemory; });
}

trace::About HeadSession::aboutTrace() {
    trace::About about;
    about.version = MURAL_VERSION;
    const auto plan = currentPlan(); // facts_ also has nodes that earlier plans used
    const std::lock_guard lock(mutex_);
    for (const NodePlan& node : plan->nodes) {
        if (node.isVacant) continue;
        const NodeCapabilities& facts = facts_[static_cast<size_t>(node.node)];
        about.nodes.push_back(facts.renderer + ", GL " + std::to_string(facts.glVersion / 10) + "." +
                              std::to_string(facts.glVersion % 10));
    }
    return about;
}

// Places the thread near the network card if any node is on another machine.
std::string HeadSession::placeOwnThreads() const {
    if (!config_.placeThreads) return "not placed: --no-placement";
    if (config_.hosts.empty()) return "not placed: all nodes are on this machine";
    Placement placement = placeThread(DeviceKind::Network);
    log::debug(log::Topic::Affinity, "threads of the head: ", placement.description);
    return std::move(placement.description);
}

std::vector<std::string> HeadSession::explainLines() {
    const auto plan = currentPlan();
    std::vector<std::string> lines = plan->explain;
    for (const NodePlan& node : plan->nodes)
        if (const auto members = swapMembersOf(config_, *plan, node);
            !members.empty() && members.front()->node == node.node)
            lines.push_back("windows of " + std::to_string(members.size()) +
                            " nodes show each frame together: swap barrier \"" + node.swapBarrier +
                            "\", leader: node " + std::to_string(node.node));
    lines.push_back(explainTiling(config_.tiling));
    lines.push_back(explainCulling(config_.culling));
    if (!streamLine_.empty()) lines.push_back(streamLine_);
    lines.push_back(deltaLine_);
    if (remoteWalls_)
        for (std::string& line : remoteWalls_->explain()) lines.push_back(std::move(line));
    lines.push_back("threads of the head: " + placement_);
    const std::lock_guard lock(mutex_);
    for (const NodePlan& node : plan->nodes) {
        const std::string& placement = facts_[static_cast<size_t>(node.node)].placement;
        if (!placement.empty()) lines.push_back("thread of node " + std::to_string(node.node) + ": " + placement);
    }
    return lines;
}

void HeadSession::announceReady() {
    const auto stage = plans_.current();
    Json nodes = Json::array();
    {
        const std::lock_guard lock(mutex_);
        for (const NodePlan& plan : stage->plan.nodes) {
            if (absences_.contains(plan.node)) continue;
            const NodeCapabilities& facts = facts_[static_cast<size_t>(plan.node)];
            nodes.push_back({{"node", plan.node}, {"where", plan.where}, {"pid", facts.pid}, {"gl", facts.renderer}});
        }
    }
    for (const std::string& warning : stage->plan.warnings) log::warning(log::Topic::Session, warning);
    if (stage->plan.wall.stereo == StereoMode::Quad && stage->takesPictures && !stage->ownsWallWindows)
        log::warning(log::Topic::Session,
                     "both eyes are shown side by side, because only wall windows have a buffer for each eye; add "
                     "--display windows");
    control_.send({{"event", "ready"}, {"explain", explainLines()}, {"nodes", nodes}});
}

std::optional<NativeWindow> HeadSession::nativeWindowOf(uint32_t client, uint32_t window, uint64_t native) {
    const auto number = static_cast<uint32_t>(native >> 32);
    if (number == capture::kNoDisplay) return std::nullopt;
    NativeWindow found{client, window, static_cast<uint32_t>(native), {}};
    if (serving_) found.display = programs_->displayName(client, number);
    return found;
}

Result<std::unique_ptr<PictureSink>> HeadSession::openNativeWindow(const WindowPicture& picture) {
    const auto window = nativeWindowOf(picture.client, picture.window, picture.nativeWindow);
    if (!window)
        return Error{fmt::format("a program has windows on more than {} X displays, or on one with a name longer than "
                                 "{} bytes; its window there shows nothing",
                                 capture::kDisplays, capture::kDisplayNameBytes - 1)};
    return options_.openWindow(*window);
}

} // namespace mural
