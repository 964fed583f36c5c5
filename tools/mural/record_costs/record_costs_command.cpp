#include "tools/mural/record_costs/record_costs_command.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <sstream>
#include <unistd.h>

#include "nodes/launch/private_display.hpp"
#include "nodes/launch/process_tree.hpp"
#include "nodes/launch/program_check.hpp"
#include "tools/mural/child_runs/bounded_run.hpp"
#include "tools/mural/child_runs/interruption.hpp"
#include "tools/mural/child_runs/result_file.hpp"
#include "tools/mural/child_runs/scratch_folder.hpp"
#include "tools/mural/record_costs/frame_work.hpp"
#include "tools/mural/run/option_values.hpp"

namespace mural::cli {

namespace {

using simulation::WorkByFrame;

constexpr int kMaxNodes = 256; // of one run, on this machine
constexpr int kMaxSide = 16'384;
constexpr uint32_t kFirstFrame = 2; // the first one creates textures and compiles shaders in every node
// A node draws many frames in a row, so that it finds its data in the caches. With 48 nodes on two cores, a change of
// process before each frame would cost more time than most cells.
constexpr const char* kLatency = "32";
constexpr int64_t kStartMs = 60'000;
constexpr int64_t kGraceMs = 4'500; // mural run ends a program that ignores SIGTERM within 3 s

int complain(const Error& error, int status = launch::kExitUsage) {
    fmt::print(stderr, "mural record-costs: {}\n", error.message);
    const int number = Interruption::signal();
    return number != 0 ? 128 + number : status;
}

// Runs the program with several divisions of its work on a private display.
class CostRuns {
public:
    static Result<std::unique_ptr<CostRuns>> open(const RecordCostsArguments& arguments) {
        auto scratch = ScratchFolder::make();
        if (!scratch) return scratch.error();
        launch::adoptOrphans(); // for runBounded()
        auto display = launch::PrivateDisplay::start(launch::kDefaultScreenWidth, launch::kDefaultScreenHeight);
        if (!display) return display.error();
        return std::unique_ptr<CostRuns>(new CostRuns(arguments, std::move(*scratch), std::move(*display)));
    }

    // nodes: of the division that `options` describes. Returns the least work of all rounds, smoothed.
    Result<WorkByFrame> measure(const std::string& name, const std::vector<std::string>& options, size_t nodes) {
        WorkByFrame least;
        for (int round = 0; round < arguments_.rounds; ++round) {
            auto work = measureOnce(name, options, nodes);
            if (!work) return work;
            if (round == 0)
                least = std::move(*work);
            else
                simulation::keepLeastWork(least, *work);
        }
        simulation::smoothOverTime(least, static_cast<size_t>(arguments_.smooth));
        return least;
    }

private:
    Result<WorkByFrame> measureOnce(const std::string& name, const std::vector<std::string>& options, size_t nodes) {
        const std::string times = scratch_.path() + "/times.jsonl";
        if (isatty(STDERR_FILENO) == 1)
            fmt::print(stderr, "mural record-costs: {} (at most {:.0f} s) ...\n", name, arguments_.seconds);
        auto outcome = runBounded(commandOf(options, nodes, times));
        if (!outcome) return outcome.error();
        if (Interruption::signal() != 0) return Error{"interrupted; nothing is written"};
        std::ifstream file(times, std::ios::binary);
        auto work = readFrameWork(file, nodes, kFirstFrame);
        if (!work) return Error{"--frame-times: " + work.error().message};
        if (work->empty()) return Error{reasonOf(name, *outcome)};
        return work;
    }

    CostRuns(const RecordCostsArguments& arguments, ScratchFolder scratch,
             std::unique_ptr<launch::PrivateDisplay> display)
        : arguments_(arguments), scratch_(std::move(scratch)), display_(std::move(display)) {}

    [[nodiscard]] BoundedCommand commandOf(std::vector<std::string> options, size_t nodes,
                                           const std::string& times) const {
        BoundedCommand command;
        command.words = {launch::ownBinary(),
                         "run",
                         "--quiet",
                         "--display",
                         "none",
                         "--frame-times",
                         times,
                         "--frames",
                         std::to_string(arguments_.frames + 1)};
        options.insert(options.end(), {"--local-nodes", std::to_string(nodes), "--latency", kLatency});
        if (!arguments_.size.empty()) options.insert(options.end(), {"--size", arguments_.size});
        command.words.insert(command.words.end(), options.begin(), options.end());
        command.words.emplace_back("--");
        command.words.insert(command.words.end(), arguments_.program.begin(), arguments_.program.end());
        command.environment = launch::Environment::current();
        launch::removeCapture(command.environment);
        // One thread per node, so that the CPU time of a node is the work for its part.
        command.environment.set("LP_NUM_THREADS", "0");
        display_->use(command.environment);
        command.startMs = kStartMs;
        command.limitMs = static_cast<int64_t>(arguments_.seconds * 1000);
        command.totalMs = command.startMs + command.limitMs;
        command.graceMs = kGraceMs;
        command.display = display_->pid();
        command.hasBegun = [](pid_t) { return true; };
        return command;
    }

    static std::string reasonOf(const std::string& name, const BoundedOutcome& outcome) {
        std::string reason = outcome.endedItself ? outcome.end : "its time was over; give --seconds more";
        if (!outcome.messages.empty()) reason += ": " + outcome.messages.back();
        return fmt::format("no node drew a second frame ({}): {}", name, reason);
    }

