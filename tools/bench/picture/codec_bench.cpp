#include <cmath>
#include <fmt/format.h>
#include <map>

#include "compositor/codecs/registry.hpp"
#include "tools/bench/picture/benches.hpp"
#include "tools/bench/picture/paired_times.hpp"

namespace mural::bench {

using namespace compositor;

namespace {

constexpr const char* kColourCodecs[] = {"raw",           "rle64", "rle-components", "rle-swizzled", "bitplane",
                                         "bitplane-zstd", "lz4",   "zstd",           "yuv420",       "jpeg-95"};
constexpr const char* kDepthCodecs[] = {
    "raw", "rle64", "rle-components", "rle-swizzled", "bitplane", "slope", "slope-zstd", "lz4", "zstd"};
// Goal for compression ratios: bit planes relative to swizzled run lengths.
constexpr double kRatioGoal = 1.5;

struct Measured {
    double ratio, encode, decode; // the last two relative to memcpy
    double worst;                 // lossy codecs: largest difference of a component
};

Result<Measured> measure(Codec& codec, const Plane& plane, const BenchOptions& options, bool slow) {
    const PlaneShape shape = shapeOf(plane.view());
    const size_t sizeBytes = plane.bytes().size();
    const size_t buffers = slow ? 3 : buffersFor(sizeBytes, options.quick);
    RotatedBuffers encoded(std::min<size_t>(buffers, 4), codec.boundBytes(shape));
    std::vector<Plane> sources(buffers, plane), targets(buffers, plane);
    std::vector<double> encodes, decodes;
    size_t size = 0;
    const auto turns = static_cast<size_t>(slow ? 3 : options.turns);
    for (size_t turn = 0; turn < turns + 1; ++turn) { // the first turn warms up
        Plane& source = sources[turn % buffers];
        Plane& target = targets[turn % buffers];
        Plane& other = targets[(turn + buffers / 2) % buffers];
        const double copied = cpuNsOf([&] {
            std::memcpy(other.bytes().data(), sources[(turn + buffers / 2) % buffers].bytes().data(), sizeBytes);
        });
        Result<size_t> written = size_t{0};
        const double encode = cpuNsOf([&] { written = codec.encode(source.view(), encoded.at(turn)); });
        if (!written) return written.error();
        size = *written;
        Result<void> read;
        const double decode =
            cpuNsOf([&] { read = codec.decode(std::span(encoded.at(turn)).first(size), target.view()); });
        if (!read) return read.error();
        if (turn == 0) continue;
        encodes.push_back(copied / encode);
        decodes.push_back(copied / decode);
    }
    double worst = 0;
    for (size_t i = 0; i < sizeBytes; ++i)
        worst = std::max(worst, std::abs(1.0 * std::to_integer<int>(targets[turns % buffers].bytes()[i]) -
                                         std::to_integer<int>(plane.bytes()[i])));
    return Measured{static_cast<double>(sizeBytes) / static_cast<double>(size), medianOf(encodes), medianOf(decodes),
                    worst};
}

struct Sum {
    double logRatio = 0;
    std::vector<double> encodes, decodes;
    [[nodiscard]] double ratio() const { return std::exp(logRatio / static_cast<double>(encodes.size())); }
};

std::string spread(const std::vector<double>& values) {
    const auto [low, high] = std::ranges::minmax_element(values);
    return fmt::format("{:.2f} [{:.2f} to {:.2f}]", medianOf(values), *low, *high);
}

} // namespace

Faults benchCodecs(const std::vector<NamedPlane>& planes, const BenchOptions& options) {
    Faults faults;
    CodecRegistry registry;
    for (const PlaneFormat format : {PlaneFormat::Rgba8, PlaneFormat::D24S8, PlaneFormat::D32F}) {
        const std::vector<std::string> names =
            isDepth(format) ? std::vector<std::string>(std::begin(kDepthCodecs), std::end(kDepthCodecs))
                            : std::vector<std::string>(std::begin(kColourCodecs), std::end(kColourCodecs));
        std::map<std::string, Sum> sums;
        std::string rows;
        for (const NamedPlane& p : planes) {
            if (p.plane.format() != format) continue;
            std::string row = fmt::format("{:<22}", p.name);
            for (const std::string& name : names) {
                auto codec = registry.make(name);
                const bool lossless = registry.find(name).value().lossless;
                auto m = codec ? measure(**codec, p.plane, options, name.starts_with("rle-") || !lossless)
                               : Result<Measured>(codec.error());
                if (!m) {
                    faults.push_back(p.name + ": " + m.error().message);
                    continue;
                }
                if (lossless && m->worst != 0)
                    faults.push_back(fmt::format("{}: codec {} does not give back the picture: it differs by up to {}",
                                                 p.name, name, m->worst));
                Sum& sum = sums[name];
                sum.logRatio += std::log(m->ratio);
                sum.encodes.push_back(m->encode);
                sum.decodes.push_back(m->decode);
                row += fmt::format(" {:>20}", fmt::format("{:.2f} / {:.2f} / {:.2f}", m->ratio, m->encode, m->decode));
            }
            rows += row + "\n";
        }
        if (sums.empty()) continue;
        fmt::print("\n{}: ratio, encoding and decoding as multiples of memcpy's speed, one thread\n{:<22}",
                   nameOf(format), "");
        for (const std::string& name : names) fmt::print(" {:>20}", name);
        fmt::print("\n{}\n{}, all together: geometric mean of the ratio, median of the speeds [least to most]\n", rows,
                   nameOf(format));
        for (const std::string& name : names)
            fmt::print("{:<16} {:>8.2f}   {:<24} {}\n", name, sums[name].ratio(), spread(sums[name].encodes),
                       spread(sums[name].decodes));
        const char* muralCodec = isDepth(format) ? "slope" : "bitplane";
        const double better = sums[muralCodec].ratio() / sums["rle-swizzled"].ratio();
        fmt::print("{} has {:.2f} times the ratio of rle-swizzled\n", muralCodec, better);
        if (!options.quick && better < kRatioGoal)
            faults.push_back(fmt::format("{}: the ratio of {} is only {:.2f} times that of rle-swizzled, and not {}",
                                         nameOf(format), muralCodec, better, kRatioGoal));
    }
    return faults;
}

} // namespace mural::bench
