// Options of `mural run` for frames in several passes.
#include <fmt/format.h>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "compositor/strategies/strategy.hpp"
#include "nodes/frame_transfer/plane_codecs.hpp"
#include "tools/mural/run/option_choices.hpp"
#include "tools/mural/run/run_option_readers.hpp"

namespace mural::cli {

namespace {

constexpr int kMaxChunks = 4096;
constexpr int kMaxPasses = 256;
constexpr int kMaxKernel = 16;    // columns or rows
constexpr double kMinZoom = 0.01; // one pixel of a hundred remains

// Parses Z, or ZX and ZY.
Result<void> readZoom(const RunArguments& a, Zoom& zoom) {
    if (!a.zoom) return {};
    const size_t x = a.zoom->find('x');
    for (const auto& [text, into] :
         {std::pair(a.zoom->substr(0, x), &zoom.x), {a.zoom->substr(x == std::string::npos ? 0 : x + 1), &zoom.y}}) {
        const auto number = realNumber(text, kMinZoom, kMaxZoom);
        if (!number)
            return badValue(
                "--zoom", *a.zoom,
                fmt::format("must be a number from {} to {}, or two, such as 0.5 or 0.5x1", kMinZoom, kMaxZoom));
        *into = *number;
    }
    return {};
}

Result<void> readBalance(const RunArguments& a, SessionConfig& c) {
    if (auto r = choose("--balance", a.balance, kBalanceChoices, c.balance); !r) return r;
    if (!a.balance || a.config) return {};
    for (const auto& [option, given] :
         {std::pair("--tile-queue", a.tileQueue.has_value()), std::pair("--chunk-queue", a.chunkQueue.has_value())})
        if (given) return Error{fmt::format("{} and --balance both distribute the work; omit one of them", option)};
    return {};
}

} // namespace

Result<void> readPasses(const RunArguments& a, SessionConfig& c) {
    PassCounts& p = c.passes;
    if (auto r = choose("--stereo", a.stereo, kStereoChoices, p.stereo); !r) return r;
    if (auto r = readReal("--eye-base", a.eyeBase, 0, c.eyeBase); !r) return r;
    if (auto r = readReal("--focus", a.focus, 1e-9, c.focusDistance); !r) return r;
    if ((a.eyeBase || a.focus) && p.stereo == StereoMode::Off && !a.config)
        return Error{std::string(a.eyeBase ? "--eye-base" : "--focus") +
                     " requires stereo; add --stereo, such as --stereo anaglyph"};
    if (a.pixel) {
        const auto columns = wholeNumber(*a.pixel, 1, kMaxKernel);
        const auto kernel =
            columns ? std::optional(std::pair(static_cast<int>(*columns), 1)) : pairOf(*a.pixel, 'x', 1, kMaxKernel);
        if (!kernel)
            return badValue(
                "--pixel", *a.pixel,
                fmt::format("must be a number of nodes or COLUMNSxROWS, each from 1 to {}, such as 2x2", kMaxKernel));
        std::tie(p.kernelWidth, p.kernelHeight) = *kernel;
    }
    if (auto r = readCount("--subpixel", a.subpixel, kMaxPasses, p.samples); !r) return r;
    if (auto r = readCount("--dplex", a.dplex, kMaxPasses, p.period); !r) return r;
    if (auto r = readCount("--db", a.db, kMaxPasses, p.ranges); !r) return r;
    if (auto r = readZoom(a, p.zoom); !r) return r;
    if (a.chunkQueue) {
        const auto chunks = wholeNumber(*a.chunkQueue, 2, kMaxChunks);
        if (!chunks)
            return badValue("--chunk-queue", *a.chunkQueue,
                            fmt::format("must be a number of chunks from 2 to {}, such as 64", kMaxChunks));
        if (p.ranges == 1 && !a.config)
            return Error{"--chunk-queue requires sort-last nodes; add --db N, such as --db 4"};
        c.chunks = static_cast<int>(*chunks);
    }
    if (auto r = readBalance(a, c); !r) return r;
    if (a.codec) {
        if (auto wanted = wantedCodec(*a.codec); !wanted)
            return badValue("--codec", *a.codec,
                            "must be auto, lossy or the name of a codec; " + wanted.error().message);
        c.codec = *a.codec;
    }
    if (a.composition) {
        std::string names = "auto";
        for (const compositor::Strategy s : compositor::kEveryStrategy) names += std::string(", ") + nameOf(s);
        if (*a.composition != "auto" && !compositor::strategyNamed(*a.composition))
            return badValue("--composition", *a.composition, "must be one of " + names);
        if (p.ranges == 1 && !a.config)
            return Error{"--composition requires sort-last nodes; add --db N, such as --db 4"};
        c.composition = *a.composition;
    }
    const size_t passes = passesOf(p).size() * static_cast<size_t>(p.ranges);
    if (passes > kMaxPasses)
        return Error{
            fmt::format("--stereo, --pixel, --subpixel, --dplex and --db make {} passes together; the maximum is {}",
                        passes, kMaxPasses)};
    if (passes > 1 && c.tiling == Tiling::Lean)
        return Error{"--tiling lean does not support --stereo, --pixel, --subpixel, --dplex and --db; omit it"};
    if (!p.zoom.none() && c.tiling == Tiling::Lean)
        return Error{"--tiling lean does not support --zoom; omit one of them"};
    if (p.period > 1 && !a.latency) c.latency = p.period; // required for overlapping turns
    return {};
}

} // namespace mural::cli
