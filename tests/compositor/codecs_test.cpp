// Properties of all codecs of the registry: round trips, truncated input, equal bytes on every instruction set.
#include <gtest/gtest.h>

#include <cmath>

#include "compositor/codecs/bitplane/bitplane_codec.hpp"
#include "compositor/codecs/registry.hpp"
#include "compositor/codecs/rle/rle_components_codec.hpp"
#include "tests/compositor/random_bytes.hpp"
#include "tests/compositor/test_planes.hpp"

namespace mural::compositor::test {
namespace {

constexpr std::pair<int32_t, int32_t> kSizes[] = {{1, 1},   {3, 2},    {16, 4},    {17, 5},
                                                  {63, 65}, {257, 66}, {301, 129}, {512, 64}};
constexpr std::byte kUntouched{0xa7};

// A plane within a larger buffer: with a stride, and guard bytes around it.
struct Framed {
    explicit Framed(const PlaneShape& s)
        : strideBytes(s.rowBytes() + 40),
          memory(strideBytes * static_cast<size_t>(s.height + 2) + 80, kUntouched),
          shape(s) {}
    MutablePlaneView view() {
        return {shape.format, shape.width, shape.height, static_cast<ptrdiff_t>(strideBytes),
                memory.data() + strideBytes + 20};
    }
    [[nodiscard]] bool frameIsWhole() {
        for (int32_t y = 0; y < shape.height; ++y) std::fill_n(view().row(y), shape.rowBytes(), kUntouched);
        return std::ranges::all_of(memory, [](std::byte b) { return b == kUntouched; });
    }
    size_t strideBytes;
    std::vector<std::byte> memory;
    PlaneShape shape;
};

bool samePixels(const PlaneView& a, const PlaneView& b) {
    for (int32_t y = 0; y < a.height; ++y)
        if (std::memcmp(a.row(y), b.row(y), a.rowBytes()) != 0) return false;
    return true;
}

void expectLossless(Codec& codec, const Plane& plane, const std::string& what) {
    const PlaneShape shape = shapeOf(plane.view());
    Framed source(shape), target(shape);
    copyPlane(source.view(), plane.view());
    std::vector<std::byte> bytes(codec.boundBytes(shape) + 64, kUntouched);
    auto size = codec.encode(source.view(), std::span(bytes).first(bytes.size() - 64));
    ASSERT_TRUE(size) << what << size.error().message;
    ASSERT_LE(*size, bytes.size() - 64) << what;
    ASSERT_TRUE(std::all_of(bytes.end() - 64, bytes.end(), [](std::byte b) { return b == kUntouched; }))
        << what << ": wrote behind its bound";
    // lets a sanitizer see the first byte after the end
    const std::vector<std::byte> exact(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(*size));
    auto decoded = codec.decode(exact, target.view());
    ASSERT_TRUE(decoded) << what << decoded.error().message;
    ASSERT_TRUE(samePixels(target.view(), plane.view())) << what;
    ASSERT_TRUE(target.frameIsWhole()) << what << ": wrote outside of the plane";
    // Some codecs have separate paths for planes without padding.
    Plane tight(plane.format(), plane.width(), plane.height());
    ASSERT_TRUE(codec.decode(exact, tight.view())) << what;
    ASSERT_EQ(tight, plane) << what;
}

class EveryLosslessCodec : public testing::TestWithParam<std::string> {};

TEST_P(EveryLosslessCodec, roundTripsEveryBit) {
    CodecRegistry registry;
    auto codec = registry.make(GetParam());
    ASSERT_TRUE(codec);
    std::mt19937 random(1);
    for (const PlaneFormat format : kEveryFormat)
        for (const Content content : kEveryContent)
            for (const auto& [width, height] : kSizes)
                expectLossless(**codec, makePlane(random, format, content, width, height),
                               GetParam() + " " + nameOf(format) + " content " +
                                   std::to_string(static_cast<int>(content)) + " " + std::to_string(width) + "x" +
                                   std::to_string(height) + ": ");
}

TEST_P(EveryLosslessCodec, encodesEmptyPlanesAsNoBytes) {
    CodecRegistry registry;
    auto codec = registry.make(GetParam());
    Plane empty(PlaneFormat::Rgba8, 0, 5);
    auto size = (*codec)->encode(empty.view(), {});
    ASSERT_TRUE(size);
    EXPECT_EQ(*size, 0u);
    EXPECT_TRUE((*codec)->decode({}, empty.view()));
    const std::byte one[1] = {};
    EXPECT_FALSE((*codec)->decode(one, empty.view()));
}

// Every truncation, and every plane of another shape, gives an error or a plane, and no access outside.
TEST_P(EveryLosslessCodec, survivesTruncation) {
    CodecRegistry registry;
    auto codec = registry.make(GetParam());
    std::mt19937 random(2);
    const Plane plane = makePlane(random, PlaneFormat::Rgba8, Content::Mixed, 37, 21);
    std::vector<std::byte> bytes((*codec)->boundBytes(shapeOf(plane.view())));
    auto size = (*codec)->encode(plane.view(), bytes);
    ASSERT_TRUE(size);
    Framed target(shapeOf(plane.view()));
    for (size_t cut = 0; cut < *size; ++cut) {
        const std::vector<std::byte> piece(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(cut));
        ASSERT_FALSE((*codec)->decode(piece, target.view())) << cut << " of " << *size;
    }
    bytes.resize(*size);
    bytes.push_back(std::byte{0});
    EXPECT_FALSE((*codec)->decode(bytes, target.view())) << "a byte too many";
    EXPECT_TRUE(target.frameIsWhole());
}

INSTANTIATE_TEST_SUITE_P(Codecs, EveryLosslessCodec,
                         testing::Values("raw", "rle64", "rle-components", "rle-swizzled", "bitplane", "slope",
                                         "bitplane-zstd", "slope-zstd", "lz4", "zstd"),
                         [](const auto& test) {
                             std::string name = test.param;
                             std::ranges::replace(name, '-', '_');
                             return name;
                         });

TEST(RleSwizzled, storesPairsOfBitsWithTheHighOnesFirst) {
    std::mt19937 random(6);
    for (int i = 0; i < 1000; ++i) {
        const auto word = static_cast<uint32_t>(random());
        uint32_t expected = 0;
        for (unsigned stream = 0; stream < 4; ++stream)
            for (unsigned c = 0; c < 4; ++c)
                expected |= (word >> (8 * c + 6 - 2 * stream) & 3) << (8 * stream + 6 - 2 * c);
        ASSERT_EQ(swizzledWord(word), expected);
        ASSERT_EQ(swizzledWord(expected), word);
    }
}

TEST(BitplaneCodecs, giveEqualBytesOnEveryInstructionSet) {
    CodecRegistry registry;
    std::mt19937 random(3);
    const Plane plane = makePlane(random, PlaneFormat::Rgba8, Content::Mixed, 301, 129);
    std::vector<std::byte> first;
    forEachTarget([&](const char* target) {
        auto codec = registry.make("bitplane");
        std::vector<std::byte> bytes((*codec)->boundBytes(shapeOf(plane.view())));
        bytes.resize((*codec)->encode(plane.view(), bytes).value());
        if (first.empty()) first = bytes;
        EXPECT_EQ(bytes, first) << target;
    });
}

TEST(BitplaneCodecs, decodeThePlaneTileByTile) {
    std::mt19937 random(7);
    for (const PlaneFormat format : kEveryFormat)
        for (const auto& [width, height] : kSizes) {
            const Plane plane = makePlane(random, format, Content::Mixed, width, height);
            Plane together(format, width, height);
            BitplaneCodec codec(bitplane::Predictor::Above);
            std::vector<std::byte> bytes(codec.boundBytes(shapeOf(plane.view())));
            bytes.resize(codec.encode(plane.view(), bytes).value());
            const auto put = [&](const PixelViewport& area, const PlaneView& tile) {
                copyPlane(together.view().part(area), tile);
            };
            const auto decoded = codec.decodeTiles(bytes, shapeOf(plane.view()), put);
            ASSERT_TRUE(decoded) << decoded.error().message;
            ASSERT_EQ(together, plane) << compositor::nameOf(format) << " " << width << "x" << height;
            EXPECT_FALSE(codec.decodeTiles(std::span(bytes).first(bytes.size() - 1), shapeOf(plane.view()), put));
        }
}

TEST(BitplaneCodecs, enlargeNoiseByTheirTablesOnly) {
    CodecRegistry registry;
    std::mt19937 random(4);
    const Plane noise = makePlane(random, PlaneFormat::Rgba8, Content::Noise, 512, 128);
    for (const char* name : {"bitplane", "slope"}) {
        auto codec = registry.make(name);
        std::vector<std::byte> bytes((*codec)->boundBytes(shapeOf(noise.view())));
        EXPECT_EQ((*codec)->encode(noise.view(), bytes).value(), noise.bytes().size() + 4 * 5);
    }
}

double worstError(const Plane& a, const Plane& b) {
    double worst = 0;
    for (size_t i = 0; i < a.bytes().size(); ++i)
        worst =
            std::max(worst, std::abs(1.0 * std::to_integer<int>(a.bytes()[i]) - std::to_integer<int>(b.bytes()[i])));
    return worst;
}

TEST(LossyCodecs, areAccurateOnSmoothPicturesAndKeepAlpha) {
    CodecRegistry registry;
    std::mt19937 random(5);
    for (const auto& [name, maximum] : {std::pair{"yuv420", 4.0}, {"jpeg-95", 12.0}, {"jpeg-100", 4.0}})
        for (const auto& [width, height] : kSizes)
            for (const bool mixedAlpha : {false, true}) {
                Plane plane = makePlane(random, PlaneFormat::Rgba8, Content::Surface, width, height);
                for (size_t i = 3; mixedAlpha && i < plane.bytes().size(); i += 4)
                    plane.bytes()[i] = static_cast<std::byte>(random());
                auto codec = registry.make(name);
                ASSERT_TRUE(codec);
                std::vector<std::byte> bytes((*codec)->boundBytes(shapeOf(plane.view())));
                auto size = (*codec)->encode(plane.view(), bytes);
                ASSERT_TRUE(size) << size.error().message;
                bytes.resize(*size);
                Plane back(PlaneFormat::Rgba8, width, height);
                const auto decoded = (*codec)->decode(bytes, back.view());
                ASSERT_TRUE(decoded) << decoded.error().message;
                EXPECT_LE(worstError(plane, back), maximum) << name << " " << width << "x" << height;
                for (size_t i = 3; i < plane.bytes().size(); i += 4)
                    ASSERT_EQ(back.bytes()[i], plane.bytes()[i]) << name;
                for (size_t cut = 0; cut < bytes.size(); cut += 1 + bytes.size() / 50)
                    EXPECT_FALSE((*codec)->decode(std::span(bytes).first(cut), back.view())) << name << " " << cut;
            }
}

TEST(CodecRegistry, returnsLossyCodecsByNameOnly) {
    CodecRegistry registry;
    ASSERT_TRUE(registry.make("jpeg-90"));
    for (const PlaneFormat format : kEveryFormat)
        for (const CodecInfo& c : registry.losslessFor(format))
            EXPECT_TRUE(c.lossless && c.name != "yuv420" && !c.name.starts_with("jpeg")) << c.name;
    EXPECT_FALSE(registry.find("yuv420").value().lossless);
    EXPECT_FALSE(registry.find("jpeg-90").value().takes(PlaneFormat::D24S8));
    for (const char* name : {"", "jpeg-", "jpeg-0", "jpeg-101", "jpeg-9x", "gif"}) {
        const auto none = registry.make(name);
        ASSERT_FALSE(none) << name;
        EXPECT_NE(none.error().message.find("use raw, "), std::string::npos);
    }
}

} // namespace
} // namespace mural::compositor::test
