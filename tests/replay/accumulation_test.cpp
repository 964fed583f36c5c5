// The arithmetic of accumulation buffers. All values were read from windows of Mesa 22.3.6.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "nodes/replay/features/accumulation.hpp"

namespace mural {
namespace {

std::array<int16_t, 4> loaded(uint8_t byte, float by) {
    const std::array<uint8_t, 4> pixel{byte, byte, byte, byte};
    std::array<int16_t, 4> values{};
    accumulation::load(values.data(), pixel.data(), 1, by, false);
    return values;
}

TEST(Accumulation, decodesColoursButNotAlpha) {
    EXPECT_EQ(loaded(128, 1)[0], 7073);
    EXPECT_EQ(loaded(128, 0.5f)[1], 3536);
    EXPECT_EQ(loaded(255, 0.25f)[2], 8191);
    EXPECT_EQ(loaded(128, -0.6f)[0], -4243);
    EXPECT_EQ(loaded(255, 1)[3], 32767);
    EXPECT_EQ(loaded(51, 1)[3], 6553);
}

TEST(Accumulation, wrapsAround) {
    EXPECT_EQ(loaded(255, 1.7f)[0], -9833);
    std::array<int16_t, 4> values{32767, 0, -32768, 1};
    accumulation::add(values.data(), 1, 1.0f / 32767);
    EXPECT_EQ(values, (std::array<int16_t, 4>{-32768, 1, -32767, 2}));
    EXPECT_EQ(loaded(255, 1e30f)[0], 0); // more than an int holds
}

TEST(Accumulation, clearsToShorts) {
    for (const auto& [colour, value] : {std::pair{0.05f, 1637},
                                        {0.1f, 3276},
                                        {0.5f, 16383},
                                        {1.0f, 32767},
                                        {-1.0f, -32768},
                                        {-0.3f, -9830},
                                        {0.0f, 0}}) {
        const std::array<float, 4> colours{colour, 0, 0, colour};
        std::array<int16_t, 8> values{};
        accumulation::clear(values.data(), 2, colours.data());
        EXPECT_EQ(values[4], value) << colour;
        EXPECT_EQ(values[7], value) << colour;
        EXPECT_EQ(values[5], 0);
    }
}

TEST(Accumulation, roundTrips) {
    constexpr bool kAll[4] = {true, true, true, true};
    for (int byte = 0; byte < 256; ++byte) {
        const auto values = loaded(static_cast<uint8_t>(byte), 1);
        std::array<uint8_t, 4> out{};
        accumulation::giveBack(values.data(), out.data(), 1, 1, kAll);
        for (const uint8_t channel : out) EXPECT_EQ(channel, byte);
    }
}

TEST(Accumulation, returnsHalvesBrighterThanHalf) {
    constexpr bool kAll[4] = {true, true, true, true};
    for (const auto& [byte, half] : {std::pair{100, 71}, {200, 146}, {255, 188}}) {
        const auto values = loaded(static_cast<uint8_t>(byte), 0.5f);
        std::array<uint8_t, 4> out{};
        accumulation::giveBack(values.data(), out.data(), 1, 1, kAll);
        EXPECT_EQ(out[0], half);
    }
}

TEST(Accumulation, respectsTheColourMask) {
    constexpr bool kSome[4] = {true, false, true, false};
    const std::array<int16_t, 4> values{32767, 32767, -5, 32767};
    std::array<uint8_t, 4> out{1, 2, 3, 4};
    accumulation::giveBack(values.data(), out.data(), 1, 1, kSome);
    EXPECT_EQ(out, (std::array<uint8_t, 4>{255, 2, 0, 4}));
}

TEST(Accumulation, truncatesProducts) {
    std::array<int16_t, 4> values{3, -3, 1000, -1000};
    accumulation::multiply(values.data(), 1, 0.6f);
    EXPECT_EQ(values, (std::array<int16_t, 4>{1, -1, 600, -600}));
}

} // namespace
} // namespace mural
