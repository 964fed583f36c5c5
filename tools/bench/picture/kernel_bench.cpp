#include <bit>
#include <cmath>
#include <dlfcn.h>
#include <fmt/format.h>
#include <functional>
#include <numbers>
#include <random>

#include "compositor/codecs/bitplane/bitplane_codec.hpp"
#include "compositor/image/region_of_interest.hpp"
#include "compositor/image/tile_hash.hpp"
#include "compositor/kernels/average_sums.hpp"
#include "compositor/kernels/blend_over.hpp"
#include "compositor/kernels/interleave_pixels.hpp"
#include "compositor/kernels/mask_channels.hpp"
#include "compositor/kernels/z_select.hpp"
#include "tools/bench/picture/benches.hpp"
#include "tools/bench/picture/paired_times.hpp"

namespace mural::bench {

using namespace compositor;

namespace {

constexpr size_t kColumns = 1920, kRows = 1080, kPixels = kColumns * kRows;

// Operates on two buffers of `sizeBytes`; the speed refers to sourceBytes.
struct Kernel {
    std::string name;
    size_t sizeBytes;
    size_t sourceBytes;
    std::function<void(std::byte*into, uint32_t turn)> fill, fillSource;
    std::function<void(std::byte*into, const std::byte*source)> fast, plain; // plain: scalar version, may be null
};

void fillNoise(std::byte* bytes, size_t sizeBytes, uint32_t seed) {
    std::mt19937 random(seed);
    for (size_t i = 0; i + 4 <= sizeBytes; i += 4) {
        const auto word = static_cast<uint32_t>(random());
        std::memcpy(bytes + i, &word, 4);
    }
}

uint32_t depthWord(DepthFormat format, float z) {
    return format == DepthFormat::D32F ? std::bit_cast<uint32_t>(z) : static_cast<uint32_t>(z * 16777215.0f) << 8;
}

// The first half of the buffer is depth, and the second is colour. The surface is wavy, fills the picture and leans to
// one side. Two surfaces that lean differently intersect in each row. Each is then in front in half of the picture.
enum class Leans { Left, Right };

void fillSurface(std::byte* bytes, DepthFormat format, Leans leans, uint32_t seed) {
    auto* depth = reinterpret_cast<uint32_t*>(bytes);
    const float slope = leans == Leans::Left ? -0.0002f : 0.0002f;
    for (size_t y = 0; y < kRows; ++y) {
        const float along =
            std::sin(4 * std::numbers::pi_v<float> * static_cast<float>(y) / kRows + static_cast<float>(seed));
        for (size_t x = 0; x < kColumns; ++x)
            depth[y * kColumns + x] =
                depthWord(format, 0.5f + 0.2f * along + slope * (static_cast<float>(x) - kColumns / 2.0f));
    }
    fillNoise(bytes + 4 * kPixels, 4 * kPixels, seed + 1);
}

// Random depth per pixel: no vector is uniform.
void fillDepthNoise(std::byte* bytes, DepthFormat format, double covered, uint32_t seed) {
    std::mt19937 random(seed);
    auto* depth = reinterpret_cast<uint32_t*>(bytes);
    for (size_t y = 0; y < kRows; ++y)
        for (size_t x = 0; x < kColumns; ++x) {
            // Covered pixels are clustered, like the pixels of objects.
            const bool isDrawn = static_cast<double>((x / 64 * 7 + y / 64 * 13) % 32) < 32 * covered;
            const float z = isDrawn ? static_cast<float>(random() % 1000) / 1024.0f : 1.0f;
            depth[y * kColumns + x] = depthWord(format, z);
        }
    fillNoise(bytes + 4 * kPixels, 4 * kPixels, seed + 1);
}

void fillLayer(std::byte* bytes, double covered, uint32_t seed) {
    std::mt19937 random(seed);
    for (size_t i = 0; i < kPixels; ++i) {
        const size_t x = i % kColumns, y = i / kColumns;
        const bool isDrawn = static_cast<double>((x / 64 * 7 + y / 64 * 13) % 32) < 32 * covered;
        const uint32_t alpha = isDrawn ? 1 + random() % 255 : 0;
        const uint32_t grey = alpha ? random() % (alpha + 1) : 0;
        const uint32_t word = alpha << 24 | grey << 16 | grey << 8 | grey;
        std::memcpy(bytes + 4 * i, &word, 4);
    }
}

// All rows come from memory; a single repeated row stays in the cache and shows the arithmetic alone.
enum class ZRows { All, First };

Kernel zKernel(const std::string& name, DepthFormat format, bool isNoise, double covered, ZRows rows = ZRows::All) {
    const auto run = [format, rows](std::byte* into, const std::byte* source, auto&& select) {
        ZArea area;
        area.columns = kColumns;
        area.rows = kRows;
        area.depth = reinterpret_cast<uint32_t*>(into);
        area.colour = into + 4 * kPixels;
        area.sourceDepth = reinterpret_cast<const uint32_t*>(source);
        area.sourceColour = source + 4 * kPixels;
        area.depthStride = area.colourStride = area.sourceDepthStride = area.sourceColourStride =
            rows == ZRows::First ? 0 : 4 * kColumns;
        // With LessOrEqual a winner wins again, so repeating one row does the same work.
        select(area, DepthRule{rows == ZRows::First ? DepthFunction::LessOrEqual : DepthFunction::Less, format, true,
                               Coverage::All, 0});
    };
    return {name,
            8 * kPixels,
            8 * kPixels,
            [=](std::byte* into, uint32_t turn) {
                isNoise ? fillDepthNoise(into, format, 1, turn) : fillSurface(into, format, Leans::Left, turn);
            },
            [=](std::byte* source, uint32_t turn) {
                isNoise ? fillDepthNoise(source, format, covered, turn + 7)
                        : fillSurface(source, format, Leans::Right, turn + 7);
            },
            [run](std::byte* into, const std::byte* source) { run(into, source, zSelect); },
            [run](std::byte* into, const std::byte* source) { run(into, source, zSelectScalar); }};
}

// Memory traffic of z compositing when no cache line can be skipped, with minimal arithmetic: reads both depths and
// colours, writes one of each. No kernel moves less for random depths; this row shows the memory bandwidth of a plain
// loop.
void exclusiveOr(std::byte* into, const std::byte* source) {
    auto* const to = reinterpret_cast<uint64_t*>(into);
    const auto* const from = reinterpret_cast<const uint64_t*>(source);
    for (size_t i = 0; i < kPixels; ++i) to[i] ^= from[i];
}

Kernel limitKernel() {
    const auto noise = [](std::byte* bytes, uint32_t turn) { fillNoise(bytes, 8 * kPixels, turn); };
    return {"both read, one written", 8 * kPixels, 8 * kPixels, noise, noise, exclusiveOr, exclusiveOr};
}

Kernel overKernel(const char* name, double covered) {
    return {name,
            4 * kPixels,
            4 * kPixels,
            [](std::byte* into, uint32_t turn) { fillLayer(into, 1, turn); },
            [=](std::byte* source, uint32_t turn) { fillLayer(source, covered, turn + 7); },
            [](std::byte* into, const std::byte* source) {
                blendOverRow(PlaneFormat::Rgba8, into, source, kPixels, SourceSide::InFront);
            },
            [](std::byte* into, const std::byte* source) {
                blendOverRowScalar(PlaneFormat::Rgba8, into, source, kPixels, SourceSide::InFront);
            }};
}

std::vector<Kernel> kernels() {
    const auto noise = [](size_t sizeBytes) {
        return [sizeBytes](std::byte* into, uint32_t turn) { fillNoise(into, sizeBytes, turn); };
    };
    const auto zeros = [](size_t sizeBytes) {
        return [sizeBytes](std::byte* into, uint32_t) { std::memset(into, 0, sizeBytes); };
    };
    const size_t plane = 4 * kPixels;
    ChannelMask cyan{};
    for (size_t i = 0; i < cyan.size(); ++i) cyan[i] = i % 4 ? std::byte{0xff} : std::byte{0};
    std::vector<Kernel> all;
    for (const auto& [format, name] :
         {std::pair{DepthFormat::D32F, std::string("z D32F")}, {DepthFormat::D24S8, "z D24S8"}}) {
        all.push_back(zKernel(name + ", surfaces", format, false, 1));
        all.push_back(zKernel(name + ", noise", format, true, 1));
        all.push_back(zKernel(name + ", 1/4 covered", format, true, 0.25));
        all.push_back(zKernel(name + ", noise, cached", format, true, 1, ZRows::First));
    }
    all.push_back(limitKernel());
    all.push_back(overKernel("over RGBA8, dense", 1));
    all.push_back(overKernel("over RGBA8, 1/4 covered", 0.25));
    all.push_back({"average, add RGBA8", 2 * plane, plane, zeros(2 * plane), noise(plane),
                   [=](std::byte* into, const std::byte* source) {
                       addToSums(reinterpret_cast<uint16_t*>(into), reinterpret_cast<const uint8_t*>(source), plane);
                   },
                   [=](std::byte* into, const std::byte* source) {
                       addToSumsScalar(reinterpret_cast<uint16_t*>(into), reinterpret_cast<const uint8_t*>(source),
                                       plane);
                   }});
    all.push_back({"average, of 16 pictures", 2 * plane, 2 * plane, zeros(2 * plane),
                   [=](std::byte* s, uint32_t turn) {
                       fillNoise(s, 2 * plane, turn);
                       for (size_t i = 1; i < 2 * plane; i += 2) s[i] &= std::byte{7};
                   },
                   [=](std::byte* into, const std::byte* source) {
                       averageOfSums(reinterpret_cast<uint8_t*>(into), reinterpret_cast<const uint16_t*>(source), plane,
                                     16);
                   },
                   [=](std::byte* into, const std::byte* source) {
                       averageOfSumsScalar(reinterpret_cast<uint8_t*>(into), reinterpret_cast<const uint16_t*>(source),
                                           plane, 16);
                   }});
    all.push_back(
        {"colour mask", plane, plane, noise(plane), noise(plane),
         [=](std::byte* into, const std::byte* source) { maskChannelsRow(into, source, plane, cyan); },
         [=](std::byte* into, const std::byte* source) { maskChannelsRowScalar(into, source, plane, cyan); }});
    all.push_back(
        {"pixels, one part of 2x1", plane, plane / 2, noise(plane), noise(plane),
         [](std::byte* into, const std::byte* source) { interleaveRow(into, source, kPixels / 2, 2, 4); },
         [](std::byte* into, const std::byte* source) { interleaveRowScalar(into, source, kPixels / 2, 2, 4); }});
    all.push_back({"pixels, all parts of 2x1", plane, plane, noise(plane), noise(plane),
                   [=](std::byte* into, const std::byte* source) {
                       const std::byte* parts[] = {source, source + plane / 2};
                       interleaveParts(into, parts, kPixels / 2, 2);
                   },
                   [=](std::byte* into, const std::byte* source) {
                       for (size_t k = 0; k < 2; ++k)
                           interleaveRowScalar(into + 4 * k, source + k * plane / 2, kPixels / 2, 2, 4);
                   }});
    return all;
}

// Region of interest and tile hashes, on captured planes.
void benchSearches(const std::vector<NamedPlane>& planes, const BenchOptions& options) {
    fmt::print("\nlooking for what is drawn, and names of tiles, as multiples of memcpy's speed\n");
    for (const NamedPlane& p : planes) {
        if (p.plane.format() != PlaneFormat::Rgba8 && p.plane.format() != PlaneFormat::D24S8) continue;
        const size_t buffers = buffersFor(p.plane.bytes().size(), options.quick);
        std::vector<Plane> sources(buffers, p.plane), targets(buffers, p.plane);
        Background background;
        std::memcpy(background.pixel.data(), p.plane.bytes().data(), 4); // lower left pixel
        std::vector<double> searches, hashes;
        double share = 0;
        for (size_t turn = 0; turn < static_cast<size_t>(options.turns); ++turn) {
            const Plane& source = sources[turn % buffers];
            const double copied = cpuNsOf([&] {
                std::memcpy(targets[turn % buffers].bytes().data(), sources[(turn + 1) % buffers].bytes().data(),
                            source.bytes().size());
            });
            Region found;
            searches.push_back(copied / cpuNsOf([&] { found = findRegionOfInterest(source.view(), background); }));
            share = static_cast<double>(found.area()) / static_cast<double>(source.width()) / source.height();
            TileHash name;
            hashes.push_back(copied / cpuNsOf([&] { name = hashOf(sources[(turn + 2) % buffers].view()); }));
        }
        fmt::print("{:<26} region {:>5.2f} ({:>5.1f} % of it drawn)   name {:>5.2f}\n", p.name, medianOf(searches),
                   100 * share, medianOf(hashes));
    }
}

// Blends an encoded layer over a picture: tile by tile, or after decoding all of it.
void benchFused(const std::vector<NamedPlane>& planes, const BenchOptions& options, Faults& faults) {
    fmt::print("\ndecoding a layer and blending it, as multiples of memcpy's speed: whole planes, and tile by tile\n");
    for (const NamedPlane& p : planes) {
        if (p.plane.format() != PlaneFormat::Rgba8) continue;
        BitplaneCodec codec(bitplane::Predictor::Above);
        const PlaneShape shape = shapeOf(p.plane.view());
        std::vector<std::byte> bytes(codec.boundBytes(shape));
        const auto size = codec.encode(p.plane.view(), bytes);
        if (!size) {
            faults.push_back(p.name + ": " + size.error().message);
            continue;
        }
        bytes.resize(size.value());
        const size_t buffers = buffersFor(shape.sizeBytes(), options.quick);
        std::vector<Plane> pictures(buffers, p.plane), layers(buffers, p.plane);
        std::vector<double> whole, fused;
        for (size_t turn = 0; turn < static_cast<size_t>(options.turns); ++turn) {
            Plane& picture = pictures[turn % buffers];
            Plane& other = pictures[(turn + buffers / 2) % buffers];
            picture = other = p.plane;
            Plane& layer = layers[turn % buffers];
            const double copied = cpuNsOf([&] {
                std::memcpy(layers[(turn + 1) % buffers].bytes().data(),
                            layers[(turn + buffers / 2) % buffers].bytes().data(), shape.sizeBytes());
            });
            bool right = true;
            whole.push_back(copied / cpuNsOf([&] {
                                right &= codec.decode(bytes, layer.view()).ok();
                                for (int32_t y = 0; y < shape.height; ++y)
                                    blendOverRow(shape.format, picture.view().row(y), layer.view().row(y),
                                                 static_cast<size_t>(shape.width), SourceSide::InFront);
                            }));
            fused.push_back(copied / cpuNsOf([&] {
                                right &= codec
                                             .decodeTiles(bytes, shape,
                                                          [&](const PixelViewport& area, const PlaneView& tile) {
                                                              const MutablePlaneView to = other.view().part(area);
                                                              for (int32_t y = 0; y < area.h; ++y)
                                                                  blendOverRow(shape.format, to.row(y), tile.row(y),
                                                                               static_cast<size_t>(area.w),
                                                                               SourceSide::InFront);
                                                          })
                                             .ok();
                            }));
            if (!right || !(picture == other))
                faults.push_back(p.name + ": blending tile by tile gives another picture than blending it whole");
        }
        fmt::print("{:<26} {:>5.2f}   {:>5.2f}\n", p.name, medianOf(whole), medianOf(fused));
    }
}

void benchIcet(const BenchOptions& options, Faults& faults) {
    void* library = dlopen(options.icetLibrary.c_str(), RTLD_NOW | RTLD_LOCAL);
    const auto open = library ? reinterpret_cast<int (*)(int, int)>(dlsym(library, "icet_bench_open")) : nullptr;
    const auto load =
        library ? reinterpret_cast<void (*)(const void*, const void*)>(dlsym(library, "icet_bench_load")) : nullptr;
    const auto blend = library ? reinterpret_cast<void (*)()>(dlsym(library, "icet_bench_blend")) : nullptr;
    const auto blendCompressed =
        library ? reinterpret_cast<void (*)()>(dlsym(library, "icet_bench_blend_compressed")) : nullptr;
    if (!open || !load || !blend || !blendCompressed || !open(kColumns, kRows)) {
        const char* cause = library ? "it lacks a function" : dlerror();
        faults.push_back("IceT: " + options.icetLibrary + " cannot be used: " + (cause ? cause : "") +
                         "; let tools/bench/compositing --icet build it");
        return;
    }
    const size_t plane = 4 * kPixels, buffers = buffersFor(plane, options.quick);
    RotatedBuffers copies(buffers, plane), back(buffers, plane), front(buffers, plane);
    std::vector<double> muralRatios, icetRatios, compressedRatios, gain;
    for (size_t turn = 0; turn < static_cast<size_t>(options.turns); ++turn) {
        fillLayer(back.at(turn).data(), 1, static_cast<uint32_t>(turn));
        fillLayer(front.at(turn).data(), 1, static_cast<uint32_t>(turn + 7));
        load(back.at(turn).data(), front.at(turn).data());
        const double copied = cpuNsOf([&] { std::memcpy(copies.at(turn).data(), copies.at(turn + 1).data(), plane); });
        const double icet = cpuNsOf(blend), compressed = cpuNsOf(blendCompressed);
        const double mural = cpuNsOf([&] {
            blendOverRow(PlaneFormat::Rgba8, back.at(turn).data(), front.at(turn).data(), kPixels, SourceSide::InFront);
        });
        muralRatios.push_back(copied / mural);
        icetRatios.push_back(copied / icet);
        compressedRatios.push_back(copied / compressed);
        gain.push_back(icet / mural);
    }
    fmt::print("\ndense blending of 1920x1080 RGBA8, as multiples of memcpy's speed\nMural {:.2f}   IceT, plain images "
               "{:.2f}   IceT, compressed images {:.2f}   Mural against IceT's plain images {:.2f}\n",
               medianOf(muralRatios), medianOf(icetRatios), medianOf(compressedRatios), medianOf(gain));
}

} // namespace

Faults benchKernels(const std::vector<NamedPlane>& planes, const BenchOptions& options) {
    Faults faults;
    fmt::print(
        "\nkernels, 1920x1080: source bytes per time, as multiples of memcpy of the same bytes (least to most)\n");
    for (const Kernel& k : kernels()) {
        const size_t buffers = options.quick ? 2 : std::min<size_t>(12, buffersFor(k.sizeBytes, false));
        RotatedBuffers into(buffers, k.sizeBytes), source(buffers, k.sizeBytes), copies(buffers, k.sizeBytes);
        for (size_t b = 0; b < buffers; ++b) k.fillSource(source.at(b).data(), static_cast<uint32_t>(b));
        std::vector<double> fast, plain;
        // A kernel runs for milliseconds, in which other memory traffic shows, so it needs more turns than a codec.
        const size_t turns = static_cast<size_t>(options.turns) * (options.quick ? 1 : 4);
        for (size_t turn = 0; turn < turns + 1; ++turn) {
            k.fill(into.at(turn).data(), static_cast<uint32_t>(turn));
            const PixelBytes before = into.at(turn);
            emptyCaches();
            const double copied =
                cpuNsOf([&] { std::memcpy(copies.at(turn).data(), copies.at(turn + 1).data(), k.sourceBytes); });
            emptyCaches();
            const double taken = cpuNsOf([&] { k.fast(into.at(turn).data(), source.at(turn).data()); });
            if (turn > 0) fast.push_back(copied / taken);
            if (turn < 3) {
                PixelBytes expected = before;
                plain.push_back(copied / cpuNsOf([&] { k.plain(expected.data(), source.at(turn).data()); }));
                if (expected != into.at(turn))
                    faults.push_back(k.name + ": vectors and single pixels give different pictures");
            }
        }
        fmt::print("{:<26} {:>5.2f} ({:.2f} to {:.2f})   pixel by pixel {:>5.2f}\n", k.name, medianOf(fast),
                   *std::ranges::min_element(fast), *std::ranges::max_element(fast), medianOf(plain));
    }
    benchFused(planes, options, faults);
    benchSearches(planes, options);
    if (!options.icetLibrary.empty()) benchIcet(options, faults);
    return faults;
}

} // namespace mural::bench
