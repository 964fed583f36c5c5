#include "tools/mural/config/config_command.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

#include "balancer/compound/active_layouts.hpp"
#include "balancer/compound/even_split.hpp"
#include "balancer/compound/load_config.hpp"
#include "balancer/compound/plan_frame.hpp"
#include "balancer/config/eqc/writer.hpp"
#include "balancer/svg/config_drawing.hpp"
#include "common/base/result.hpp"
#include "nodes/head/planning/unsupported_fields.hpp"
#include "nodes/launch/program_check.hpp"
#include "tools/mural/config/config_summary.hpp"
#include "tools/mural/config/plan_text.hpp"

namespace mural::cli {

namespace {

using compound::LoadedConfig;

constexpr size_t kMaxWarnings = 10; // keeps errors visible, because a file of another format causes a warning per word

void printDiagnostics(const LoadedConfig& loaded, std::FILE* where) {
    const auto isError = [](const config::Diagnostic& d) { return d.severity == config::Severity::Error; };
    const bool wrong = std::ranges::any_of(loaded.diagnostics.all(), isError);
    size_t warnings = 0;
    for (const config::Diagnostic& d : loaded.diagnostics.all()) {
        if (!isError(d) && ++warnings > kMaxWarnings && wrong) continue;
        fmt::print(where, "{}{}\n",
                   d.severity == config::Severity::Error ? "error: " : "warning: ", loaded.diagnostics.text(d));
    }
    if (wrong && warnings > kMaxWarnings)
        fmt::print(where, "note: {} more warnings are not shown; fix these first\n", warnings - kMaxWarnings);
}

// Returns an option that does not apply to the requested output; empty: none.
std::string unusedOption(const ConfigArguments& a) {
    if (a.resolved && a.verb != "print") return "--resolved requires print";
    if (!a.resolved && (a.frame >= 0 || !a.layout.empty() || !a.stereo.empty()))
        return "--frame, --layout and --stereo require print --resolved";
    if (a.verb == "check" && !a.out.empty()) return "--out requires print or draw";
    return {};
}

int check(const LoadedConfig& loaded) {
    printDiagnostics(loaded, stdout);
    if (loaded.ok()) {
        for (const std::string& line : summaryOf(loaded)) fmt::print("{}\n", line);
    }
    for (const std::string& line : fieldsWithoutEffect(loaded.diagnostics)) fmt::print("note: {}\n", line);
    const auto warnings = loaded.diagnostics.all().size() -
                          std::min(loaded.diagnostics.all().size(), static_cast<size_t>(loaded.diagnostics.errors()));
    fmt::print("{}: {} error{}, {} warning{}\n", loaded.diagnostics.file(), loaded.diagnostics.errors(),
               loaded.diagnostics.errors() == 1 ? "" : "s", warnings, warnings == 1 ? "" : "s");
    return loaded.ok() ? 0 : launch::kExitUsage;
}

Result<std::string> resolvedText(const LoadedConfig& loaded, const ConfigArguments& a) {
    compound::FrameInput input = compound::firstFrame(loaded.resolved);
    input.frameNumber = static_cast<uint64_t>(std::max<int64_t>(a.frame, 0));
    if (!a.layout.empty() && !compound::activateLayout(loaded.resolved, a.layout, input)) {
        return Error{"no canvas has a layout " + a.layout +
                     "; choose a name that mural config draw shows, or its number"};
    }
    if (!a.stereo.empty())
        input.views.assign(loaded.resolved.views.size(),
                           {a.stereo == "on" ? config::ViewMode::Stereo : config::ViewMode::Mono, 1, {}});
    return planText(loaded.resolved, compound::planFrame(loaded.resolved, input));
}

Result<std::string> outputOf(const LoadedConfig& loaded, const ConfigArguments& a) {
    if (a.verb == "draw") {
        const std::string name = a.file.substr(a.file.find_last_of('/') + 1);
        return drawing::drawConfig(loaded.resolved,
                                   loaded.resolved.name.empty() ? name : loaded.resolved.name + " (" + name + ")",
                                   loaded.file.heading);
    }
    return a.resolved ? resolvedText(loaded, a) : config::writeConfig(loaded.file);
}

int write(const std::string& text, const std::string& path) {
    if (path.empty()) {
        fmt::print("{}", text);
        return std::fflush(stdout) == 0 ? 0 : 1;
    }
    std::ofstream out(path, std::ios::binary | std::ios::trunc);
    out << text;
    out.close();
    if (out) return 0;
    fmt::print(stderr, "mural config: {} cannot be written: {}; choose another file with --out\n", path,
               std::strerror(errno));
    return 1;
}

} // namespace

void describeConfig(CLI::App& command, ConfigArguments& a) {
    command.add_option("VERB", a.verb, "check, print or draw")
        ->required()
        ->check(CLI::IsMember({"check", "print", "draw"}));
    command.add_option("FILE", a.file, "the configuration, in Equalizer's format (.eqc)")->required();
    command.add_flag("--strict", a.strict, "treat warnings as errors");
    command.add_option("--out", a.out, "print, draw: write to this file instead of standard output")->type_name("FILE");
    command.add_flag("--resolved", a.resolved,
                     "print: the tasks and contexts of every channel in a frame, instead of the configuration");
    command.add_option("--frame", a.frame, "with --resolved: frame number (0)")
        ->type_name("NUMBER")
        ->check(CLI::Range(int64_t{0}, INT64_MAX, "NUMBER, at least 0"));
    command.add_option("--layout", a.layout, "with --resolved: the layout to show, by name or number")
        ->type_name("NAME");
    command.add_option("--stereo", a.stereo, "with --resolved: on or off (as each view defines)")
        ->check(CLI::IsMember({"on", "off"}));
}

int configCommand(const ConfigArguments& a) {
    if (const std::string unused = unusedOption(a); !unused.empty()) {
        fmt::print(stderr, "mural config: {} (see mural config --help)\n", unused);
        return launch::kExitUsage;
    }
    const LoadedConfig loaded = compound::loadConfig(a.file, compound::processEnvironment, a.strict);
    if (a.verb == "check") return check(loaded);
    printDiagnostics(loaded, stderr);
    if (!loaded.ok()) return launch::kExitUsage;
    const auto text = outputOf(loaded, a);
    if (!text) {
        fmt::print(stderr, "mural config: {}\n", text.error().message);
        return launch::kExitUsage;
    }
    return write(text.value(), a.out);
}

} // namespace mural::cli
