#include "tools/mural/app_report/runs/app_runs.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "common/json/json_text.hpp"
#include "nodes/launch/bypass_watch.hpp"
#include "nodes/launch/process_tree.hpp"
#include "nodes/launch/program_check.hpp"
#include "tools/mural/app_report/runs/window_picture.hpp"
#include "tools/mural/child_runs/interruption.hpp"

namespace mural::cli {

namespace {

constexpr int64_t kStartMs = 10'000;    // of a session, until the program starts
constexpr int64_t kGraceMs = 4'500;     // mural run ends a program that ignores SIGTERM within 3 s
constexpr int64_t kOverheadMs = 14'000; // of all runs together; the rest of the 20 s is for their last one
constexpr int64_t kLeastMs = 1'500;     // a shorter run shows nothing
constexpr double kPictureShare = 0.6;   // part of the native run after which its window is read
constexpr double kExaminedShare = 0.6;  // part of a run after which its libraries are examined
// The report shows the last of these frames that the wall reaches.
constexpr const char* kSavedFrames = "1,5,20,60,150,300";

nlohmann::json jsonOfFile(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    auto json = text.empty() ? nlohmann::json() : parseJson(text);
    return json.is_object() ? json : nlohmann::json();
}

} // namespace

double AppRun::number(const char* field) const {
    const auto found = report.is_object() ? report.find(field) : report.end();
    return report.is_object() && found != report.end() && found->is_number() ? found->get<double>() : 0.0;
}

Result<std::unique_ptr<AppRuns>> AppRuns::open(AppRunsPlan plan) {
    auto scratch = ScratchFolder::make();
    if (!scratch) return scratch.error();
    launch::adoptOrphans(); // for runBounded()
    auto display = launch::PrivateDisplay::start(launch::kDefaultScreenWidth, launch::kDefaultScreenHeight);
    if (!display) return display.error();
    return std::unique_ptr<AppRuns>(new AppRuns(std::move(plan), std::move(*scratch), std::move(*display)));
}

AppRun AppRuns::perform(const std::string& name, std::vector<std::string> options,
                        const std::function<void(pid_t, double)>& watch) {
    AppRun run;
    run.name = name;
    run.options = options;
    const int64_t leftMs = allRuns_.leftNs() / kNsPerMs;
    const auto limitMs = std::min(static_cast<int64_t>(plan_.seconds * 1000), leftMs);
    if (Interruption::signal() != 0) run.skipped = "the report was interrupted";
    if (limitMs < std::min<int64_t>(kLeastMs, static_cast<int64_t>(plan_.seconds * 1000)))
        run.skipped = "earlier runs have used the time; a larger --seconds gives more";
    if (!run.performed()) return run;

    const std::string reportFile = scratch_.path() + "/" + name + ".json";
    BoundedCommand command;
    command.words = {launch::ownBinary(), "run", "--quiet", "--report", reportFile};
    if (!plan_.size.empty()) options.insert(options.end(), {"--size", plan_.size});
    command.words.insert(command.words.end(), options.begin(), options.end());
    command.words.emplace_back("--");
    command.words.insert(command.words.end(), plan_.program.begin(), plan_.program.end());
    command.environment = launch::Environment::current();
    launch::removeCapture(command.environment);
    display_->use(command.environment);
    command.startMs = std::min(kStartMs, leftMs);
    command.limitMs = limitMs;
    command.totalMs = leftMs;
    command.graceMs = kGraceMs;
    command.display = display_->pid();
    command.hasBegun = [](pid_t pid) { return !ProgramWatch::processesOf(pid).empty(); };
    command.watch = watch;
    auto outcome = runBounded(command);
    if (!outcome) {
        run.skipped = outcome.error().message;
        return run;
    }
    run.outcome = std::move(*outcome);
    run.report = jsonOfFile(reportFile);
    return run;
}

void AppRuns::measureNative(AppMeasured& m) {
    ProgramWatch watch;
    const std::string picture = scratch_.path() + "/native.png";
    bool pictureTaken = !plan_.pictures || !plan_.size.empty(); // --size has a display of its own
    m.native = perform("native", {"--native"}, [&](pid_t run, double seconds) {
        watch.look(run);
        if (pictureTaken || seconds < plan_.seconds * kPictureShare) return;
        pictureTaken = true;
        if (saveLargestWindow(*display_, picture)) m.nativePicture = picture;
    });
    m.seen = watch.seen();
}

void AppRuns::measureTiles(AppMeasured& m) {
    const std::string trace = scratch_.path() + "/app.mural", pictures = scratch_.path() + "/wall";
    std::vector<std::string> options{"--tiles",   "2x2",       "--verify", "--delta",  "on",
                                     "--explain", "--display", "none",     "--record", trace};
    if (plan_.pictures) options.insert(options.end(), {"--out", pictures, "--save", kSavedFrames});
    // A program that still runs at its end is examined before.
    const auto bypass = launch::BypassWatch::create();
    m.tiles = perform("tiles", options, [&](pid_t run, double seconds) {
        if (!bypass || !m.bypassSeen.empty() || seconds < plan_.seconds * kExaminedShare) return;
        m.bypassSeen = bypass.value()->describeRunning(ProgramWatch::processesOf(run));
    });
    if (m.tiles.frames() > 0) m.trace = readTraceFacts(trace);
    std::error_code ignored;
    std::filesystem::remove(trace, ignored); // may be large
    if (plan_.pictures && m.tiles.report.is_object()) m.wallPicture = m.tiles.report.value("lastPicture", "");
    // Paths and options that only this report needs.
    m.tiles.options = {"--tiles", "2x2", "--verify", "--delta", "on"};
}

AppMeasured AppRuns::measure(const std::function<void(const std::string&)>& progress) {
    AppMeasured m;
    m.program = plan_.program;
    m.size = plan_.size;
    m.seconds = plan_.seconds;
    m.native.name = "native"; // also of runs that are not performed
    m.tiles.name = "tiles";
    m.balance.name = "balance";
    m.db.name = "db";
    allRuns_ = Deadline::inMs(static_cast<int64_t>(4 * plan_.seconds * 1000) + kOverheadMs - kGraceMs);
    const launch::ProgramCheck check = launch::checkProgram(
        plan_.program.front(), launch::Environment::current().get("PATH").value_or("/usr/bin:/bin"));
    if (!check.ok()) {
        m.refused = check.message;
        for (AppRun* run : {&m.native, &m.tiles, &m.balance, &m.db}) run->skipped = "the program cannot be started";
        return m;
    }
    progress("native");
    measureNative(m);
    progress("tiles");
    measureTiles(m);
    if (m.tiles.frames() == 0) {
        for (AppRun* run : {&m.balance, &m.db}) run->skipped = "no frame was captured";
        return m;
    }
    progress("balance");
    m.balance = perform("balance", {"--balance", "auto", "--local-nodes", "2", "--display", "none"});
    progress("db");
    m.db = perform("db", {"--db", "2", "--verify", "--display", "none"});
    return m;
}

} // namespace mural::cli
