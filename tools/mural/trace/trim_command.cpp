#include "tools/mural/trace/trim_command.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>

#include "nodes/launch/program_check.hpp"
#include "streamcodec/trace/trim/trim.hpp"
#include "tools/mural/console.hpp"
#include "tools/mural/trace/frame_range.hpp"

namespace mural::cli {

namespace {

constexpr const char* kTrimFooter = R"(Examples:
  mural trim app.mural 30-90 -o part.mural       frames 30 to 90
  mural trim app.mural 47 -o frame.mural         one frame
  mural replay frame.mural --out shots

From earlier frames, the output contains what the first frame needs: objects, state, and draws whose pixels are not
overwritten. Uncertain cases are included.
Exit status: 0, 2 for a bad argument, an unreadable trace, or an output file that cannot be written.)";

} // namespace

void describeTrim(CLI::App& command, TrimArguments& a) {
    command.add_option("FILE", a.file, "trace file of mural run --record")->required();
    command.add_option("FRAMES", a.frames, "N-M, or N alone, counted from 1")->required();
    command.add_option("-o,--out", a.out, "output file")->type_name("FILE")->required();
    command.footer(kTrimFooter);
}

int trimCommand(const TrimArguments& a) {
    Console console(false);
    const auto complain = [&](const std::string& text) {
        console.error(text);
        return launch::kExitUsage;
    };
    const auto range = frameRangeOf(a.frames);
    if (!range)
        return complain("frames \"" + a.frames +
                        "\": must be N or N-M, counted from 1, such as 30-90 (see mural trim --help)");
    auto opened = trace::TraceReader::open(a.file);
    if (!opened) return complain(opened.error().message);
    trace::TraceReader& reader = **opened;
    if (reader.frames() < range->second) return complain(reader.noSuchFrames(reader.frames()).message);
    std::error_code none;
    if (std::filesystem::equivalent(a.file, a.out, none))
        return complain("-o " + a.out + " is the file being trimmed; choose another file");
    if (!reader.notice().empty()) console.error(reader.notice());
    const auto trimmed = trace::trim(reader, range->first, range->second, a.out);
    if (!trimmed) return complain(trimmed.error().message);
    const trace::TrimReport& r = trimmed.value();
    console.say(fmt::format("{} of {} frames in {}, {}; from earlier frames {} of {} records dropped, {} of {} draws",
                            r.frames, reader.frames(), a.out, sizeText(static_cast<double>(r.fileBytes)),
                            r.recordsBefore - r.recordsWritten, r.recordsBefore, r.drawsBefore - r.drawsWritten,
                            r.drawsBefore));
    return 0;
}

} // namespace mural::cli
