// Green subtraction and its inverse.
#include "streamcodec/delta/entropy/green_subtraction.hpp"

#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "streamcodec/delta/limits.hpp"
#include "streamcodec/delta/entropy/pixel_filters.hpp"
#include "tests/common/vector_targets.hpp"

namespace mural::delta {
namespace {

using Bytes = std::vector<std::byte>;

Bytes noise(uint32_t seed) {
    std::mt19937 random(seed);
    Bytes piece(kPageBytes);
    for (auto& b : piece) b = static_cast<std::byte>(random());
    return piece;
}

uint8_t at(const Bytes& bytes, size_t i) { return static_cast<uint8_t>(bytes[i]); }

Bytes apartOf(const Bytes& piece, uint8_t filter) {
    Bytes apart(kPageBytes);
    subtractGreen(piece.data(), filter, apart.data());
    return apart;
}

TEST(GreenSubtraction, subtractsTheSecondOfFourBytesFromTheFirstAndThird) {
    const Bytes piece = noise(1), apart = apartOf(piece, kColoursOfFour);
    for (size_t i = 0; i < kPageBytes; i += 4) {
        ASSERT_EQ(at(apart, i), static_cast<uint8_t>(at(piece, i) - at(piece, i + 1))) << i;
        ASSERT_EQ(at(apart, i + 1), at(piece, i + 1)) << i;
        ASSERT_EQ(at(apart, i + 2), static_cast<uint8_t>(at(piece, i + 2) - at(piece, i + 1))) << i;
        ASSERT_EQ(at(apart, i + 3), at(piece, i + 3)) << i;
    }
}

TEST(GreenSubtraction, groupsEachChannelOfThreeBytes) {
    test::forEachTarget([](const char* target) {
        for (size_t before = 0; before < 3; ++before) {
            const Bytes piece = noise(2), apart = apartOf(piece, static_cast<uint8_t>(kColoursOfThree + before));
            const size_t count = (kPageBytes - before) / 3;
            for (size_t i = 0; i < count; ++i) {
                const size_t pixel = before + 3 * i;
                ASSERT_EQ(at(apart, i), at(piece, pixel + 1)) << target << ' ' << i;
                ASSERT_EQ(at(apart, count + i), static_cast<uint8_t>(at(piece, pixel) - at(piece, pixel + 1)))
                    << target << ' ' << i;
                ASSERT_EQ(at(apart, 2 * count + i), static_cast<uint8_t>(at(piece, pixel + 2) - at(piece, pixel + 1)))
                    << target << ' ' << i;
            }
            for (size_t i = 0; i < before; ++i) EXPECT_EQ(apart[3 * count + i], piece[i]) << target;
            for (size_t i = before + 3 * count; i < kPageBytes; ++i) EXPECT_EQ(apart[i], piece[i]) << target;
        }
    });
}

TEST(GreenSubtraction, invertsAllTransforms) {
    test::forEachTarget([](const char* target) {
        for (uint32_t seed = 0; seed < 20; ++seed) {
            const Bytes piece = noise(seed);
            for (const uint8_t filter : kPixelFilters) {
                if (!takesColoursApart(filter)) continue;
                Bytes back(kPageBytes);
                addGreen(apartOf(piece, filter).data(), filter, back.data());
                ASSERT_EQ(back, piece) << target << " seed " << seed << " way " << +filter;
            }
        }
    });
}

} // namespace
} // namespace mural::delta
