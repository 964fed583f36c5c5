// Means of 1 to 256 pictures: always the nearest value, without drift.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "compositor/assembly/average.hpp"
#include "tests/numerics/case_table.hpp"

namespace mural::compositor {
namespace {

Plane meanOf(const std::vector<Plane>& pictures) {
    Average average(PlaneFormat::Rgba8, pictures[0].width(), pictures[0].height());
    for (const Plane& p : pictures) EXPECT_TRUE(average.add(p.view()));
    Plane mean(PlaneFormat::Rgba8, pictures[0].width(), pictures[0].height());
    EXPECT_TRUE(average.write(mean.view()));
    return mean;
}

// All 256 values in one picture of 64 pixels.
Plane allValues() {
    Plane p(PlaneFormat::Rgba8, 64, 1);
    for (size_t i = 0; i < 256; ++i) p.bytes()[i] = static_cast<std::byte>(i);
    return p;
}

TEST(Averages, reproduceARepeatedPicture) {
    for (size_t n = 1; n <= 256; ++n)
        ASSERT_EQ(meanOf(std::vector<Plane>(n, allValues())), allValues()) << n << " pictures";
}

// With k of n pictures one step above the others, the exact mean is value + k/n: covers all roundings, including ties.
TEST(Averages, areTheNearestValue) {
    Plane above = allValues();
    for (auto& b : above.bytes()) b = static_cast<std::byte>(std::min(255U, std::to_integer<unsigned>(b) + 1));
    for (size_t n = 1; n <= 256; ++n)
        for (const size_t k : {size_t{0}, size_t{1}, n / 2, (n + 1) / 2, n - 1, n}) {
            if (k > n) continue;
            std::vector<Plane> pictures(k, above);
            pictures.resize(n, allValues());
            const Plane mean = meanOf(pictures);
            for (size_t i = 0; i < 256; ++i) {
                const unsigned wanted = i == 255 ? 255 : static_cast<unsigned>(i) + (2 * k >= n ? 1 : 0);
                ASSERT_EQ(std::to_integer<unsigned>(mean.bytes()[i]), k == 0 ? i : wanted)
                    << k << " of " << n << " pictures one above " << i;
            }
        }
}

// The mean of the errors: rounding in one direction would show as half a unit.
TEST(Averages, doNotDrift) {
    std::mt19937 random(11);
    for (const size_t n : {3, 5, 16, 17, 64, 255, 256}) {
        std::vector<Plane> pictures;
        std::vector<unsigned> sums(4 * 4096, 0);
        for (size_t i = 0; i < n; ++i) {
            pictures.emplace_back(PlaneFormat::Rgba8, 64, 64);
            for (size_t b = 0; b < sums.size(); ++b) {
                const unsigned value = random() % 256;
                pictures.back().bytes()[b] = static_cast<std::byte>(value);
                sums[b] += value;
            }
        }
        const Plane mean = meanOf(pictures);
        double drift = 0, worst = 0;
        for (size_t b = 0; b < sums.size(); ++b) {
            const double error =
                std::to_integer<unsigned>(mean.bytes()[b]) - static_cast<double>(sums[b]) / static_cast<double>(n);
            worst = std::max(worst, std::abs(error));
            drift += error / static_cast<double>(sums.size());
        }
        // Ties go up: one of n sums, for even n, by half a unit.
        const double ties = n % 2 ? 0 : 0.5 / static_cast<double>(n);
        numerics::expectWithin("means of 3 to 256 pictures", "double", worst, 0.5, "of 255");
        // 4 standard deviations of 16384 errors
        numerics::expectWithin("drift of means beyond what ties do", "double", std::abs(drift - ties), 0.012, "of 255");
    }
}

} // namespace
} // namespace mural::compositor
