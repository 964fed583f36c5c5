// The areas that the head announces, from the reports of nodes.
#include "nodes/head/balancing/tile_equalizer.hpp"
#include "streamcodec/wire/node_messages.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace mural {
namespace {

constexpr uint32_t kWidth = 640, kHeight = 320;

class TileDealerTest : public ::testing::Test {
protected:
    void begin(int nodes, int tileWidth = 32, int tileHeight = 32) {
        SessionConfig config;
        config.tileWidth = tileWidth;
        config.tileHeight = tileHeight;
        config.localNodes = nodes;
        dealer_ = std::make_unique<TileEqualizer>(
            planSession(config, "me"), [this](const ViewportAssignment& areas) { announced_.push_back(areas); });
        alive_.assign(static_cast<size_t>(nodes), true);
    }

    // All living nodes finish a frame. A pixel costs `cost` of its position, from 0 to 1.
    void frame(const std::function<double(double x, double y)>& cost, uint32_t width = kWidth,
               uint32_t height = kHeight, uint32_t areas = UINT32_MAX) {
        ++frames_;
        for (size_t node = 0; node < alive_.size(); ++node) {
            if (!alive_[node]) continue;
            double busy = 0;
            for (int y = 0; y < 64; ++y)
                for (int x = 0; x < 64; ++x) {
                    const double px = (x + .5) / 64, py = (y + .5) / 64;
                    const Viewport v = announced_.empty() ? Viewport{} : announced_.back().ofNodes[node];
                    if (px >= v.x && px < v.x + v.w && py >= v.y && py < v.y + v.h) busy += cost(px, py);
                }
            wire::FrameDoneMessage m{};
            m.client = client_;
            m.window = 1;
            m.frame = frames_;
            m.width = width;
            m.height = height;
            m.busyNs = static_cast<uint64_t>(1e4 * busy);
            m.areas = areas != UINT32_MAX ? areas : announced_.empty() ? 0 : announced_.back().number;
            dealer_->frameDone(static_cast<int>(node), m);
        }
    }
    static double even(double, double) { return 1; }
    static double corner(double x, double y) { return x < 0.2 && y < 0.3 ? 30 : 1; }

    // Checks that each pixel of the picture belongs to one area, aligned to the grid.
    void expectWhole(int width = kWidth, int height = kHeight, int tileWidth = 32, int tileHeight = 32) const {
        const PixelViewport whole{0, 0, width, height};
        int64_t covered = 0;
        for (const Viewport& area : announced_.back().ofNodes) {
            const PixelViewport pixels = apply(whole, area);
            covered += pixels.area();
            for (const int edge : {pixels.x, pixels.right()})
                EXPECT_TRUE(edge % tileWidth == 0 || edge == width) << edge;
            for (const int edge : {pixels.y, pixels.top()})
                EXPECT_TRUE(edge % tileHeight == 0 || edge == height) << edge;
            for (const Viewport& other : announced_.back().ofNodes) {
                if (&other != &area) {
                    EXPECT_TRUE(intersect(pixels, apply(whole, other)).empty());
                }
            }
        }
        EXPECT_EQ(covered, whole.area());
    }
    [[nodiscard]] int64_t pixelsOf(size_t node) const {
        return apply({0, 0, kWidth, kHeight}, announced_.back().ofNodes[node]).area();
    }

    std::unique_ptr<TileEqualizer> dealer_;
    std::vector<ViewportAssignment> announced_;
    std::vector<bool> alive_;
    uint32_t frames_ = 0, client_ = 1;
};

TEST_F(TileDealerTest, derivesTheGridFromTheFirstFrame) {
    begin(3);
    frame(even);
    ASSERT_EQ(announced_.size(), 1u);
    EXPECT_EQ(announced_.back().number, 1u);
    expectWhole();
    for (int i = 0; i < 50; ++i) frame(even);
    EXPECT_LE(announced_.size(), 3u) << "an even load";
}

TEST_F(TileDealerTest, assignsFewerTilesToABusierNode) {
    begin(2);
    for (int i = 0; i < 100; ++i) {
        frame(corner);
        expectWhole();
    }
    const double first = static_cast<double>(pixelsOf(0)), second = static_cast<double>(pixelsOf(1));
    EXPECT_GT(std::max(first, second) / std::min(first, second), 3);
    const auto totals = dealer_->totals();
    ASSERT_EQ(totals.size(), 1u);
    EXPECT_EQ(totals[0].columns, 20);
    EXPECT_EQ(totals[0].rows, 10);
    EXPECT_GT(totals[0].moves, 0);
    EXPECT_GT(totals[0].tilesMoved, totals[0].moves);
    EXPECT_EQ(totals[0].nodes[0].second + totals[0].nodes[1].second, 200);
    EXPECT_EQ(announced_.size(), static_cast<size_t>(totals[0].moves) + 1);
}

TEST_F(TileDealerTest, ignoresFramesOfOlderAreas) {
    begin(2);
    frame(even);
    for (int i = 0; i < 20; ++i) frame(corner, kWidth, kHeight, 0);
    EXPECT_EQ(announced_.size(), 1u);
    EXPECT_EQ(dealer_->totals()[0].frames, 0);
}

TEST_F(TileDealerTest, supportsUnevenSizesAndSmallWindows) {
    begin(4, 50, 70);
    frame(even, 333, 217);
    expectWhole(333, 217, 50, 70);
    frame(even, 500, 300); // larger
    expectWhole(500, 300, 50, 70);
    begin(4, 500, 500); // one tile would serve a single node
    announced_.clear();
    frame(even, 300, 300);
    for (const Viewport& area : announced_.back().ofNodes) EXPECT_FALSE(area.empty());
    begin(4);
    announced_.clear();
    frame(even, 1, 1);
    EXPECT_TRUE(announced_.empty()) << "nothing to divide";
}

TEST_F(TileDealerTest, reassignsTheTilesOfALostNode) {
    begin(3);
    for (int i = 0; i < 5; ++i) frame(even);
    alive_[1] = false;
    dealer_->nodeLost(1);
    expectWhole();
    EXPECT_TRUE(announced_.back().ofNodes[1].empty());
    for (int i = 0; i < 30; ++i) frame(corner);
    expectWhole();
    alive_[1] = true;
    dealer_->nodeJoined(1);
    expectWhole();
    EXPECT_FALSE(announced_.back().ofNodes[1].empty());
    const size_t before = announced_.size();
    dealer_->nodeJoined(1);
    EXPECT_EQ(announced_.size(), before) << "it is there already";
}

TEST_F(TileDealerTest, followsAnotherProgramAfterTheFirstHasEnded) {
    begin(2);
    frame(even);
    dealer_->windowGone(1, wire::kAllWindows);
    client_ = 2;
    frame(even, 320, 160);
    expectWhole(320, 160);
    client_ = 3;
    const size_t before = announced_.size();
    frame(even, 64, 64);
    EXPECT_EQ(announced_.size(), before) << "a smaller window beside it";
}

TEST(TileEqualizer, doesNothingWithoutQueues) {
    SessionConfig config;
    config.columns = 2;
    TileEqualizer dealer(planSession(config, "me"), [](const ViewportAssignment&) { ADD_FAILURE(); });
    EXPECT_FALSE(dealer.deals());
    wire::FrameDoneMessage m{};
    m.width = m.height = 100;
    dealer.frameDone(0, m);
    dealer.nodeLost(0);
    EXPECT_TRUE(dealer.totals().empty());
}

} // namespace
} // namespace mural
