// The `mural` binary with all its subcommands. This file parses the command line only.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <functional>
#include <iostream>
#include <system_error>

#include "common/log/process_log.hpp"
#include "nodes/head/head.hpp"
#include "nodes/launch/environment.hpp"
#include "nodes/launch/forking/fork_server.hpp"
#include "nodes/launch/launchers/starter/starter.hpp"
#include "nodes/launch/program_check.hpp"
#include "nodes/render/node.hpp"
#include "nodes/replay/engine/make_replay.hpp"
#include "tools/mural/accuracy/accuracy_command.hpp"
#include "nodes/session/stream_build.hpp"
#include "tools/mural/app_report/app_report_command.hpp"
#include "nodes/trace_player/player.hpp"
#include "tools/mural/commands.hpp"
#include "tools/mural/change/change_command.hpp"
#include "tools/mural/config/config_command.hpp"
#include "tools/mural/ctl/ctl_command.hpp"
#include "tools/mural/daemon/discover.hpp"
#include "tools/mural/help/complete_command.hpp"
#include "tools/mural/help/help_command.hpp"
#include "tools/mural/trace/dump_command.hpp"
#include "tools/mural/netperf/netperf.hpp"
#include "tools/mural/hosts/hosts_doctor.hpp"
#include "tools/mural/network/network_doctor.hpp"
#include "tools/mural/network/probe_member.hpp"
#include "tools/mural/page/page_command.hpp"
#include "tools/mural/show/show_command.hpp"
#include "tools/mural/simulate/simulate_command.hpp"
#include "tools/mural/record_costs/record_costs_command.hpp"
#include "tools/mural/run/slurm_allocation.hpp"
#include "tools/mural/version_details.hpp"
#include "tools/mural/trace/replay_command.hpp"
#include "tools/mural/trace/trim_command.hpp"
#include "tools/mural/daemon/daemon_commands.hpp"

namespace {

using mural::launch::kExitUsage;

constexpr int kExitOutput = 1; // output could not be written

int usageError(const std::string& command, std::string text) {
    for (char& c : text) {
        if (c == '\n') c = ' '; // one line per error
    }
    while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
    fmt::print(stderr, "{}: {} (see {} --help)\n", command, text, command);
    return kExitUsage;
}

// Returns the beginning of a command's lines for the user.
std::string linePrefix(const std::string& command) {
    if (command == "run" || command == "head" || command == "replay" || command == "play") return "mural: ";
    return "mural " + command + (command == "bench" ? " accuracy: " : ": ");
}

// Everything after the first "--" is the program of `mural run`, unparsed.
struct SplitLine {
    std::vector<std::string> words;
    std::vector<std::string> program;
    bool separated = false;
};

SplitLine split(int count, char** arguments) {
    SplitLine line;
    for (int i = 1; i < count; ++i) {
        const std::string word = arguments[i];
        if (line.separated) {
            line.program.push_back(word);
        } else if (word == "--") {
            line.separated = true;
        } else {
            line.words.push_back(word);
        }
    }
    return line;
}

// Without "--" the first word that is not an option begins the program; a later "--" belongs to it.
std::vector<std::string> programOf(const CLI::App& run, const SplitLine& line) {
    std::vector<std::string> program = run.remaining();
    if (!program.empty() && line.separated) program.emplace_back("--");
    program.insert(program.end(), line.program.begin(), line.program.end());
    return program;
}

// Prints the first line of --help. CLI11 supports neither the arguments after "--" nor the name before a subcommand.
class HelpFormatter : public CLI::Formatter {
public:
    std::string make_usage(const CLI::App* app, std::string) const override {
        if (app->get_parent() == nullptr) return "Usage: mural COMMAND [OPTIONS]\n";
        const std::string rest =
            app->get_name() == "run" || app->get_name() == "app-report" || app->get_name() == "record-costs"
                ? " -- PROGRAM ARGUMENTS..."
            : app->get_name() == "ctl"                                 ? " [SESSION] COMMAND..."
            : app->get_name() == "change"                              ? " [SESSION]"
            : app->get_name() == "page"                                ? " [SESSION | COMMAND]"
            : app->get_name() == "bench"                               ? " accuracy [-- PROGRAM ARGUMENTS...]"
            : app->get_name() == "replay" || app->get_name() == "dump" ? " FILE"
            : app->get_name() == "trim"                                ? " FILE FRAMES"
            : app->get_name() == "help"                                ? " [COMMAND]"
            : app->get_name() == "call"                                ? " HOST MURAL ARGUMENTS..."
                                                                       : "";
        return "Usage: mural " + app->get_name() + " [OPTIONS]" + rest + "\n";
    }
    std::string make_option_name(const CLI::Option* option, bool positional) const override {
        const std::string name = CLI::Formatter::make_option_name(option, positional);
        const auto at = name.find("{1}"); // CLI11's form of a flag with an optional value
        return at == std::string::npos ? name : name.substr(0, at) + "[=N]";
    }
};

class CommandLine {
public:
    CommandLine() {
        app_.formatter(std::make_shared<HelpFormatter>());
        app_.set_version_flag("--version", mural::cli::versionText(), "Print the version and exit");
        app_.require_subcommand(0, 1); // later words may be names of commands, such as mural ctl help
        app_.footer("mural COMMAND --help describes a command. Pages named docs/... are in the source tree; the "
                    "package installs "
                    "them in /usr/share/doc/mural/docs.\n\nExamples:\n  mural run --tiles 2x2 -- glxgears\n  "
                    "mural stat\n  mural doctor");
        addRun();
        addRecordings();
        addProcesses();
        addTools();
    }

