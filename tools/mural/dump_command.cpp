#include "tools/mural/dump_command.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "nodes/launch/program_check.hpp"
#include "recording/dump/dump.hpp"
#include "tools/mural/console.hpp"
#include "tools/mural/frame_range.hpp"

namespace mural::cli {

namespace {

constexpr const char* kDumpFooter = R"(Examples:
  mural dump app.mural                                     all calls, one per line: frame, program.thread, call
  mural dump app.mural --frames 30-32                      those of three frames
  mural dump app.mural --calls 'glTexImage*,Mural.Swap'    some of them
  mural dump app.mural --summary                           how many of each in each frame, and their bytes

Frames are counted as --out counts them. Records of Mural itself are called Mural.…; docs/wire-format.md describes them.
Exit status: 0, 2 for a bad argument or a recording that can't be read.)";

std::vector<std::string> patternsIn(const std::string& text) {
    std::vector<std::string> parts;
    for (size_t at = 0; at <= text.size();) {
        const size_t end = std::min(text.find(',', at), text.size());
        if (end > at) parts.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return parts;
}

} // namespace

void describeDump(CLI::App& command, DumpArguments& a) {
    command.add_option("FILE", a.file, "recording, made by mural run --record")->required();
    command.add_option("--frames", a.frames, "these frames, counted from 1 (all)")->type_name("N-M");
    command.add_option("--calls", a.calls, "these calls, separated by commas; * stands for anything (all)")->type_name("glA,glB*");
    command.add_flag("--summary", a.summary, "counts and bytes by call, for each frame and for all");
    command.footer(kDumpFooter);
}

int dumpCommand(const DumpArguments& a) {
    Console errors(false);
    recording::DumpOptions options;
    options.summary = a.summary;
    if (a.calls) options.calls = patternsIn(*a.calls);
    if (a.frames) {
        const auto range = frameRangeOf(*a.frames);
        if (!range) {
            errors.error("--frames \"" + *a.frames + "\": must be N or N-M, counted from 1, such as 30-32 (see mural dump --help)");
            return launch::kExitUsage;
        }
        std::tie(options.firstFrame, options.lastFrame) = *range;
    }
    auto reader = recording::FileReader::open(a.file);
    if (!reader) {
        errors.error(reader.error().message);
        return launch::kExitUsage;
    }
    if (!reader.value()->notice().empty()) errors.error(reader.value()->notice());
    const auto dumped = recording::dump(**reader, options, [](const std::string& line) { return std::puts(line.c_str()) >= 0; });
    std::fflush(stdout);
    if (dumped) return 0;
    errors.error(dumped.error().message);
    return launch::kExitUsage;
}

} // namespace mural::cli
