#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <random>

#include "compositor/codecs/registry.hpp"
#include "compositor/selection/codec_selector.hpp"
#include "tools/bench/picture/benches.hpp"
#include "tools/bench/picture/paired_times.hpp"

namespace mural::bench {

using namespace compositor;

namespace {

// Candidates of the selector, in order of trial.
const std::vector<std::string> kChoices = {"bitplane", "slope", "raw", "bitplane-zstd", "slope-zstd", "lz4", "zstd"};
constexpr double kGbitPerSec[] = {0.1, 1, 10, 25, 100};
constexpr int32_t kPieceColumns = 512, kPieceRows = 256;
constexpr int kSamples = 3; // time measurements per piece; each run uses one
constexpr int kFramesOfScene = 30;
constexpr unsigned kOrders = 8; // orders of scenes: earlier scenes help or mislead

// Measured result of a codec for a piece.
struct Outcome {
    double bytes = 0;
    double encodeNs[kSamples] = {};
    double decodeNs[kSamples] = {};
};
struct Piece {
    TileClass tile;
    uint64_t rawBytes = 0;
    std::vector<Outcome> outcomes; // parallel to kChoices
};
using Scene = std::vector<Piece>;

Result<Scene> measureScene(const Plane& plane, std::vector<std::unique_ptr<Codec>>& codecs) {
    Scene scene;
    std::vector<std::byte> bytes;
    for (int32_t y = 0; y < plane.height(); y += kPieceRows)
        for (int32_t x = 0; x < plane.width(); x += kPieceColumns) {
            const PlaneView part = plane.view().part(
                {x, y, std::min(kPieceColumns, plane.width() - x), std::min(kPieceRows, plane.height() - y)});
            Piece piece{classify(part), part.sizeBytes(), {}};
            Plane target(part.format, part.width, part.height);
            for (auto& codec : codecs) {
                Outcome o;
                bytes.resize(std::max(bytes.size(), codec->boundBytes(shapeOf(part))));
                for (int sample = -1; sample < kSamples; ++sample) { // the first sample warms up
                    Result<size_t> size = size_t{0};
                    const double encode = cpuNsOf([&] { size = codec->encode(part, bytes); });
                    if (!size) return size.error();
                    Result<void> decoded;
                    const double decode =
                        cpuNsOf([&] { decoded = codec->decode(std::span(bytes).first(*size), target.view()); });
                    if (!decoded) return decoded.error();
                    o.bytes = static_cast<double>(*size);
                    if (sample < 0) continue;
                    o.encodeNs[sample] = encode;
                    o.decodeNs[sample] = decode;
                }
                piece.outcomes.push_back(o);
            }
            scene.push_back(std::move(piece));
        }
    return scene;
}

double timeNs(const Outcome& o, int sample, double bytesPerSec, Overlap overlap) {
    const double transfer = o.bytes * 1e9 / bytesPerSec;
    return overlap == Overlap::Serial ? o.encodeNs[sample] + o.decodeNs[sample] + transfer
                                      : std::max({o.encodeNs[sample], o.decodeNs[sample], transfer});
}

struct Race {
    double selected = 0;                                             // total time
    std::vector<double> each = std::vector<double>(kChoices.size()); // of each codec alone
    double perScene = 0;                                             // of the best codec per scene
    double perPiece = 0;                                             // of the best codec per piece, an oracle
};

// Sends all scenes over one link: the selector against each codec alone.
Race run(const std::vector<Scene>& scenes, double bytesPerSec, Overlap overlap) {
    Race race;
    CodecSelector selector(kChoices, {.overlap = overlap});
    for (const Scene& scene : scenes) {
        std::vector<double> sceneEach(kChoices.size());
        for (int frame = 0; frame < kFramesOfScene; ++frame)
            for (size_t p = 0; p < scene.size(); ++p) {
                const Piece& piece = scene[p];
                const int sample = (frame + static_cast<int>(p)) % kSamples;
                const CodecSelector::Choice choice = selector.choose(piece.tile, piece.rawBytes);
                const size_t c = choice.codec;
                const Outcome& o = piece.outcomes[c];
                race.selected += timeNs(o, sample, bytesPerSec, overlap);
                selector.encoded(piece.tile, c, piece.rawBytes, static_cast<uint64_t>(o.bytes),
                                 static_cast<int64_t>(o.encodeNs[sample]));
                if (choice.measure) { // not hidden by other work
                    const Outcome& other = piece.outcomes[*choice.measure];
                    race.selected += other.encodeNs[sample] + other.decodeNs[sample];
                    selector.measured(piece.tile, *choice.measure, piece.rawBytes, static_cast<uint64_t>(other.bytes),
                                      static_cast<int64_t>(other.encodeNs[sample]),
                                      static_cast<int64_t>(other.decodeNs[sample]));
                }
                selector.decoded(piece.tile, c, piece.rawBytes, static_cast<int64_t>(o.decodeNs[sample]));
                selector.transferred(static_cast<uint64_t>(o.bytes),
                                     std::max<int64_t>(1, static_cast<int64_t>(o.bytes * 1e9 / bytesPerSec)));
                double best = std::numeric_limits<double>::max();
                for (size_t i = 0; i < kChoices.size(); ++i) {
                    const double t = timeNs(piece.outcomes[i], sample, bytesPerSec, overlap);
                    sceneEach[i] += t;
                    best = std::min(best, t);
                }
                race.perPiece += best;
            }
        race.perScene += *std::ranges::min_element(sceneEach);
        for (size_t i = 0; i < kChoices.size(); ++i) race.each[i] += sceneEach[i];
    }
    return race;
}

double worstOfOrders(std::vector<Scene> scenes, double bytesPerSec, Overlap overlap) {
    double worst = 0;
    for (unsigned order = 0; order < kOrders; ++order) {
        const Race r = run(scenes, bytesPerSec, overlap);
        worst = std::max(worst, r.selected / *std::ranges::min_element(r.each));
        std::shuffle(scenes.begin(), scenes.end(), std::mt19937(order + 1));
    }
    return worst;
}

} // namespace

Faults benchSelector(const std::vector<NamedPlane>& planes, const BenchOptions&) {
    CodecRegistry registry;
    std::vector<std::unique_ptr<Codec>> codecs;
    for (const std::string& name : kChoices) {
        auto codec = registry.make(name);
        if (!codec) return {codec.error().message};
        codecs.push_back(std::move(*codec));
    }
    for (const PlaneFormat format : {PlaneFormat::Rgba8, PlaneFormat::D24S8}) {
        std::vector<Scene> scenes;
        for (const NamedPlane& p : planes) {
            if (p.plane.format() != format) continue;
            auto scene = measureScene(p.plane, codecs);
            if (!scene) return {scene.error().message};
            scenes.push_back(std::move(*scene));
        }
        if (scenes.empty()) continue;
        fmt::print("\nselector, {}: {} scenes of {} frames one after the other, in pieces of {}x{}; codecs are "
                   "measured, the link is reckoned\n",
                   nameOf(format), scenes.size(), kFramesOfScene, kPieceColumns, kPieceRows);
        fmt::print("{:<22} {:<28} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "", "best alone", "all", "worst", "scene",
                   "piece", "raw");
        for (const Overlap overlap : {Overlap::Serial, Overlap::Pipelined})
            for (const double gbit : kGbitPerSec) {
                const Race r = run(scenes, gbit * 1e9 / 8, overlap);
                const auto best = std::ranges::min_element(r.each);
                const double worst = worstOfOrders(scenes, gbit * 1e9 / 8, overlap);
                const std::string& name = kChoices[static_cast<size_t>(best - r.each.begin())];
                fmt::print("{:<22} {:<28} {:>10.3f} {:>10.3f} {:>10.3f} {:>10.3f} {:>10.2f}\n",
                           fmt::format("{:>5} Gbit/s, {}", gbit, overlap == Overlap::Serial ? "serial" : "pipelined"),
                           name, r.selected / *best, worst, r.selected / r.perScene, r.selected / r.perPiece,
                           r.selected / r.each[2]);
            }
        fmt::print("time of the selector's choices over that of the codec that is the best one alone, known "
                   "afterwards: for all scenes, the\nworst of {} orders of them, for each scene, for each piece; and "
                   "over that of raw pieces\n",
                   kOrders);
    }
    return {};
}

} // namespace mural::bench
