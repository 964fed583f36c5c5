// Flow control of viewers, classes of pictures, and their reduction in the head.
#include <gtest/gtest.h>

#include "tools/mural/page/pictures/picture_class.hpp"
#include "tools/mural/page/pictures/viewer_flow.hpp"

namespace mural::page {
namespace {

constexpr int64_t kMs = 1'000'000;

TEST(ViewerFlow, hasTwoPicturesInFlight) {
    ViewerFlow flow;
    EXPECT_TRUE(flow.canSend());
    flow.sent(1, 0);
    flow.sent(2, 0);
    EXPECT_FALSE(flow.canSend());
    flow.acknowledged(1, 10 * kMs);
    EXPECT_TRUE(flow.canSend());
    flow.sent(3, 10 * kMs);
    flow.acknowledged(3, 20 * kMs); // and with it 2
    flow.sent(4, 20 * kMs);
    EXPECT_TRUE(flow.canSend());
}

TEST(ViewerFlow, unknownFramesChangeNothing) {
    ViewerFlow flow;
    flow.sent(5, 0);
    flow.sent(6, 0);
    flow.acknowledged(4, kMs);
    EXPECT_FALSE(flow.canSend());
    EXPECT_EQ(flow.roundTripNs(), 0);
}

// Returns the time after `pictures` pictures with this round trip.
int64_t play(ViewerFlow& flow, int pictures, int64_t tripNs, int64_t nowNs) {
    static uint64_t frame = 100;
    for (int i = 0; i < pictures; ++i) {
        flow.sent(++frame, nowNs);
        nowNs += tripNs;
        flow.acknowledged(frame, nowNs);
    }
    return nowNs;
}

TEST(ViewerFlow, qualityFallsWithLateAcksAndRecovers) {
    ViewerFlow flow;
    int64_t nowNs = play(flow, 1, 10 * kMs, 1'000 * kMs);
    EXPECT_EQ(flow.quality(), 100);
    nowNs = play(flow, 20, 900 * kMs, nowNs);
    EXPECT_EQ(flow.quality(), ViewerFlow::kQualities.back());
    play(flow, 2'000, 10 * kMs, nowNs);
    EXPECT_EQ(flow.quality(), 100);
}

TEST(PictureClass, limitsDependOnTheOptions) {
    const PictureLimits limits{30, 640, 80};
    EXPECT_EQ(limitsOf(PictureClass::Preview, limits).maxWidth, 640);
    EXPECT_EQ(limitsOf(PictureClass::Preview, limits).intervalNs, 1'000'000'000 / 30);
    EXPECT_EQ(limitsOf(PictureClass::Thumb, limits).maxWidth, 320);
    EXPECT_EQ(pictureClassOfName("full"), PictureClass::Full);
    EXPECT_EQ(pictureClassOfName("off"), std::nullopt);
}

} // namespace
} // namespace mural::page
