// Finds out all that can be wrong before anything is started, then runs the session.
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <sys/random.h>
#include <unistd.h>

#include "nodes/launch/gl_libraries.hpp"
#include "nodes/launch/program_check.hpp"
#include "nodes/output/outputs.hpp"
#include "tools/mural/commands.hpp"
#include "tools/mural/run_session.hpp"

namespace mural::cli {

namespace {

// Names are guessed by nobody else and fit into an abstract socket's.
std::string newSessionName() {
    uint64_t random = 0;
    if (getrandom(&random, sizeof random, 0) != sizeof random) random = static_cast<uint64_t>(monotonicNowNs());
    return fmt::format("mural-{}-{:016x}", getpid(), random);
}

// What can be said about --out before the first picture; the head opens it.
Result<void> checkOutput(const std::string& out) {
    namespace fs = std::filesystem;
    if (out.empty()) return {};
    const auto kind = outputKindOf(out);
    if (!kind.ok()) return kind.error();
    const bool video = kind.value() == OutputKind::Video;
    const fs::path folder = video ? fs::path(out).parent_path() : fs::path(out);
    if (folder.empty()) return {};
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) return Error{fmt::format("--out {}: the folder cannot be made: {}; give another place", out, failed.message())};
    if (access(folder.c_str(), W_OK) != 0) return Error{fmt::format("--out {}: may not be written: {}; give another place", out, std::strerror(errno))};
    return {};
}

// Which display the program and the wall get; starts a private one where needed.
Result<void> chooseDisplay(const RunOptions& options, PreparedRun& run) {
    SessionConfig& c = run.config;
    const std::string own = run.programEnvironment.get("DISPLAY").value_or("");
    const bool sized = c.width > 0;
    const bool usable = launch::displayUsable(own);
    const Error unusable{own.empty() ? "--display app and windows need an X display, and DISPLAY is not set; set it, or use --display none"
                                     : "the X display \"" + own + "\" (DISPLAY) cannot be opened; check that it runs, or unset DISPLAY to run without one"};
    if (c.display == Display::Windows && !usable) return unusable;
    if (!options.displayChosen && !usable && !own.empty() && !sized) return unusable;
    if (options.displayChosen && c.display == Display::App && !usable && !sized) return unusable;
    if (!options.displayChosen) c.display = usable && !sized ? Display::App : Display::None;

    c.displayName = own;
    if (usable && !sized) return {};
    auto display = launch::PrivateDisplay::start(sized ? c.width : launch::kDefaultScreenWidth, sized ? c.height : launch::kDefaultScreenHeight);
    if (!display) return display.error();
    run.display = std::move(display.value());
    run.display->use(run.programEnvironment);
    if (c.display != Display::Windows) { // the wall's own windows belong on the user's display
        c.displayName = run.display->name();
        run.display->use(run.headEnvironment);
    }
    if (!sized) return {};
    auto manager = launch::WallWindowManager::open(run.display->name(), run.display->authority().cookie(), c.width, c.height);
    if (!manager) return manager.error();
    run.windowManager = std::move(manager.value());
    return {};
}

// A program whose GL library is not GLVND's needs the preloaded front.
launch::Fronts chooseFronts(const RunOptions& options, const launch::ProgramCheck& program, const launch::Environment& environment) {
    if (options.front == FrontChoice::Preload) return launch::Fronts::VendorAndPreload;
    if (options.front == FrontChoice::Glvnd || program.binary.empty()) return launch::Fronts::Vendor;
    const auto own = launch::ownGlLibraries(program.binary, environment);
    if (own.empty()) return launch::Fronts::Vendor;
    if (options.config.explain) Console(true).error("front: preloaded, for " + own.front() + ", which GLVND does not lead to");
    return launch::Fronts::VendorAndPreload;
}

int complain(const std::string& text, int status) {
    Console(true).error(text);
    return status;
}

} // namespace

int runCommand(const RunOptions& options) {
    if (!options.configText.empty()) {
        std::fputs(options.configText.c_str(), stdout);
        return 0;
    }
    PreparedRun run;
    run.config = options.config;
    run.config.session = newSessionName();
    run.program = options.program;
    run.reportFile = options.reportFile;
    run.programEnvironment = launch::Environment::current();
    run.headEnvironment = run.programEnvironment;
    launch::removeCapture(run.headEnvironment);

    const launch::ProgramCheck program = launch::checkProgram(options.program.front(), run.programEnvironment.get("PATH").value_or("/usr/bin:/bin"));
    if (!program.ok()) return complain(program.message, program.exitStatus);
    run.programPath = program.path;
    const auto library = launch::findCaptureLibrary(launch::ownBinary());
    if (!library.ok()) return complain(library.error().message, launch::kExitUsage);
    const launch::Fronts fronts = chooseFronts(options, program, run.programEnvironment);
    if (auto r = launch::addCapture(run.programEnvironment, library.value(), run.config.session, fronts); !r) return complain(r.error().message, launch::kExitUsage);
    if (auto r = checkOutput(run.config.out); !r) return complain(r.error().message, launch::kExitUsage);
    if (auto r = chooseDisplay(options, run); !r) return complain(r.error().message, launch::kExitUsage);

    run.headCommand = {launch::ownBinary(), "head"};
    Console console(options.quiet);
    for (const std::string& notice : options.notices) console.say(notice);
    return options.native ? runNative(run, console) : runSession(run, console);
}

} // namespace mural::cli
