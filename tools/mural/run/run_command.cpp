// `mural run`: checks everything that can fail before it starts a process, then runs the session.
#include <algorithm>
#include <cstdio>

#include "common/log/log.hpp"
#include "nodes/launch/gl_libraries.hpp"
#include "nodes/launch/launchers/pmix_launcher.hpp"
#include "nodes/launch/program_check.hpp"
#include "tools/mural/commands.hpp"
#include "tools/mural/run/native_program.hpp"
#include "tools/mural/run/prepare_run.hpp"
#include "tools/mural/run/run_session.hpp"

namespace mural::cli {

namespace {

// A program whose GL library is not GLVND's needs the preloaded entry.
launch::CaptureEntries chooseEntries(const RunOptions& options, const launch::ProgramCheck& program,
                                     const launch::Environment& environment) {
    if (options.captureVia == EntryChoice::Preload) return launch::CaptureEntries::VendorAndPreload;
    if (options.captureVia == EntryChoice::Glvnd || program.binary.empty()) return launch::CaptureEntries::Vendor;
    const auto own = launch::ownGlLibraries(program.binary, environment);
    if (own.empty()) return launch::CaptureEntries::Vendor;
    if (options.config.explain)
        Console(true).error("capture: preloaded library, for " + own.front() + ", which GLVND does not load");
    return launch::CaptureEntries::VendorAndPreload;
}

// Prepares the environment of a program whose GL is captured.
Result<void> prepareCapture(const RunOptions& options, const launch::ProgramCheck& program, PreparedRun& run) {
    const auto library = launch::findCaptureLibrary(launch::ownBinary());
    if (!library.ok()) return library.error();
    const launch::CaptureEntries entries = chooseEntries(options, program, run.programEnvironment);
    return launch::addCapture(run.programEnvironment, library.value(), run.config.session, entries);
}

int complain(const std::string& text, int status) {
    Console(true).error(text);
    return status;
}

// The program is no part of the processes that mpirun or srun has started.
void removeRank(launch::Environment& environment) {
    const launch::Environment all = environment;
    for (const std::string& entry : all.entries())
        for (const char* const prefix : {"PMIX_", "OMPI_", "PMI_"})
            if (entry.starts_with(prefix)) environment.unset(entry.substr(0, entry.find('=')));
}

} // namespace

int nodeRankOf(const RunOptions& options) {
    if (options.config.launchCommand != "pmix") return 0;
    return std::max(0, launch::pmixPlaceOf(launch::Environment::current()).rank);
}

int runRank(const RunOptions& options, int rank) {
    NodeBinary binary;
    binary.program = options.config.nodeProgram.empty() ? launch::ownBinary() : options.config.nodeProgram;
    binary.isNative = !options.config.nodeProgram.empty();
    if (!binary.isNative) {
        const auto program = launch::checkProgram(options.program.front(),
                                                  launch::Environment::current().get("PATH").value_or("/usr/bin:/bin"));
        binary.isNative = program.ok() && usesNativeApi(program);
        if (binary.isNative) binary.program = program.path;
    }
    return runPmixRank(rank, binary, options.config.startTimeoutMs);
}

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
    run.page = options.page;
    run.programEnvironment = launch::Environment::current();
    run.headEnvironment = run.programEnvironment;
    launch::removeCapture(run.headEnvironment);
    if (run.config.launchCommand == "pmix") removeRank(run.programEnvironment);

    const launch::ProgramCheck program =
        launch::checkProgram(options.program.front(), run.programEnvironment.get("PATH").value_or("/usr/bin:/bin"));
    if (!program.ok()) return complain(program.message, program.exitStatus);
    run.programPath = program.path;
    const bool isNative = !run.config.nodeProgram.empty() || usesNativeApi(program);
    if (auto r = isNative ? prepareNativeProgram(options, program, run) : prepareCapture(options, program, run); !r)
        return complain(r.error().message, launch::kExitUsage);
    if (auto r = checkOutput(run.config.out); !r) return complain(r.error().message, launch::kExitUsage);
    if (auto r = checkResultFile("--report", run.reportFile); !r)
        return complain(r.error().message, launch::kExitUsage);
    if (auto r = checkResultFile("--frame-times", run.config.frameTimes); !r)
        return complain(r.error().message, launch::kExitUsage);
    if (auto r = chooseDisplay(options, !isNative, run); !r) return complain(r.error().message, launch::kExitUsage);

    if (!options.native) createSessionSocket(run);

    run.headCommand = {launch::ownBinary(), "head"};
    Console console(options.quiet);
    if (options.config.explain && !options.launchChoice.empty()) Console(true).error(options.launchChoice);
    if (!options.launchChoice.empty()) log::debug(log::Topic::Launch, options.launchChoice);
    for (const std::string& notice : options.notices) console.say(notice);
    for (const std::string& notice : {unseenPictures(options, run), earlierPictures(run.config.out)})
        if (!notice.empty()) console.say(notice);
    return options.native ? runNative(run, console) : runSession(run, console);
}

} // namespace mural::cli
