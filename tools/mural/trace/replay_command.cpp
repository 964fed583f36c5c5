#include "tools/mural/trace/replay_command.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "nodes/launch/program_check.hpp"
#include "streamcodec/trace/trace_reader.hpp"
#include "tools/mural/run/prepare_run.hpp"

namespace mural::cli {

namespace {

constexpr const char* kReplayFooter = R"(Examples:
  mural run --record gears.mural --frames 300 -- glxgears      records a trace
  mural replay gears.mural                                     shows it in a window
  mural replay gears.mural --tiles 2x2 --out shots             on 4 local nodes, as PNG files
  mural replay gears.mural --nodes wall1,wall2 --display windows --fullscreen --pace --loop
  mural replay gears.mural --db 3 --frames 100 --report report.json

Frames are shown as fast as the nodes draw them, or with --pace at the recorded times.
Exit status: 0, 1 if the session failed, 2 for a bad argument or an unreadable trace.)";

} // namespace

void describeReplay(CLI::App& command, ReplayArguments& a) {
    command.add_option("FILE", a.file, "trace file of mural run --record")->required();
    describeRunOptions(command, a.run);
    // Options about the program itself do not apply to a trace.
    for (const char* name : {"--size", "--native", "--verify", "--local-rendering", "--capture-via", "--print-config"})
        command.remove_option(command.get_option(name));
    command.add_flag("--pace", a.pace, "replay at the recorded times");
    command.add_flag("--loop", a.loop, "repeat until --frames or Ctrl-C");
    command.footer(kReplayFooter);
}

Result<RunOptions> replayOptionsFrom(const ReplayArguments& a) {
    RunArguments run = a.run;
    run.program = {"mural", "play", a.file};
    if (a.pace) run.program.emplace_back("--pace");
    if (a.loop) run.program.emplace_back("--loop");
    auto options = runOptionsFrom(run);
    if (!options) return options;
    std::error_code none;
    if (!options->config.record.empty() && std::filesystem::equivalent(options->config.record, a.file, none))
        return Error{"--record " + a.file + " is the file being replayed; choose another file"};
    return options;
}

int replayCommand(const RunOptions& options, const std::string& file) {
    Console console(options.quiet);
    const auto complain = [&](const Error& error) {
        console.error(error.message);
        return launch::kExitUsage;
    };
    auto reader = trace::TraceReader::open(file);
    if (!reader) return complain(reader.error());
    if (const auto whole = reader.value()->verify(); !whole) return complain(whole.error());
    if (reader.value()->frames() == 0) return complain(reader.value()->noSuchFrames(0));
    if (!reader.value()->notice().empty()) console.error(reader.value()->notice());
    PreparedRun run;
    run.config = options.config;
    run.config.session = newSessionName();
    run.reportFile = options.reportFile;
    run.programPath = launch::ownBinary();
    run.program = options.program;
    run.programEnvironment = launch::Environment::current();
    launch::removeCapture(run.programEnvironment);
    run.headEnvironment = run.programEnvironment;
    run.programEnvironment.set("MURAL_SESSION", run.config.session);
    if (auto r = checkOutput(run.config.out); !r) return complain(r.error());
    if (auto r = checkResultFile("--report", run.reportFile); !r) return complain(r.error());
    if (auto r = chooseDisplay(options, false, run); !r) return complain(r.error());
    run.headCommand = {launch::ownBinary(), "head"};
    for (const std::string& notice : options.notices) console.say(notice);
    for (const std::string& notice : {unseenPictures(options, run), earlierPictures(run.config.out)})
        if (!notice.empty()) console.say(notice);
    return runSession(run, console);
}

} // namespace mural::cli