    int perform(int count, char** arguments) {
        arguments_.assign(arguments + 1, arguments + count);
        line_ = split(count, arguments);
        if (!line_.words.empty() && !line_.words.front().starts_with("-") && !isCommand(line_.words.front())) {
            return usageError("mural", "unknown command " + line_.words.front());
        }
        std::vector<std::string> reversed(line_.words.rbegin(), line_.words.rend()); // in the order that CLI11 expects
        try {
            app_.parse(std::move(reversed));
        } catch (const CLI::CallForHelp&) {
            fmt::print("{}", current().help());
            return 0;
        } catch (const CLI::CallForVersion&) {
            return mural::cli::versionCommand();
        } catch (const CLI::ArgumentMismatch& error) {
            const std::string text = error.what(); // "--tiles: 1 required CxR missing"
            return usageError("mural " + current().get_name(), text.substr(0, text.find(':')) + " requires a value");
        } catch (const CLI::ParseError& error) {
            return usageError(current().get_parent() == nullptr ? "mural" : "mural " + current().get_name(),
                              error.what());
        }
        if (!action_) return usageError("mural", "a command is required, such as run");
        const std::string command = current().get_name();
        if (const auto started = mural::log::start(command, linePrefix(command)); !started) {
            fmt::print(stderr, "mural: {}\n", started.error().message);
            return kExitUsage;
        }
        return action_();
    }

private:
    [[nodiscard]] bool isCommand(const std::string& name) const {
        const auto commands = app_.get_subcommands([](const CLI::App*) { return true; });
        return std::any_of(commands.begin(), commands.end(), [&](const CLI::App* c) { return c->get_name() == name; });
    }

    CLI::App& current() {
        const auto chosen = app_.get_subcommands();
        return chosen.empty() ? app_ : *chosen.front();
    }

    CLI::App& add(const std::string& name, const std::string& what, std::function<int()> action,
                  const std::string& footer) {
        CLI::App* command = app_.add_subcommand(name, what);
        command->final_callback([this, action = std::move(action)] { action_ = action; });
        command->footer(footer);
        return *command;
    }

    void addRun() {
        run_ = &add(
            "run", "run an OpenGL program on a wall of render nodes", [this] { return runProgram(); }, "");
        run_->prefix_command();
        mural::cli::describeRunOptions(*run_, runArguments_);
    }

