// Writes the corpus of the codecs' fuzz targets, one folder each. Usage: codec_fuzz_seeds FOLDER
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "compositor/codecs/registry.hpp"
#include "compositor/codecs/tile_delta.hpp"
#include "tests/compositor/test_planes.hpp"

namespace mural::fuzz {
namespace {

using namespace compositor;
using namespace compositor::test;
using Bytes = std::vector<std::byte>;

Bytes headOf(const PlaneShape& s) {
    return {static_cast<std::byte>(s.format), static_cast<std::byte>((s.width - 1) & 0xff),
            static_cast<std::byte>((s.width - 1) >> 8), static_cast<std::byte>(s.height - 1)};
}

void save(const std::filesystem::path& folder, const std::string& name, const Bytes& bytes) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

const char* nameOf(Content c) {
    constexpr const char* kNames[] = {"noise", "uniform", "surface", "sparse", "rows", "mixed"};
    return kNames[static_cast<size_t>(c)];
}

void codec(const std::filesystem::path& folder, CodecRegistry& registry, const std::string& name) {
    auto made = registry.make(name);
    const CodecInfo info = registry.find(name).value();
    std::mt19937 random(1);
    const bool ownFormats = name == "bitplane" || name == "slope"; // the others ignore the meaning of a word
    for (const PlaneFormat format : kEveryFormat) {
        if (!info.takes(format) || (!ownFormats && format != PlaneFormat::Rgba8 && format != PlaneFormat::D24S8))
            continue;
        for (const Content content : kEveryContent) {
            // Small planes of every kind. For RGBA8 and depth, also one with several tiles, where it stays small.
            const bool large =
                content == Content::Uniform && (format == PlaneFormat::Rgba8 || format == PlaneFormat::D24S8);
            Plane plane = makePlane(random, format, content, large ? 300 : 21, large ? 70 : 6);
            if (large) plane.view().row(40)[4 * 270] ^= std::byte{7};
            Bytes bytes((*made)->boundBytes(shapeOf(plane.view())));
            bytes.resize((*made)->encode(plane.view(), bytes).value());
            if (bytes.size() > 4096) continue;
            Bytes input = headOf(shapeOf(plane.view()));
            input.insert(input.end(), bytes.begin(), bytes.end());
            save(folder / name, std::string(compositor::nameOf(format)) + "_" + nameOf(content), input);
        }
    }
}

void unchangedTiles(const std::filesystem::path& folder) {
    std::mt19937 random(1);
    const auto made = std::move(CodecRegistry().make("bitplane").value());
    Plane plane = makePlane(random, PlaneFormat::Rgba8, Content::Uniform, 520, 130);
    TileDeltaEncoder encoder;
    Bytes input = headOf(shapeOf(plane.view()));
    for (const size_t at : {size_t{0}, size_t{4 * 300}, size_t{4 * 520 * 100}}) {
        plane.bytes()[at] ^= std::byte{9};
        Bytes bytes(encoder.boundBytes(shapeOf(plane.view()), *made));
        bytes.resize(encoder.encode(plane.view(), *made, bytes).value());
        input.push_back(static_cast<std::byte>(bytes.size() & 0xff));
        input.push_back(static_cast<std::byte>(bytes.size() >> 8));
        input.insert(input.end(), bytes.begin(), bytes.end());
    }
    save(folder / "tile_delta", "three_planes", input);
}

} // namespace
} // namespace mural::fuzz

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "codec_fuzz_seeds FOLDER\n");
        return 1;
    }
    mural::compositor::CodecRegistry registry;
    for (const char* name : {"rle64", "rle-components", "rle-swizzled", "bitplane", "slope", "bitplane-zstd",
                             "slope-zstd", "lz4", "zstd", "yuv420", "jpeg-90"})
        mural::fuzz::codec(argv[1], registry, name);
    mural::fuzz::unchangedTiles(argv[1]);
}
