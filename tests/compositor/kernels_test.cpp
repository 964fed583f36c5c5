// Kernels for masks, interleaving and background search, compared with scalar code.
#include <gtest/gtest.h>

#include <cstring>

#include "compositor/kernels/find_first_difference.hpp"
#include "compositor/kernels/interleave_pixels.hpp"
#include "compositor/kernels/mask_channels.hpp"
#include "tests/compositor/random_bytes.hpp"

namespace mural::compositor::test {
namespace {

TEST(MaskChannels, givesEqualResultsForVectorsAndBytes) {
    forEachTarget([](const char* target) {
        std::mt19937 random(6);
        for (const size_t count : {0, 4, 8, 12, 16, 20, 60, 64, 68, 132, 1000}) {
            ChannelMask mask;
            for (auto& m : mask) m = static_cast<std::byte>(random());
            const std::vector<std::byte> source = randomBytes(random, count);
            std::vector<std::byte> into = randomBytes(random, count), expected = into;
            maskChannelsRow(into.data(), source.data(), count, mask);
            maskChannelsRowScalar(expected.data(), source.data(), count, mask);
            ASSERT_EQ(into, expected) << target << " " << count;
        }
    });
}

TEST(InterleavePixels, givesTheSameRowOnEveryPath) {
    forEachTarget([](const char* target) {
        std::mt19937 random(7);
        for (const size_t pixelBytes : {size_t{4}, size_t{8}, size_t{16}})
            for (size_t step = 1; step <= 7; ++step)
                for (const size_t count : {0, 1, 5, 16, 37}) {
                    std::vector<std::byte> row(count * step * pixelBytes), scalar = row, atOnce = row;
                    std::vector<std::vector<std::byte>> parts;
                    std::vector<const std::byte*> starts;
                    for (size_t k = 0; k < step; ++k) {
                        parts.push_back(randomBytes(random, count * pixelBytes));
                        interleaveRow(row.data() + k * pixelBytes, parts[k].data(), count, step, pixelBytes);
                        interleaveRowScalar(scalar.data() + k * pixelBytes, parts[k].data(), count, step, pixelBytes);
                    }
                    ASSERT_EQ(row, scalar) << target;
                    for (size_t k = 0; k < step; ++k) {
                        std::vector<std::byte> back(count * pixelBytes);
                        deinterleaveRow(back.data(), row.data() + k * pixelBytes, count, step, pixelBytes);
                        ASSERT_EQ(back, parts[k]);
                        starts.push_back(parts[k].data());
                    }
                    if (pixelBytes != 4) continue;
                    interleaveParts(atOnce.data(), starts.data(), count, step);
                    ASSERT_EQ(atOnce, row) << target << " step " << step;
                }
    });
}

TEST(FindFirstDifference, findsTheFirst) {
    forEachTarget([](const char* target) {
        std::mt19937 random(8);
        const uint32_t pattern[4] = {1, 2, 3, 0xffffff00}, mask[4] = {0xffffffff, 0xff, 0xffffffff, 0xffffff00};
        for (const size_t count : {0, 1, 4, 16, 17, 64, 100})
            for (size_t at = 0; at <= count; ++at) {
                std::vector<uint32_t> words;
                for (size_t i = 0; i < count; ++i) words.push_back(pattern[i % 4] ^ (random() & ~mask[i % 4]));
                if (at < count) words[at] ^= mask[at % 4] & (0 - mask[at % 4]);
                ASSERT_EQ(findFirstDifference(words.data(), count, pattern, mask), at) << target;
                ASSERT_EQ(findUnlikeScalar(words.data(), count, pattern, mask), at);
            }
    });
}

} // namespace
} // namespace mural::compositor::test
