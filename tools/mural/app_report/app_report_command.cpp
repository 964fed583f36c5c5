#include "tools/mural/app_report/app_report_command.hpp"

#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <optional>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include "common/json/json_text.hpp"
#include "nodes/launch/program_check.hpp"
#include "tools/mural/app_report/runs/hidden_extensions.hpp"
#include "tools/mural/app_report/judge.hpp"
#include "tools/mural/app_report/output/report_diff.hpp"
#include "tools/mural/app_report/output/report_html.hpp"
#include "tools/mural/app_report/output/report_json.hpp"
#include "tools/mural/app_report/output/report_text.hpp"
#include "tools/mural/child_runs/interruption.hpp"
#include "tools/mural/child_runs/result_file.hpp"
#include "tools/mural/run/option_values.hpp"

namespace mural::cli {

namespace {

constexpr int kDiffers = 1;
constexpr int kMaxSide = 16'384;

int complain(const Error& error) {
    fmt::print(stderr, "mural app-report: {}\n", error.message);
    const int number = Interruption::signal();
    return number != 0 ? 128 + number : launch::kExitUsage;
}

Result<nlohmann::json> readReport(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return Error{"--diff: " + file + " cannot be read; give two files of mural app-report --json"};
    auto json = parseJson(std::string{std::istreambuf_iterator<char>(stream), {}});
    if (json.is_discarded()) return Error{"--diff: " + file + " is no JSON; give two files of mural app-report --json"};
    return json;
}

int compare(const std::vector<std::string>& files) {
    const auto first = readReport(files[0]), second = readReport(files[1]);
    if (!first) return complain(first.error());
    if (!second) return complain(second.error());
    const auto lines = differencesOf(first.value(), second.value());
    if (!lines) return complain(lines.error());
    for (const std::string& line : lines.value()) fmt::print("{}\n", line);
    if (lines.value().empty()) fmt::print("no difference\n");
    return lines.value().empty() ? 0 : kDiffers;
}

// Removes all its folders and ends all its processes before it returns. The page is made before, with its pictures.
Result<AppReport> measure(const AppReportArguments& a, std::string& page) {
    auto runs = AppRuns::open({a.program, a.size, a.seconds, !a.html.empty() && !a.noPictures});
    if (!runs) return runs.error();
    const bool terminal = isatty(STDERR_FILENO) == 1;
    AppMeasured measured = (*runs)->measure([&](const std::string& run) {
        if (terminal) fmt::print(stderr, "mural app-report: {} (at most {:.0f} s) ...\n", run, a.seconds);
    });
    if (Interruption::signal() != 0) return Error{"the report was interrupted; nothing is written"};
    measured.hiddenExtensions = hiddenExtensions();
    AppReport report = makeReport(measured);
    if (!a.html.empty()) page = htmlOf(report);
    return report;
}

} // namespace

const char* const kAppReportFooter =
    R"(Examples:
  mural app-report -- glxgears                            what the program will do on a wall
  mural app-report --seconds 20 --html app.html -- app    the same as a page with two small pictures
  mural app-report --json new.json -- app                 for programs, and for --diff
  mural app-report --diff old.json new.json               facts that have changed

The program runs up to four times on a private display: without Mural, in 2x2 tiles with a comparison of every pixel,
with parts that move, and with shared draws. Each run ends after --seconds.
Exit status: 0 works, exact; 1 works, with differences (--diff: the reports differ); 2 it does not run on a wall, or a
bad argument.)";

void describeAppReport(CLI::App& command, AppReportArguments& a) {
    command.add_option("--seconds", a.seconds, "longest duration of each of the four runs (10)")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.5, 3600.0));
    command.add_option("--size", a.size, "size of the wall, as for mural run (the program's own)")->type_name("WxH");
    command.add_option("--json", a.json, "also write the report into this file, as JSON")->type_name("FILE");
    command.add_option("--html", a.html, "also write the report into this file, as one page")->type_name("FILE");
    command.add_flag("--no-pictures", a.noPictures, "no pictures in the page");
    command.add_option("--diff", a.diff, "compare two reports of --json, and run nothing")
        ->type_name("A B")
        ->expected(2);
}

int appReportCommand(const AppReportArguments& a) {
    if (!a.diff.empty() && !a.program.empty()) return complain(Error{"--diff compares reports; omit the program"});
    if (!a.diff.empty()) return compare(a.diff);
    if (a.program.empty()) return complain(Error{"a program is required, such as mural app-report -- glxgears"});
    if (!a.size.empty() && !pairOf(a.size, 'x', 1, kMaxSide))
        return complain(Error{"--size \"" + a.size + "\": must be WIDTHxHEIGHT in pixels, such as 1920x1080"});
    std::optional<Interruption> interruption(std::in_place); // before anything is created that must be removed
    auto json = ResultFile::open("--json", a.json);
    if (!json) return complain(json.error());
    auto html = ResultFile::open("--html", a.html);
    if (!html) return complain(html.error());
    std::string page;
    const auto report = measure(a, page);
    if (!report) return complain(report.error());
    interruption.reset(); // the remaining work is short, or waits for a reader
    fmt::print("{}", textOf(report.value()));
    for (auto [file, text] :
         {std::pair{&json.value(), jsonText(jsonOf(report.value()), 2) + "\n"}, std::pair{&html.value(), page}})
        if (const auto written = file->write(text); !written) return complain(written.error());
    return exitStatusOf(report.value().verdict);
}

} // namespace mural::cli