    int runProgram() {
        const auto rest = run_->remaining();
        if (!rest.empty() && rest.front().starts_with("-"))
            return usageError("mural run", "unknown option " + rest.front());
        runArguments_.program = programOf(*run_, line_);
        if (runArguments_.slurm && std::getenv("SLURM_JOB_ID") == nullptr) return runInAllocation();
        const auto options = mural::cli::runOptionsFrom(runArguments_);
        if (!options.ok()) return usageError("mural run", options.error().message);
        if (const int rank = mural::cli::nodeRankOf(options.value()); rank > 0)
            return mural::cli::runRank(options.value(), rank);
        return mural::cli::runCommand(options.value());
    }

    int runInAllocation() {
        return mural::cli::becomeSalloc(mural::cli::sallocCommandOf(mural::launch::ownBinary(), arguments_,
                                                                    runArguments_.program, *runArguments_.slurm));
    }

    void addRecordings() {
        CLI::App& replay = add(
            "replay", "replay a trace of mural run --record on a wall of render nodes", [this] { return runReplay(); },
            "");
        mural::cli::describeReplay(replay, replay_);
        CLI::App& dump = add(
            "dump", "print the calls of a trace", [this] { return mural::cli::dumpCommand(dump_); }, "");
        mural::cli::describeDump(dump, dump_);
        CLI::App& trim = add(
            "trim", "copy some frames of a trace, with the state that they need",
            [this] { return mural::cli::trimCommand(trim_); }, "");
        mural::cli::describeTrim(trim, trim_);
        CLI::App& play = add(
            "play", "", [this] { return runPlay(); }, "");
        play.group("");
        play.add_option("FILE", play_.file)->required();
        play.add_flag("--pace", play_.pace);
        play.add_flag("--loop", play_.loop);
    }

    int runReplay() {
        const auto options = mural::cli::replayOptionsFrom(replay_);
        if (!options.ok()) return usageError("mural replay", options.error().message);
        return mural::cli::replayCommand(options.value(), replay_.file);
    }

    // The program of a replay: MURAL_SESSION names its head.
    int runPlay() {
        const char* session = std::getenv("MURAL_SESSION");
        if (session == nullptr)
            return usageError("mural play", "MURAL_SESSION is not set; start the player with mural replay");
        play_.session = session;
        return mural::playRecording(play_);
    }

    void addProcesses() {
        CLI::App& head = add(
            "head", "head process of a session (started by mural run)", [this] { return mural::runHead(controlFd_); },
            "Example:\n  mural head --control-fd 3     uses the protocol of docs/reference/control-protocol.md on "
            "descriptor 3\n\nExit status: 0, or 1 if the session could not start.");
        head.add_option("--control-fd", controlFd_, "descriptor of the control connection to mural run")
            ->required()
            ->check(CLI::NonNegativeNumber);
        CLI::App& node = add(
            "node", "render node (started by the head, on this or another host), or a daemon that waits for heads",
            [this] { return runNode(); },
            "Examples:\n  mural node --connect-fd 3           shared memory with a head on this machine\n  mural node "
            "--connect wall0:4711     a head on another machine\n  mural node --wait --secret key      a daemon that "
            "accepts heads with the secret of this file\n\nExit status: 0, 1 if the node could not draw or wait, 2 for "
            "a bad argument.");
        mural::cli::describeWait(node, wait_);
        CLI::App& forker = add(
            "fork-nodes", "",
            [this] { return mural::runForkServer(controlFd_, [this](int fd) { return runForkedNode(fd); }); }, "");
        forker.group("");
        forker.add_option("--control-fd", controlFd_)->required()->check(CLI::NonNegativeNumber);
        CLI::App& starter = add(
            "starter", "", [this] { return runStarter(); }, "");
        starter.group("");
        starter.add_option("--program", starterProgram_);
        call_ = &add(
            "call",
            "start a node through a daemon (mural node --wait): a launch command for mural run and mural doctor",
            [this] { return runCall(); },
            "Examples:\n  mural run --nodes wall1,wall2 --launch \"mural call --secret key\" -- glxgears\n  mural "
            "doctor --network @wall1 --launch \"mural call --secret key\"\n\nHOST: a name or address, with :PORT "
            "unless it is 4279, or @NAME from mural discover.\nExit status: the node's; 1 if there is no connection to "
            "it, 2 for a bad argument.");
        mural::cli::describeCall(*call_, callArguments_);
        node.add_option("--connect-fd", node_.connectFd, "descriptor of the shared memory with the head")
            ->check(CLI::NonNegativeNumber);
        node.add_option("--connect", node_.connect,
                        "HOST:PORT of the head; the session's secret is read from standard input")
            ->type_name("HOST:PORT");
        node.add_option("--as", node_.name, "with --connect: identifier of this node's secret")->type_name("NAME");
    }

