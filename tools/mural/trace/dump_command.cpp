#include "tools/mural/trace/dump_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <tuple>

#include "nodes/launch/program_check.hpp"
#include "streamcodec/trace/dump/dump.hpp"
#include "tools/mural/console.hpp"
#include "tools/mural/trace/frame_range.hpp"

namespace mural::cli {

namespace {

constexpr const char* kDumpFooter = R"(Examples:
  mural dump app.mural                                     all calls, one per line: frame, program.thread, call
  mural dump app.mural --frames 30-32                      the calls of three frames
  mural dump app.mural --calls 'glTexImage*,Mural.Swap'    selected calls
  mural dump app.mural --summary                           counts and bytes per frame

Frame numbers are those of --out. Calls after the last frame belong to one more, unfinished frame. The names of control
records begin with Mural.; docs/reference/wire-format.md describes them.
Exit status: 0, 2 for a bad argument or an unreadable trace.)";

std::vector<std::string> patternsIn(const std::string& text) {
    std::vector<std::string> parts;
    for (size_t at = 0; at <= text.size();) {
        const size_t end = std::min(text.find(',', at), text.size());
        if (end > at) parts.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return parts;
}

Result<trace::DumpOptions> dumpOptionsFrom(const DumpArguments& a) {
    trace::DumpOptions options;
    options.summary = a.summary;
    if (a.calls) {
        options.calls = patternsIn(*a.calls);
        if (options.calls.empty())
            return Error{"--calls \"" + *a.calls +
                         "\": must be call names, such as glTexImage*,Mural.Swap (see mural dump --help)"};
        const auto unknown = std::ranges::find_if_not(options.calls, trace::fitsSomeCall);
        if (unknown != options.calls.end())
            return Error{"--calls \"" + *unknown +
                         "\": no command matches; mural list-commands lists the GL names, "
                         "docs/reference/wire-format.md the Mural.… names"};
    }
    if (!a.frames) return options;
    const auto range = frameRangeOf(*a.frames);
    if (!range)
        return Error{"--frames \"" + *a.frames +
                     "\": must be N or N-M, counted from 1, such as 30-32 (see mural dump --help)"};
    std::tie(options.firstFrame, options.lastFrame) = *range;
    return options;
}

// Reports requested names without a match, because they may be misspelt.
std::string absentCalls(const DumpArguments& a, const std::vector<std::string>& absent) {
    std::string names;
    for (const std::string& name : absent) names += (names.empty() ? "" : ",") + name;
    return "--calls \"" + names + "\": no such call in " + (a.frames ? "frames " + *a.frames + " of " : "") + a.file;
}

} // namespace

void describeDump(CLI::App& command, DumpArguments& a) {
    command.add_option("FILE", a.file, "trace file of mural run --record")->required();
    command.add_option("--frames", a.frames, "only these frames, counted from 1 (all)")->type_name("N-M");
    command.add_option("--calls", a.calls, "only these calls, separated by commas; * matches any text (all)")
        ->type_name("glA,glB*");
    command.add_flag("--summary", a.summary, "counts and bytes by call, per frame and in total");
    command.footer(kDumpFooter);
}

int dumpCommand(const DumpArguments& a) {
    Console errors(false);
    const auto complain = [&](const Error& error) {
        errors.error(error.message);
        return launch::kExitUsage;
    };
    const auto options = dumpOptionsFrom(a);
    if (!options) return complain(options.error());
    auto opened = trace::TraceReader::open(a.file);
    if (!opened) return complain(opened.error());
    trace::TraceReader& reader = **opened;
    if (a.frames)
        if (const auto there = trace::checkFrames(reader, options.value().lastFrame); !there)
            return complain(there.error());
    if (!reader.notice().empty()) errors.error(reader.notice());
    const auto dumped =
        trace::dump(reader, options.value(), [](const std::string& line) { return std::puts(line.c_str()) >= 0; });
    // main reports output errors.
    if (dumped && (dumped.value().absent.empty() || std::ferror(stdout) != 0)) return 0;
    std::fflush(stdout); // the message follows the calls
    if (!dumped) return complain(dumped.error());
    errors.error(absentCalls(a, dumped.value().absent));
    return 0;
}

} // namespace mural::cli
