// Ranges divide draws: each draw belongs to exactly one range, for any decimal fractions and nesting.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "common/geometry/range.hpp"

namespace mural {
namespace {

// Leaves in order: each starts where the previous one ends.
void expectOnce(const std::vector<Range>& leaves, uint64_t count, const std::string& what) {
    uint64_t reached = 0;
    for (const Range& r : leaves) {
        ASSERT_EQ(countBefore(r.start, count), reached)
            << what << ", " << count << " draws, range " << r.start << " to " << r.end;
        reached = countBefore(r.end, count);
    }
    ASSERT_EQ(reached, count) << what;
}

constexpr uint64_t kCounts[] = {1, 2, 3, 7, 10, 90, 100, 999, 1000, 4097, 1'000'000, 16'777'217, 4'294'967'295};

TEST(Ranges, matchIntegerArithmeticForFractions) {
    for (uint64_t n = 1; n <= 300; ++n)
        for (const uint64_t count : kCounts) {
            std::vector<Range> leaves;
            for (uint64_t i = 0; i < n; ++i) {
                leaves.push_back({static_cast<double>(i) / static_cast<double>(n),
                                  static_cast<double>(i + 1) / static_cast<double>(n)});
                // as in integer arithmetic
                ASSERT_EQ(countBefore(leaves.back().start, count), count * i / n) << i << "/" << n;
            }
            expectOnce(leaves, count, "n-ths");
        }
}

// As in files: decimal edges and nested ranges, with equal edges reached on several paths.
void cut(std::mt19937& random, const Range& part, int depth, std::vector<Range>& leaves) {
    if (depth == 0) return leaves.push_back(part);
    const double edge = static_cast<double>(1 + random() % 9) / 10;
    cut(random, compose(part, {0, edge}), depth - 1 - static_cast<int>(random() % 2 && depth > 1), leaves);
    cut(random, compose(part, {edge, 1}), depth - 1, leaves);
}

TEST(Ranges, coverOnceWithNestedDecimals) {
    for (unsigned seed = 1; seed <= 3000; ++seed) {
        std::mt19937 random(seed);
        std::vector<Range> leaves;
        cut(random, {}, 1 + static_cast<int>(random() % 6), leaves);
        expectOnce(leaves, kCounts[random() % std::size(kCounts)], "seed " + std::to_string(seed));
    }
}

// 0.3 + (0.9 - 0.3) and 0.9, 0.1 * 3 and 0.3: an edge that two compounds express differently is one edge.
TEST(Ranges, unifyDifferentExpressionsOfOneEdge) {
    for (const uint64_t count : kCounts)
        for (int a = 0; a < 100; ++a)
            for (int b = a + 1; b <= 100; ++b) {
                const Range outer{a / 100., b / 100.};
                ASSERT_EQ(compose(outer, {.5, 1}).end, outer.end);
                ASSERT_EQ(compose(outer, {}), outer);
                for (int k = 1; k < 10; ++k) {
                    const double nested = compose(outer, {k / 10., 1}).start, written = (a * 10 + k * (b - a)) / 1000.;
                    if (count <= 1'000'000) {
                        ASSERT_EQ(countBefore(nested, count), countBefore(written, count))
                            << count << ": " << nested << " and " << written;
                    }
                }
            }
}

TEST(Ranges, handleEdgesNextToNothingAndAll) {
    for (const uint64_t count : kCounts) {
        for (const double nothing : {0.0, -0.0, -1.0, 5e-324, 1e-300, 1e-17, std::nan("")})
            EXPECT_EQ(countBefore(nothing, count), 0U) << nothing;
        for (const double all : {1.0, std::nextafter(1.0, 2.0), 1.5, 1e300})
            EXPECT_EQ(countBefore(all, count), count) << all;
        // one rounding step below the end counts as the end
        EXPECT_EQ(countBefore(std::nextafter(1.0, 0.0), count), count);
        uint64_t before = 0;
        for (int i = 0; i <= 10000; ++i) {
            const uint64_t at = countBefore(i / 10000., count);
            ASSERT_GE(at, before);
            before = at;
        }
    }
    EXPECT_EQ(countBefore(std::nextafter(1.0, 0.0), UINT64_MAX), UINT64_MAX);
}

} // namespace
} // namespace mural
