// The time between the swaps of the first and the last window of a barrier.
#include "nodes/swap_barrier/skew_meter.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

TEST(SkewMeter, measuresFromTheFirstWindowToTheLast) {
    SkewMeter meter;
    for (uint32_t f = 1; f <= 100; ++f) {
        const SwapKey key{1, 1, f};
        meter.released(key, 3);
        meter.shown(key, 1000 * f + 10);
        meter.shown(key, 1000 * f);
        EXPECT_EQ(meter.numbers().swaps, f - 1); // one window has not reported yet
        meter.shown(key, 1000 * f + f);
    }
    const SkewNumbers n = meter.numbers();
    EXPECT_EQ(n.swaps, 100);
    EXPECT_EQ(n.medianNs, 51);
    EXPECT_EQ(n.p99Ns, 100);
    EXPECT_EQ(n.maxNs, 100);
}

TEST(SkewMeter, ignoresSwapsOfASingleWindow) {
    SkewMeter meter;
    meter.released({1, 1, 1}, 1);
    meter.shown({1, 1, 1}, 5);
    meter.shown({1, 1, 7}, 5); // no window was released for this swap
    EXPECT_EQ(meter.numbers().swaps, 0);
}

TEST(SkewMeter, forgetsWindowsThatNeverReport) {
    SkewMeter meter;
    for (uint32_t f = 1; f <= 1000; ++f) {
        meter.released({1, 1, f}, 2);
        meter.shown({1, 1, f}, 1);
    }
    meter.shown({1, 1, 1000}, 4);
    EXPECT_EQ(meter.numbers().swaps, 1);
    EXPECT_EQ(meter.numbers().maxNs, 3);
}

} // namespace
} // namespace mural
