#include "tools/mural/run/run_options.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "tools/mural/run/option_choices.hpp"
#include "tools/mural/run/run_option_readers.hpp"

namespace mural::cli {

namespace {

Result<void> readGpus(const RunArguments& a, SessionConfig& c) {
    if (!a.gpus) return {};
    c.gpus = listOf(*a.gpus);
    const auto isWord = [](const std::string& name) { return name == "auto" || name == "first"; };
    const bool isMixed = c.gpus.size() > 1 && std::ranges::any_of(c.gpus, isWord);
    if (isMixed || std::ranges::any_of(c.gpus, &std::string::empty))
        return badValue("--gpus", *a.gpus, "must be auto, first, or names of GPUs with commas between them");
    if (!isWord(c.gpus.front()) && c.glBackend != "auto" && c.glBackend != "egl")
        return Error{"--gpus " + *a.gpus + " needs EGL; omit --gl " + c.glBackend};
    return {};
}

Result<void> readChoices(const RunArguments& a, SessionConfig& c) {
    const char* backend = "auto";
    if (auto r = choose("--display", a.display, kDisplayChoices, c.display); !r) return r;
    if (auto r = choose("--tiling", a.tiling, kTilingChoices, c.tiling); !r) return r;
    if (auto r = choose("--culling", a.culling, kCullingChoices, c.culling); !r) return r;
    if (auto r = choose("--local-rendering", a.localRendering, kLocalRenderingChoices, c.localRendering); !r) return r;
    if (auto r = choose("--gl", a.gl, kGlChoices, backend); !r) return r;
    if (auto r = choose("--delta", a.delta, kDeltaChoices, c.delta); !r) return r;
    if (auto r = choose("--readback", a.readback, kReadbackChoices, c.readback); !r) return r;
    c.glBackend = backend;
    return readGpus(a, c);
}

Result<void> checkTogether(const RunArguments& a, const SessionConfig& c) {
    if ((a.fullScreen || a.position || a.windowInput) && c.display != Display::Windows) {
        const char* const option = a.fullScreen ? "--fullscreen" : a.position ? "--position" : "--window-input";
        return Error{std::string(option) + " requires wall windows; add --display windows"};
    }
    if (a.native && (a.out.has_value() || a.record.has_value() || a.frameTimes.has_value() || c.verifyEvery > 0)) {
        return Error{std::string(c.verifyEvery > 0 ? "--verify"
                                 : a.out           ? "--out"
                                 : a.record        ? "--record"
                                                   : "--frame-times") +
                     " requires captured frames; omit --native"};
    }
    if (c.width > 0 && (c.columns > c.width || c.rows > c.height)) {
        return Error{fmt::format("{}x{} tiles do not fit in {}x{} pixels; give fewer tiles", c.columns, c.rows, c.width,
                                 c.height)};
    }
    return {};
}

} // namespace

Result<RunOptions> runOptionsFrom(const RunArguments& a) {
    RunOptions options;
    SessionConfig& c = options.config;
    if (auto r = readChoices(a, c); !r) return r.error();
    if (auto r = readSizes(a, c); !r) return r.error();
    if (auto r = readNumber("--frames", a.frames, 1, INT64_MAX, c.frames); !r) return r.error();
    int64_t latency = c.latency;
    if (auto r = readNumber("--latency", a.latency, 0, kMaxLatency, latency); !r) return r.error();
    c.latency = static_cast<int>(latency);
    if (auto r = readPasses(a, c); !r) return r.error();
    auto choice = readLaunch(a, launch::Environment::current(), c);
    if (!choice) return choice.error();
    options.launchChoice = std::move(*choice);
    if (auto r = readNodes(a, c); !r) return r.error();
    if (auto r = readConfigFile(a, options); !r) return r.error();
    int64_t verify = 0;
    if (auto r = readNumber("--verify", a.verify.empty() ? OptionText() : a.verify, 1, INT32_MAX, verify); !r)
        return r.error();
    c.verifyEvery = static_cast<int>(verify);
    if (verify > 0 && (c.passes.stereo != StereoMode::Off || c.passes.samples > 1 || !c.passes.zoom.none()))
        return Error{"--verify compares with the program's own picture, which --stereo, --subpixel and --zoom change; "
                     "omit one of them"};
    if (auto r = readOutput(a, c); !r) return r.error();
    if (auto r = checkTogether(a, c); !r) return r.error();
    c.fullScreen = a.fullScreen;
    c.placeThreads = !a.noPlacement;
    c.explain = a.explain;
    if (auto r = choose("--capture-via", a.captureVia, kEntryChoices, options.captureVia); !r) return r.error();
    options.displayChosen = a.display.has_value();
    options.native = a.native;
    options.quiet = a.quiet;
    if (a.report && a.report->empty()) return badValue("--report", "", "must be a file, such as --report report.json");
    options.reportFile = a.report.value_or("");
    if (a.native && !a.sends.empty()) return Error{"--send sends the pictures of a wall; omit --native"};
    if (a.native && !a.page.empty()) return Error{"--page shows a wall; omit --native"};
    options.page = a.page;
    options.program = a.program;
    if (a.printConfig) {
        auto text = configTextOf(a, c);
        if (!text) return text.error();
        options.configText = std::move(*text);
        return options;
    }
    if (options.program.empty())
        return Error{"no program given; add it after --, such as: mural run --tiles 2x2 -- glxgears"};
    return options;
}

} // namespace mural::cli
