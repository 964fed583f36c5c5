#include "tools/mural/accuracy/accuracy_command.hpp"

#include <cstdio>
#include <fmt/format.h>
#include <optional>

#include "nodes/launch/program_check.hpp"
#include "tools/mural/accuracy/plot/accuracy_plot.hpp"
#include "tools/mural/accuracy/accuracy_runs.hpp"
#include "tools/mural/accuracy/accuracy_text.hpp"
#include "tools/mural/accuracy/composition_rows.hpp"
#include "tools/mural/child_runs/interruption.hpp"
#include "tools/mural/accuracy/program_rows.hpp"
#include "tools/mural/accuracy/progress.hpp"
#include "tools/mural/accuracy/recording_rows.hpp"
#include "tools/mural/accuracy/resolution_rows.hpp"
#include "tools/mural/child_runs/result_file.hpp"
#include "tools/mural/accuracy/scene_rows.hpp"
#include "tools/mural/accuracy/transform_rows.hpp"

namespace mural::cli {

namespace {

// Avoids fmt::print, which throws if the reader of the pipe has gone.
void printError(const std::string& what) { std::fputs(("mural bench accuracy: " + what + "\n").c_str(), stderr); }

int complain(const Error& error) {
    printError(error.message);
    const int number = Interruption::signal();
    return number != 0 ? 128 + number : launch::kExitUsage;
}

// Reports errors common to all runs once, before the first run.
Result<void> checkSubject(const BenchArguments& a) {
    if (!a.program.empty() && !a.recordings.empty())
        return Error{"--recording measures a trace, not a program; omit --recording or the program"};
    for (const std::string& recording : a.recordings)
        if (auto r = checkRecording(recording); !r) return r;
    if (a.program.empty()) return {};
    const launch::ProgramCheck program =
        launch::checkProgram(a.program.front(), launch::Environment::current().get("PATH").value_or("/usr/bin:/bin"));
    if (!program.ok()) return Error{program.message};
    return {};
}

Result<void> measureScenes(const AccuracyRuns& runs, bool quick, AccuracyReport& report) {
    SceneRows scenes(runs, quick);
    if (auto r = scenes.prepare(); !r) return r;
    report.subject = scenes.subject();
    report.gl = scenes.gl();
    scenes.measure(report.rows);
    if (Interruption::signal() != 0) return {};
    measureResolutions(runs, quick, report.rows);
    if (Interruption::signal() != 0) return {};
    reportProgress("composition");
    measureComposition(report.rows);
    measureTransforms(report.rows);
    reportProgress("codecs");
    measureCodecs(scenes.nativePictures(), "Codecs, on the scenes", quick, report.rows);
    return {};
}

Result<AccuracyReport> measureSubject(const BenchArguments& a) {
    auto runs = AccuracyRuns::open();
    if (!runs) return runs.error();
    AccuracyReport report;
    if (a.program.empty()) {
        if (auto r = measureScenes(*runs, a.quick, report); !r) return r.error();
        for (const std::string& recording : a.recordings) measureRecording(*runs, recording, a.quick, report.rows);
        return report;
    }
    for (const std::string& word : a.program) report.subject += (report.subject.empty() ? "" : " ") + word;
    report.subject += fmt::format(", {} frames", a.frames);
    measureProgram(*runs, a.program, a.frames, a.quick, report.rows);
    return report;
}

// Removes all its folders and ends all its processes before it returns.
Result<AccuracyReport> measure(const BenchArguments& a) {
    auto report = measureSubject(a);
    if (Interruption::signal() != 0) return Error{"the measurement was interrupted; nothing is written"};
    return report;
}

bool write(ResultFile& file, const std::string& text) {
    const auto written = file.write(text);
    if (!written) printError(written.error().message);
    return written.ok();
}

} // namespace

void describeBench(CLI::App& command, BenchArguments& a) {
    command.add_option("WHAT", a.what, "accuracy")->required()->check(CLI::IsMember({"accuracy"}));
    command.add_option("--json", a.json, "also write the results to this file, as JSON")->type_name("FILE");
    command.add_option("--svg", a.svg, "draw the results into this file")->type_name("FILE");
    command.add_flag("--quick", a.quick, "small pictures, and one decomposition of each kind");
    command.add_option("--recording", a.recordings, "also measure this trace (mural run --record); repeatable")
        ->type_name("FILE");
    command.add_option("--frames", a.frames, "with a program after --: minimum number of compared frames")
        ->type_name("N")
        ->check(CLI::Range(int64_t{1}, int64_t{1'000'000}))
        ->capture_default_str();
}

int benchCommand(const BenchArguments& a) {
    if (auto sound = checkSubject(a); !sound) return complain(sound.error());
    std::optional<Interruption> interruption(std::in_place); // before anything is created that must be removed
    auto json = ResultFile::open("--json", a.json);
    if (!json) return complain(json.error());
    auto svg = ResultFile::open("--svg", a.svg);
    if (!svg) return complain(svg.error());
    const auto report = measure(a);
    if (!report) return complain(report.error());
    interruption.reset(); // the remaining work is short, or waits for a reader
    const bool written = write(*json, jsonOf(report.value())) && write(*svg, plotOf(report.value()));
    fmt::print("{}", tableOf(report.value()));
    const int status = report.value().exitStatus();
    return status == 0 && !written ? 1 : status;
}

} // namespace mural::cli
