#include "tools/mural/accuracy/accuracy_command.hpp"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

#include "nodes/launch/program_check.hpp"
#include "tools/mural/accuracy/accuracy_plot.hpp"
#include "tools/mural/accuracy/accuracy_runs.hpp"
#include "tools/mural/accuracy/accuracy_text.hpp"
#include "tools/mural/accuracy/composition_rows.hpp"
#include "tools/mural/accuracy/program_rows.hpp"
#include "tools/mural/accuracy/recording_rows.hpp"
#include "tools/mural/accuracy/scene_rows.hpp"
#include "tools/mural/accuracy/transform_rows.hpp"

namespace mural::cli {

namespace {

void say(const std::string& what) { fmt::print(stderr, "mural bench accuracy: {}\n", what); }

Result<void> measureScenes(const AccuracyRuns& runs, bool quick, AccuracyReport& report) {
    SceneRows scenes(runs, quick, say);
    if (auto r = scenes.prepare(); !r) return r;
    report.subject = scenes.subject();
    report.gl = scenes.gl();
    scenes.measure(report.rows);
    say("composition");
    measureComposition(report.rows);
    measureTransforms(report.rows);
    say("codecs");
    measureCodecs(scenes.nativePictures(), "Codecs, on the scenes", quick, report.rows);
    return {};
}

Result<AccuracyReport> measure(const BenchArguments& a) {
    auto runs = AccuracyRuns::open();
    if (!runs) return runs.error();
    AccuracyReport report;
    if (a.program.empty()) {
        if (auto r = measureScenes(*runs, a.quick, report); !r) return r.error();
        for (const std::string& recording : a.recordings) measureRecording(*runs, recording, a.quick, say, report.rows);
        return report;
    }
    for (const std::string& word : a.program) report.subject += (report.subject.empty() ? "" : " ") + word;
    report.subject += fmt::format(", {} frames", a.frames);
    measureProgram(*runs, a.program, a.frames, a.quick, say, report.rows);
    return report;
}

bool write(const std::string& path, const std::string& text) {
    if (path.empty()) return true;
    std::ofstream out(path, std::ios::binary | std::ios::trunc);
    out << text;
    out.close();
    if (out) return true;
    say(fmt::format("{} can't be written: {}; name another file", path, std::strerror(errno)));
    return false;
}

} // namespace

void describeBench(CLI::App& command, BenchArguments& a) {
    command.add_option("WHAT", a.what, "accuracy")->required()->check(CLI::IsMember({"accuracy"}));
    command.add_option("--json", a.json, "write what was measured into this file, too")->type_name("FILE");
    command.add_option("--svg", a.svg, "draw what was measured into this file")->type_name("FILE");
    command.add_flag("--quick", a.quick, "small pictures, and one decomposition of each kind");
    command.add_option("--recording", a.recordings, "measure on this recording of a program, too (mural run --record); may be given again")->type_name("FILE")->check(CLI::ExistingFile);
    command.add_option("--frames", a.frames, "of a program after --: at least so many frames are compared")->type_name("N")->check(CLI::Range(int64_t{1}, int64_t{1'000'000}))->capture_default_str();
}

int benchCommand(const BenchArguments& a) {
    const auto report = measure(a);
    if (!report) {
        say(report.error().message);
        return launch::kExitUsage;
    }
    fmt::print("{}", tableOf(report.value()));
    const bool written = write(a.json, jsonOf(report.value())) && write(a.svg, plotOf(report.value()));
    return written && report.value().holds() ? 0 : 1;
}

} // namespace mural::cli
