// When small state is deferred, and when no longer.
#include "streamcodec/filter/redundancy_tuner.hpp"

#include <functional>
#include <gtest/gtest.h>

namespace mural::filter {
namespace {

constexpr uint64_t kBytes = 10'000, kWireBytes = 500; // of a frame

struct Went {
    uint32_t frames = 0, dropped = 0, timed = 0;
};

// cost: of a frame, with and without dropping.
Went go(RedundancyTuner& choice, uint32_t frames, const std::function<double(bool, uint32_t)>& cost) {
    Went went;
    for (uint32_t i = 0; i < frames; ++i) {
        ++went.frames;
        went.dropped += choice.dropsRedundant();
        went.timed += choice.wantsTime();
        choice.frame(kBytes, kWireBytes, choice.wantsTime() ? cost(choice.dropsRedundant(), i) : -1);
    }
    return went;
}

TEST(RedundancyTuner, dropsWhereItCostsLess) {
    RedundancyTuner choice;
    EXPECT_EQ(go(choice, 16, [](bool, uint32_t) { return 1.0; }).dropped, 0u) << "not before it has been tried";
    EXPECT_GT(go(choice, 3000, [](bool out, uint32_t) { return out ? 80.0 : 100.0; }).dropped, 2800u);
    EXPECT_TRUE(choice.dropsRedundant());
}

TEST(RedundancyTuner, triesRarelyWhereItCostsMore) {
    RedundancyTuner choice;
    const Went went = go(choice, 5000, [](bool out, uint32_t) { return out ? 120.0 : 100.0; });
    EXPECT_FALSE(choice.dropsRedundant());
    EXPECT_GT(went.dropped, 20u) << "or it was not tried";
    EXPECT_LT(went.dropped, 150u);
    EXPECT_LT(went.timed, 250u) << "clocks cost, too";
}

TEST(RedundancyTuner, triesNothingForEqualFrames) {
    RedundancyTuner choice;
    for (uint32_t i = 0; i < 1000; ++i) {
        choice.frame(kBytes, 20, 1);
        EXPECT_FALSE(choice.dropsRedundant() || choice.wantsTime());
    }
}

TEST(RedundancyTuner, ignoresSingleFrames) {
    RedundancyTuner choice;
    go(choice, 3000, [](bool out, uint32_t frame) { return frame % 5 == 0 ? 5000.0 : out ? 80.0 : 100.0; });
    EXPECT_TRUE(choice.dropsRedundant());
}

TEST(RedundancyTuner, followsTheProgram) {
    RedundancyTuner choice;
    go(choice, 1000, [](bool out, uint32_t) { return out ? 80.0 : 100.0; });
    EXPECT_TRUE(choice.dropsRedundant());
    go(choice, 5000, [](bool out, uint32_t) { return out ? 100.0 : 80.0; });
    EXPECT_FALSE(choice.dropsRedundant());
}

TEST(RedundancyTuner, restartsAfterAnotherChange) {
    RedundancyTuner choice;
    bool tried = false;
    for (uint32_t i = 0; i < 3000; ++i) { // otherwise the expensive frames would decide
        if (choice.dropsRedundant() && !tried) {
            tried = true;
            choice.disturbed();
            EXPECT_FALSE(choice.dropsRedundant()) << "as it was before it was tried";
        }
        choice.frame(kBytes, kWireBytes, choice.wantsTime() ? (choice.dropsRedundant() ? 120.0 : 100.0) : -1);
    }
    EXPECT_TRUE(tried);
    EXPECT_FALSE(choice.dropsRedundant());
}

} // namespace
} // namespace mural::filter