    const RecordCostsArguments& arguments_;
    ScratchFolder scratch_;
    std::unique_ptr<launch::PrivateDisplay> display_;
};

Result<simulation::CostTrace> record(const RecordCostsArguments& a, const std::pair<int, int>& grid) {
    auto runs = CostRuns::open(a);
    if (!runs) return runs.error();
    simulation::MeasuredRuns measured;
    measured.columns = static_cast<size_t>(grid.first);
    measured.rows = static_cast<size_t>(grid.second);
    auto whole = (*runs)->measure("the whole picture", {"--tiles", "1x1"}, 1);
    if (!whole) return whole.error();
    auto cells = (*runs)->measure("its cells", {"--tiles", a.grid}, measured.columns * measured.rows);
    if (!cells) return cells.error();
    auto ranges = (*runs)->measure("its range", {"--db", std::to_string(a.ranges)}, static_cast<size_t>(a.ranges));
    if (!ranges) return ranges.error();
    measured.whole = std::move(*whole);
    measured.cells = std::move(*cells);
    measured.ranges = std::move(*ranges);
    auto trace = simulation::costsOf(measured, a.program.front());
    // The program draws a few more frames until its session ends.
    if (trace) trace->frames.resize(std::min(trace->frames.size(), static_cast<size_t>(a.frames)));
    return trace;
}

} // namespace

const char* const kRecordCostsFooter =
    R"(Examples:
  mural record-costs --out app.cost -- app                      8x6 cells, 32 parts of the range, 100 frames
  mural record-costs --out gears.cost --grid 4x4 --frames 60 -- glxgears
  mural simulate --cost app.cost --nodes 16 --compare           what the equalizers make of it

The program runs on a private display: with one node, with one node per cell, and with one node per part of the range.
All nodes run on this machine. The frames of the runs must show the same, so a program that follows the clock
gives a blurred trace; a recording (mural play app.mural) does not.
Exit status: 0; 1 the trace cannot be written; 2 a bad argument, or the program drew nothing.)";

void describeRecordCosts(CLI::App& command, RecordCostsArguments& a) {
    command.add_option("--out", a.out, "file of the cost trace")->type_name("FILE");
    command.add_option("--grid", a.grid, "cells of the picture, one node each (8x6)")->type_name("CxR");
    command.add_option("--ranges", a.ranges, "parts of the range, one node each (32)")
        ->type_name("N")
        ->check(CLI::Range(2, kMaxNodes));
    command.add_option("--frames", a.frames, "frames of the trace (100)")
        ->type_name("N")
        ->check(CLI::Range(1, 100'000));
    command.add_option("--rounds", a.rounds, "runs of each division; the least time of a part counts (3)")
        ->type_name("N")
        ->check(CLI::Range(1, 100));
    command
        .add_option("--smooth", a.smooth,
                    "each time is the median of N neighbouring frames, an odd number; 1: as measured (9)")
        ->type_name("N")
        ->check(CLI::Range(1, 999));
    command.add_option("--size", a.size, "size of the picture, as for mural run (the program's own)")->type_name("WxH");
    command.add_option("--seconds", a.seconds, "longest duration of each run (120)")
        ->type_name("SECONDS")
        ->check(CLI::Range(1.0, 86'400.0));
}

int recordCostsCommand(const RecordCostsArguments& a) {
    if (a.out.empty()) return complain(Error{"--out is needed: a file for the trace, such as --out app.cost"});
    if (a.program.empty())
        return complain(Error{"a program is required, such as mural record-costs --out gears.cost -- glxgears"});
    const auto grid = pairOf(a.grid, 'x', 1, kMaxNodes);
    if (!grid || grid->first * grid->second > kMaxNodes || grid->first * grid->second < 2)
        return complain(
            Error{fmt::format("--grid \"{}\": must be COLUMNSxROWS, 2 to {} cells, such as 8x6", a.grid, kMaxNodes)});
    if (!a.size.empty() && !pairOf(a.size, 'x', 1, kMaxSide))
        return complain(Error{"--size \"" + a.size + "\": must be WIDTHxHEIGHT in pixels, such as 1920x1080"});
    if (a.smooth % 2 == 0)
        return complain(Error{fmt::format("--smooth {}: must be odd, such as {}", a.smooth, a.smooth + 1)});
    const launch::ProgramCheck program =
        launch::checkProgram(a.program.front(), launch::Environment::current().get("PATH").value_or("/usr/bin:/bin"));
    if (!program.ok()) return complain(Error{program.message}, program.exitStatus);
    const Interruption interruption; // before anything is created that must be removed
    auto file = ResultFile::open("--out", a.out);
    if (!file) return complain(file.error());
    const auto trace = record(a, {static_cast<int>(grid->first), static_cast<int>(grid->second)});
    if (!trace) return complain(trace.error());
    std::ostringstream text;
    simulation::writeCostTrace(*trace, text);
    if (const auto written = file->write(text.str()); !written) return complain(written.error(), 1);
    fmt::print("{}: {} frames of {}x{} cells and {} parts of the range\n", a.out, trace->frames.size(), trace->columns,
               trace->rows, trace->ranges);
    return 0;
}

} // namespace mural::cli
