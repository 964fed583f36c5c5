// Lossless codecs preserve bits, not numbers: special values are unchanged.
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>
#include <random>

#include "compositor/codecs/registry.hpp"

namespace mural::compositor {
namespace {

// -0, infinities, quiet and signalling NaN with payloads, the smallest, largest and denormal numbers, and values near
// 1.
constexpr uint32_t kSpecial32[] = {0x00000000, 0x80000000, 0x7f800000, 0xff800000, 0x7fc00000, 0xffc00001, 0x7f800001,
                                   0xffbfffff, 0x7fffffff, 0xffffffff, 0x00000001, 0x80000001, 0x007fffff, 0x807fffff,
                                   0x00800000, 0x7f7fffff, 0xff7fffff, 0x3f7fffff, 0x3f800000, 0x3f800001};

// A plane of the given words (2 or 4 bytes), in order and shuffled, so that neighbours differ in all ways.
template <class Word> Plane planeOf(PlaneFormat format, const std::vector<Word>& words) {
    const size_t perPixel = bytesPerPixel(format) / sizeof(Word);
    const auto width = static_cast<int32_t>((words.size() + perPixel - 1) / perPixel);
    constexpr int32_t kRows = 13;
    Plane plane(format, width, kRows);
    std::mt19937 random(1);
    const size_t count = plane.bytes().size() / sizeof(Word);
    for (size_t i = 0; i < count; ++i) {
        const Word word = words[i < count / 2 ? i % words.size() : random() % words.size()];
        std::memcpy(plane.bytes().data() + i * sizeof(Word), &word, sizeof(Word));
    }
    return plane;
}

void expectIdentity(const Plane& plane, const char* what) {
    CodecRegistry registry;
    for (const CodecInfo& info : registry.losslessFor(plane.format())) {
        auto codec = registry.make(info.name);
        ASSERT_TRUE(codec) << info.name;
        const PlaneShape shape = shapeOf(plane.view());
        std::vector<std::byte> bytes((*codec)->boundBytes(shape));
        auto size = (*codec)->encode(plane.view(), bytes);
        ASSERT_TRUE(size) << info.name;
        Plane back(plane.format(), plane.width(), plane.height());
        ASSERT_TRUE((*codec)->decode(std::span(bytes).first(*size), back.view())) << info.name;
        ASSERT_EQ(std::memcmp(back.bytes().data(), plane.bytes().data(), plane.bytes().size()), 0)
            << info.name << ", " << what;
    }
}

TEST(SpecialValues, preserveSpecialDepths) {
    expectIdentity(planeOf(PlaneFormat::D32F, std::vector<uint32_t>(std::begin(kSpecial32), std::end(kSpecial32))),
                   "D32F");
    expectIdentity(planeOf<uint32_t>(PlaneFormat::D24S8, {0, 0xff, 0x100, 0x1ff, 0x7fffffff, 0x80000000, 0xffffff00,
                                                          0xffffffff, 0xfffffe01}),
                   "D24S8");
}

TEST(SpecialValues, preserveEveryHalf) {
    std::vector<uint16_t> halves;
    for (uint32_t h = 0; h < 0x10000; h += 1) halves.push_back(static_cast<uint16_t>(h));
    expectIdentity(planeOf(PlaneFormat::Rgba16F, halves), "RGBA16F");
}

TEST(SpecialValues, preserveFloatsAndTenBitComponents) {
    expectIdentity(planeOf(PlaneFormat::Rgba32F, std::vector<uint32_t>(std::begin(kSpecial32), std::end(kSpecial32))),
                   "RGBA32F");
    std::vector<uint32_t> tens;
    for (uint32_t alpha = 0; alpha < 4; ++alpha)
        for (uint32_t value = 0; value < 1024; ++value)
            tens.push_back(alpha << 30 | value << 20 | (1023 - value) << 10 | value);
    expectIdentity(planeOf(PlaneFormat::Rgb10A2, tens), "RGB10A2");
}

// Depth read by one node and written by another: all 24-bit values through 32 bits and back.
TEST(SpecialValues, preserveEveryDepthOf24BitsThroughFloatsAndIntegers) {
    for (uint32_t d = 0; d < 1U << 24; ++d) {
        const auto asFloat = static_cast<float>(static_cast<double>(d) / 0xffffff); // GL_FLOAT
        ASSERT_EQ(static_cast<uint32_t>(static_cast<double>(asFloat) * 0xffffff + 0.5), d);
        const uint32_t asInteger = d << 8 | d >> 16; // GL_UNSIGNED_INT: 2^24-1 is 2^32-1
        ASSERT_EQ(asInteger >> 8, d);
    }
}

} // namespace
} // namespace mural::compositor