    // Started by heads on other hosts.
    int runStarter() {
        mural::launch::StarterOptions options;
        options.binary.isNative = !starterProgram_.empty();
        options.binary.program = starterProgram_.empty() ? mural::launch::ownBinary() : starterProgram_;
        options.version = mural::cli::muralVersion();
        options.build = mural::streamBuild();
        return mural::launch::runStarter(options);
    }

    int runCall() {
        callArguments_.command = programOf(*call_, line_);
        return mural::cli::callCommand(callArguments_);
    }

    int runNode() {
        if (wait_.wait && (node_.connectFd >= 0 || !node_.connect.empty()))
            return usageError("mural node", "--wait excludes --connect and --connect-fd");
        if (wait_.wait) return mural::cli::waitCommand(wait_);
        if ((node_.connectFd >= 0) == !node_.connect.empty())
            return usageError("mural node", "exactly one of --connect-fd, --connect and --wait is required");
        return mural::runNode(node_, mural::makeReplay);
    }

    int runForkedNode(int connectFd) {
        if (const auto started = mural::log::start("node", linePrefix("node")); !started) return kExitUsage;
        node_.connectFd = connectFd;
        return runNode();
    }

    void addTools() {
        addDoctor();
        CLI::App& ctl = add(
            "ctl", "request an operation of a running session: state, nodes, log, equalizers, end",
            [this] { return runCtl(); }, mural::cli::kCtlFooter);
        mural::cli::describeCtl(ctl, ctl_);
        CLI::App& page = add(
            "page", "show, explain and operate a running session in a browser",
            [this] { return mural::page::pageCommand(page_); }, mural::page::kPageFooter);
        mural::page::describePage(page, page_);
        CLI::App& show = add(
            "show", "show the pictures of a session on another machine (mural run --send)",
            [this] { return mural::cli::showCommand(show_); }, mural::cli::kShowFooter);
        mural::cli::describeShow(show, show_);
        CLI::App& change = add(
            "change", "divide the work of a running session in another way",
            [this] { return mural::cli::changeCommand(change_); }, mural::cli::kChangeFooter);
        mural::cli::describeChange(change, change_);
        CLI::App& stat = add(
            "stat", "show the running sessions: programs, frames, round trips, nodes",
            [this] { return mural::cli::statCommand(stat_); },
            "Examples:\n  mural stat                     once, over one second\n  mural stat --watch 2           the "
            "slowest stage of frames, every 2 seconds, until Ctrl-C\n  mural stat --json              for scripts\n  "
            "mural stat --trace f.json      300 frames, for https://ui.perfetto.dev\n  mural stat 4711 --prometheus   "
            "metrics of the session whose mural run has pid 4711\n\nA round trip is a request that only the render "
            "nodes can answer (glReadPixels, query results). The program waits\nfor its reply.\nExit status: 0, or 1 "
            "if no such session of this user runs on this machine.");
        stat.add_option("session", stat_.session, "name of a session, or pid of its mural run; default all")
            ->type_name("SESSION");
        auto* trace =
            stat.add_option("--trace", stat_.traceFile, "write a timeline of frames, in the Chrome trace format")
                ->type_name("FILE");
        stat.add_option("--frames", stat_.frames, "frames of the timeline; default 300")
            ->type_name("N")
            ->check(CLI::Range(1, 100'000))
            ->needs(trace);
        stat.add_flag("--prometheus", stat_.asPrometheus, "print metrics in the text format of Prometheus")
            ->excludes(trace);
        stat.add_flag("--json", stat_.asJson, "print one line of JSON per report");
        stat.add_option("--watch", stat_.watchSeconds, "repeat every SECONDS")
            ->type_name("SECONDS")
            ->check(CLI::Range(0.1, 3600.0));
        CLI::App& list = add(
            "list-commands", "list the GL, GLX and EGL commands and their support",
            [this] { return mural::cli::listCommandsCommand(onlyUnsupported_); },
            "Examples:\n  mural list-commands\n  mural list-commands --unsupported\n\nOne command per line: name, "
            "class, and the reason if it is unsupported.\nExit status: 0.");
        list.add_flag("--unsupported", onlyUnsupported_, "only unsupported commands");
        CLI::App& netperf = add(
            "netperf", "measure reliable multicast between machines, or on this one",
            [this] { return mural::cli::netperfCommand(netperf_); },
            "Examples:\n  mural netperf                                             two receivers on this machine\n  "
            "mural netperf --members 4 --message 64                    latency of short messages to all receivers\n  "
            "mural netperf send --members 3 --rate 900mbit --secret-file key\n  mural netperf receive --control "
            "wall0:4278 --secret-file key\n  mural netperf send --stream "
            "'rsp://239.255.77.85:4277?interface=eth1&silent-ms=20000&secret=key'\n\nReceivers check each byte. Exit "
            "status: 0, or 1 if a byte was lost or changed.");
        mural::cli::describeNetperf(netperf, netperf_);
        CLI::App& discover = add(
            "discover", "find the daemons of this network", [this] { return mural::cli::discoverCommand(discover_); },
            "Examples:\n  mural discover\n  mural discover --seconds 5 --json\n  mural discover --interface eth1 "
            "--no-avahi\n\nLists machines that run `mural node --wait`. Announcements are not authenticated; sessions "
            "check the secret.\nExit status: 0, 1 if no daemon was found, 2 for a bad argument.");
        mural::cli::describeDiscover(discover, discover_);
        addAppReport();
        addRecordCosts();
        addBench();
        addConfig();
        addHelp();
        CLI::App& version = add(
            "version", "print the version", [this] { return runVersion(); },
            "Examples:\n  mural version\n  mural version --verbose      build, formats, libraries, and the files that "
            "this binary finds\n\nExit status: 0.");
        version.add_flag("--verbose", isVerbose_, "also print the build, formats, libraries and files");
        add(
            "preload-probe", "", [] { return mural::cli::preloadProbeCommand(); }, "")
            .group("");
        add(
            "network-member", "", [] { return mural::cli::networkMemberCommand(); }, "")
            .group("");
    }

    int runCtl() {
        ctl_.words.insert(ctl_.words.end(), line_.program.begin(), line_.program.end());
        return mural::cli::ctlCommand(ctl_);
    }

    void addAppReport() {
        appReport_ = &add(
            "app-report", "report before a show what a program will do on a wall", [this] { return runAppReport(); },
            mural::cli::kAppReportFooter);
        appReport_->prefix_command();
        mural::cli::describeAppReport(*appReport_, appReportArguments_);
    }

    int runAppReport() {
        const auto rest = appReport_->remaining();
        if (!rest.empty() && rest.front().starts_with("-"))
            return usageError("mural app-report", "unknown option " + rest.front());
        appReportArguments_.program = programOf(*appReport_, line_);
        return mural::cli::appReportCommand(appReportArguments_);
    }

    void addRecordCosts() {
        recordCosts_ = &add(
            "record-costs", "measure what the parts of a program's pictures cost, for mural simulate",
            [this] { return runRecordCosts(); }, mural::cli::kRecordCostsFooter);
        recordCosts_->prefix_command();
        mural::cli::describeRecordCosts(*recordCosts_, recordCostsArguments_);
    }

    int runRecordCosts() {
        const auto rest = recordCosts_->remaining();
        if (!rest.empty() && rest.front().starts_with("-"))
            return usageError("mural record-costs", "unknown option " + rest.front());
        recordCostsArguments_.program = programOf(*recordCosts_, line_);
        return mural::cli::recordCostsCommand(recordCostsArguments_);
    }

    void addBench() {
        CLI::App& bench = add(
            "bench", "measure the difference between Mural's pictures and native ones", [this] { return runBench(); },
            "Examples:\n  mural bench accuracy                              every decomposition, composition and "
            "codec, on Mural's own scenes\n  mural bench accuracy --quick                      one of each kind, on "
            "small pictures\n  mural bench accuracy --json a.json --svg a.svg    the results as JSON and as a plot\n  "
            "mural bench accuracy --recording app.mural        on a trace: errors with CPU time and bytes\n  mural "
            "bench accuracy --frames 60 -- glxgears      each frame of a program against its own context\n\nEverything "
            "runs on this machine on a private display. docs/measurements/accuracy.md justifies the bounds.\nExit "
            "status: 0, 1 if a bound is exceeded, a run failed or a result cannot be written, 2 if nothing was "
            "measured.");
        mural::cli::describeBench(bench, bench_);
    }

    int runBench() {
        bench_.program = line_.program;
        if (line_.separated && bench_.program.empty())
            return usageError("mural bench", "the program after -- is missing");
        return mural::cli::benchCommand(bench_);
    }

    void addConfig() {
        CLI::App& config = add(
            "config", "check, print or draw a configuration file",
            [this] { return mural::cli::configCommand(config_); },
            "Examples:\n  mural config check wall.eqc                       contents and errors\n  mural config print "
            "wall.eqc                       the file in current syntax\n  mural config print wall.eqc --resolved "
            "--frame 2  the tasks of every channel in frame 2\n  mural config draw wall.eqc --out wall.svg         "
            "displays, machines and compounds as a picture\n\ndocs/reference/configuration.md describes the format. "
            "Exit status: 0, 1 if the output cannot be written, 2 for errors in the file.");
        mural::cli::describeConfig(config, config_);
        CLI::App& simulate = add(
            "simulate", "try how work is balanced among nodes, with recorded or made-up costs and without nodes",
            [this] { return mural::cli::simulateCommand(simulate_); }, mural::cli::kSimulateFooter);
        mural::cli::describeSimulate(simulate, simulate_);
    }

    int runVersion() {
        return isVerbose_ ? mural::cli::verboseVersionCommand(mural::cli::versionDetails())
                          : mural::cli::versionCommand();
    }

    void addHelp() {
        CLI::App& help = add(
            "help", "describe a command, or write the manual pages",
            [this] { return mural::cli::helpCommand(app_, help_); }, mural::cli::kHelpFooter);
        mural::cli::describeHelp(help, help_);
        add(
            "complete", "", [this] { return mural::cli::completeCommand(app_, line_.program); }, "")
            .group("");
    }

    void addDoctor() {
        CLI::App& doctor = add(
            "doctor", "check this machine, all machines of a wall, or the network, for Mural",
            [this] { return runDoctor(); },
            "Examples:\n  mural doctor\n  mural doctor --json\n  mural doctor --network                      sockets "
            "and limits of this machine\n  mural doctor --network wall1,wall2          multicast, datagram size, rate "
            "and losses to these hosts\n  mural doctor --nodes wall1,wall2            all machines of a wall: "
            "differences and faults\n  mural doctor --nodes wall1,wall2 --config wall.eqc\n\nEach line is ok, warn or "
            "bad, with a remedy.\nExit status: 0 if Mural can be "
            "used, 1 if a problem must be fixed, 2 for a bad argument. With --nodes: 0; 1 with warnings, 2 with "
            "faults.");
        doctor.option_defaults()->take_last();
        doctor.add_flag("--json", asJson_, "print JSON");
        network_ = mural::cli::describeNetworkDoctor(doctor, networkArguments_);
        nodes_ = mural::cli::describeHostsDoctor(doctor, hostsArguments_);
        network_->excludes(nodes_);
        doctor_ = &doctor;
    }

    int runDoctor() {
        for (const char* option : {"--launch", "--remote-mural", "--group", "--interface"})
            if (network_->count() + nodes_->count() == 0 && doctor_->count(option) > 0)
                return usageError("mural doctor", std::string(option) + " requires --network or --nodes");
        if (nodes_->count() > 0) return mural::cli::hostsDoctorCommand(hostsArguments_, networkArguments_, asJson_);
        return network_->count() > 0 ? mural::cli::networkDoctorCommand(networkArguments_, asJson_)
                                     : mural::cli::doctorCommand(asJson_);
    }

    CLI::App app_{"Mural: unmodified OpenGL programs on display walls and clusters.", "mural"};
    std::vector<std::string> arguments_;
    SplitLine line_;
    CLI::App* run_ = nullptr;
    CLI::App* call_ = nullptr;
    CLI::App* appReport_ = nullptr;
    mural::cli::AppReportArguments appReportArguments_;
    CLI::App* recordCosts_ = nullptr;
    mural::cli::RecordCostsArguments recordCostsArguments_;
    mural::cli::CallArguments callArguments_;
    std::string starterProgram_; // with the native API; empty: mural
    mural::cli::WaitArguments wait_;
    mural::cli::RunArguments runArguments_;
    mural::NodeOptions node_;
    mural::cli::ReplayArguments replay_;
    mural::PlayOptions play_;
    mural::cli::DumpArguments dump_;
    mural::cli::TrimArguments trim_;
    int controlFd_ = -1;
    bool asJson_ = false;
    bool isVerbose_ = false;
    bool onlyUnsupported_ = false;
    mural::cli::StatOptions stat_;
    mural::cli::ChangeArguments change_;
    mural::cli::CtlArguments ctl_;
    mural::page::PageArguments page_;
    mural::cli::ShowArguments show_;
    mural::cli::BenchArguments bench_;
    mural::cli::ConfigArguments config_;
    mural::cli::SimulateArguments simulate_;
    mural::cli::DiscoverArguments discover_;
    mural::cli::NetperfArguments netperf_;
    mural::cli::HelpArguments help_;
    mural::cli::NetworkArguments networkArguments_;
    mural::cli::HostsArguments hostsArguments_;
    CLI::App* doctor_ = nullptr;
    CLI::Option* network_ = nullptr;
    CLI::Option* nodes_ = nullptr;
    std::function<int()> action_;
};

// Checks that standard output was written. The output of a command is its result, so a command whose output is lost has
// failed.
int afterOutput(int status, std::string why) {
    errno = 0;
    std::cout.flush();
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout) return status;
    if (why.empty() && errno != 0) why = std::strerror(errno); // otherwise an earlier write failed
    fmt::print(stderr, "mural: the output cannot be written{}{}; free space, or choose another destination\n",
               why.empty() ? "" : ": ", why);
    return status != 0 ? status : kExitOutput;
}

} // namespace

int main(int count, char** arguments) {
    int status = kExitOutput;
    std::string why;
    try {
        status = CommandLine().perform(count, arguments);
    } catch (const std::system_error& error) { // thrown by fmt::print() on output errors
        if (std::ferror(stdout) == 0) throw;
        why = error.code().message();
    }
    return afterOutput(status, std::move(why));
}
