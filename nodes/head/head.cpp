#include "nodes/head/head.hpp"

#include <algorithm>
#include <cctype>
#include <csignal>
#include <fcntl.h>
#include <unistd.h>

#include "common/log/log.hpp"
#include "common/memory/malloc_tuning.hpp"
#include "common/ipc/window_mark.hpp"
#include "common/base/pause_watch.hpp"
#include "nodes/head/planning/make_plan.hpp"
#include "nodes/head/session/head_session.hpp"
#include "nodes/head/session/log_to_control.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/environment.hpp"
#include "nodes/launch/launchers/create_launcher.hpp"
#include "nodes/launch/launchers/job_clock.hpp"
#include "nodes/output/windows/app_window.hpp"
#include "nodes/output/windows/redraw_request.hpp"
#include "nodes/output/outputs.hpp"
#include "nodes/output/files/png_files.hpp"
#include "nodes/session/stream_build.hpp"
#include "nodes/output/windows/wall_sink.hpp"
#include "streamcodec/registry_digest.hpp"

namespace mural {
namespace {

constexpr int64_t kConfigPatienceMs = 10'000;
constexpr int64_t kRedrawMs = 1'000; // the request of a redraw; the end of the session may wait for it

volatile std::sig_atomic_t endRequested = 0;
void requestEnd(int) { endRequested = 1; }

// Ctrl-C of the terminal reaches the head and `mural run`. The head ignores it, because `mural run` decides about the
// end.
void setUpSignals() {
    launch::rememberSignals();
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN); // a file size limit then is an error of the call
    signal(SIGINT, SIG_IGN);
    struct sigaction finish {};
    finish.sa_handler = requestEnd; // no SA_RESTART: signals end waits
    sigaction(SIGTERM, &finish, nullptr);
    sigaction(SIGHUP, &finish, nullptr);
}

Result<SessionConfig> receiveConfig(ControlChannel& control) {
    const Deadline deadline = Deadline::inMs(kConfigPatienceMs);
    do {
        if (const auto line = control.receive(deadline)) return sessionConfigFromJson(*line);
    } while (!control.broken() && !deadline.passed() && endRequested == 0);
    return Error{"no session configuration on the control connection; start `mural head` with `mural run`"};
}

Result<LaunchOptions> launchOptionsOf(const SessionConfig& config) {
    LaunchOptions options;
    options.isNative = !config.nodeProgram.empty();
    options.executable = options.isNative ? config.nodeProgram : launch::ownBinary();
    options.minNodes = config.minNodes;
    options.patienceMs = config.startTimeoutMs;
    LaunchSettings settings;
    settings.how = config.launchCommand;
    settings.secretFile = config.launchSecret;
    settings.ownMural = launch::ownBinary();
    settings.binary.program = config.remoteMural.empty() ? options.executable : config.remoteMural;
    settings.binary.mural = options.isNative ? settings.ownMural : settings.binary.program;
    settings.binary.isNative = options.isNative;
    settings.version = {MURAL_VERSION, streamBuild()};
    settings.startTimeoutMs = config.startTimeoutMs;
    auto launcher = createLauncher(settings, launch::Environment::current());
    if (!launcher) return launcher.error();
    options.launcher = std::move(*launcher);
    return options;
}

// Returns the output path of a further canvas: a folder inside --out, or a video next to the video of --out.
std::string outOfCanvas(const std::string& out, const std::string& name) {
    std::string plain;
    for (const char c : name)
        plain += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.' ? c : '_';
    const auto kind = outputKindOf(out);
    const size_t dot = out.rfind('.');
    if (kind && kind.value() == OutputKind::Video) return out.substr(0, dot) + "." + plain + out.substr(dot);
    return out + (out.back() == '/' ? "" : "/") + "canvas." + plain;
}

Result<void> addOutputs(const SessionConfig& config, const SessionPlan& plan, HeadOptions& options) {
    options.openWindow = [display = config.displayName,
                          key = window_mark::sessionKey(config.session.c_str())](const NativeWindow& window) {
        AppWindowConfig target;
        target.displayName = window.display.empty() ? display : window.display;
        target.window = window.id;
        target.owner = WindowOwner{key, window.client, window.window};
        auto opened = AppWindow::open(target);
        if (!opened) return Result<std::unique_ptr<PictureSink>>(opened.error());
        return Result<std::unique_ptr<PictureSink>>(std::move(*opened));
    };
    options.requestRedraw = [display = config.displayName](const NativeWindow& window) {
        const auto done =
            requestRedraw(window.display.empty() ? display : window.display, window.id, Deadline::inMs(kRedrawMs));
        if (!done) log::debug(log::Topic::Output, "no redraw of a coarse picture: ", done.error().message);
    };
    options.openWall = [config, overlay = options.overlay](const WallPlace& place) {
        WallWindowsConfig wall;
        wall.displayName = config.displayName;
        wall.positionX = config.windowX + place.offsetX;
        wall.positionY = config.windowY;
        wall.fullScreen = config.fullScreen;
        wall.overlay = overlay;
        wall.onInput = place.onInput;
        wall.wall.wallWidthMm = place.size.width;
        wall.wall.wallHeightMm = place.size.height;
        return Result<std::unique_ptr<PictureSink>>(
            std::make_unique<WallSink>(std::move(wall), TileGrid{config.columns, config.rows, 1}));
    };
    if (config.out.empty()) return {};
    auto file = openOutput(config.out);
    if (!file) return file.error();
    // The sink lives as long as the session, which calls lastPicture.
    const auto* pngs = dynamic_cast<const PngFiles*>(file->get());
    options.lastPicture = [pngs, out = config.out] { return pngs ? pngs->lastPath() : out; };
    options.file = std::move(*file);
    for (const CanvasPlan& canvas : plan.canvases) {
        auto opened = openOutput(outOfCanvas(config.out, canvas.name));
        if (!opened) return opened.error();
        options.canvasFiles.push_back(std::move(*opened));
    }
    return {};
}

// Starts the process that forks the nodes of this machine. Null: a single node starts as fast alone, or the nodes do
// not use the driver that it loads.
std::shared_ptr<NodeForker> startForker(const SessionConfig& config, const SessionPlan& plan,
                                        const LaunchOptions& options) {
    const auto nodes = std::ranges::count(plan.nodes, NodeReach::SharedMemory, &NodePlan::reach);
    if (nodes < 2 || options.isNative || config.glBackend == "osmesa") return nullptr;
    auto forker = NodeForker::start(options.executable);
    if (forker) return *forker;
    log::debug(log::Topic::Launch, "nodes start as new processes: ", forker.error().message);
    return nullptr;
}

// Watches the time limit of the Slurm job of this process. Empty: it is in none.
std::function<std::optional<JobDeadline::Notice>(int64_t nowNs)> jobWatch() {
    const std::string job = launch::Environment::current().get("SLURM_JOB_ID").value_or("");
    if (job.empty()) return {};
    const auto clock = std::make_shared<launch::JobClock>(launch::endTimeCommand(job));
    const auto deadline = std::make_shared<JobDeadline>(job);
    return [clock, deadline](int64_t nowNs) { return deadline->check(clock->endNs(), nowNs); };
}

Result<int> runSession(ControlChannel& control) {
    auto config = receiveConfig(control);
    if (!config) return config.error();
    char host[256] = "localhost";
    gethostname(host, sizeof(host) - 1);
    auto planned = makePlan(*config, host);
    if (!planned) return planned.error();
    SessionPlan plan = std::move(*planned);
    HeadOptions options;
    options.registryDigest = registryDigest();
    options.interrupted = [] { return endRequested != 0; };
    options.overlay = std::make_shared<Overlay>(host, "head");
    if (const auto outputs = addOutputs(*config, plan, options); !outputs) return outputs.error();
    if (!config->record.empty()) {
        trace::RecorderConfig recorder;
        recorder.lastFrame = config->frames;
        auto made = trace::StreamRecorder::create(config->record, recorder);
        if (!made) return made.error();
        options.recorder = std::move(*made);
    }
    auto launching = launchOptionsOf(*config);
    if (!launching) return launching.error();
    launching->forker = startForker(*config, plan, *launching);
    options.watchJob = jobWatch();
    options.progress = std::make_shared<StartProgress>(monotonicNowNs());
    auto nodes =
        launchNodes(plan, *launching, *options.progress, [&] { return endRequested != 0 || control.broken(); });
    if (!nodes) return nodes.error();
    for (const LaunchedNode& node : *nodes) // swap barriers do not include an absent node
        if (!node.connection) plan.nodes[static_cast<size_t>(node.plan.node)].swapBarrier.clear();
    options.readyPatienceMs = config->startTimeoutMs;
    options.startNode = [launching = *launching](const NodePlan& node) { return startNode(node, launching); };
    options.whyLaunchesEnd = [launcher = launching->launcher] { return launcher->whyOver(); };
    HeadSession session(*config, std::move(plan), std::move(*nodes), control, std::move(options));
    return session.run();
}

} // namespace

int runHead(int controlFd) {
    fcntl(controlFd, F_SETFD, FD_CLOEXEC); // nodes must not inherit it
    keepFreedMemory();
    setUpSignals();
    const PauseWatch pauseWatch;
    ControlChannel control{FileDescriptor(controlFd)};
    const LogToControl lines(control);
    const Result<int> status = runSession(control);
    if (status) return status.value();
    control.error(status.error().message);
    return 1;
}

} // namespace mural
