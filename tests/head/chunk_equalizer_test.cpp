// The shares that the head announces, from the reports of nodes.
#include "nodes/head/balancing/chunk_equalizer.hpp"
#include "streamcodec/wire/node_messages.hpp"

#include <functional>
#include <gtest/gtest.h>
#include <limits>

namespace mural {
namespace {

SessionConfig configOf(int nodes, int chunks) {
    SessionConfig config;
    config.passes.ranges = nodes;
    config.chunks = chunks;
    config.localNodes = nodes;
    return config;
}

class ChunkDealerTest : public ::testing::Test {
protected:
    void begin(int nodes, int chunks) {
        plan_ = planSession(configOf(nodes, chunks), "me");
        dealer_ = std::make_unique<ChunkEqualizer>(
            plan_, [this](const RangeAssignment& shares) { announced_.push_back(shares); });
        alive_.assign(static_cast<size_t>(nodes), true);
    }

    [[nodiscard]] Range shareOf(size_t node) const {
        return announced_.empty() ? plan_.nodes[node].pass.share : announced_.back().ofNodes[node];
    }

    // All living nodes finish a frame. A draw costs `cost` of its place in the frame, from 0 to 1; the collector has
    // `more` additional work.
    void frame(const std::function<double(double)>& cost, double more = 0, uint32_t flags = 0,
               uint32_t shares = UINT32_MAX) {
        ++frames_;
        const uint32_t number = shares != UINT32_MAX ? shares : announced_.empty() ? 0 : announced_.back().number;
        std::vector<double> busy;
        for (size_t node = 0; node < alive_.size(); ++node) {
            const Range share = shareOf(node);
            busy.push_back(node == 0 ? more : 0);
            for (int i = 0; i < 1000; ++i)
                if (const double at = (i + .5) / 1000; at >= share.start && at < share.end) busy.back() += cost(at);
        }
        for (size_t node = 0; node < alive_.size(); ++node) {
            if (!alive_[node]) continue;
            wire::FrameDoneMessage m{};
            m.client = m.window = 1;
            m.frame = frames_;
            m.width = 640, m.height = 480;
            m.busyNs = static_cast<uint64_t>(1e4 * busy[node]);
            m.shares = number;
            m.flags = flags;
            dealer_->frameDone(static_cast<int>(node), m);
        }
    }
    static double even(double) { return 1; }
    static double costlyFirst(double at) { return at < 0.2 ? 10 : 1; }

    // Every draw belongs to one living node, in the order of their ranges.
    void expectWhole() const {
        double at = 0;
        for (size_t node = 0; node < alive_.size(); ++node) {
            const Range share = shareOf(node);
            if (!alive_[node]) {
                EXPECT_TRUE(share.empty()) << node;
                continue;
            }
            EXPECT_EQ(share.start, at) << node;
            EXPECT_FALSE(share.empty()) << node;
            at = share.end;
        }
        EXPECT_EQ(at, 1);
    }

    SessionPlan plan_;
    std::unique_ptr<ChunkEqualizer> dealer_;
    std::vector<RangeAssignment> announced_;
    std::vector<bool> alive_;
    uint32_t frames_ = 0;
};

TEST_F(ChunkDealerTest, movesNothingForEqualCosts) {
    begin(4, 64);
    for (int i = 0; i < 20; ++i) frame(even);
    EXPECT_TRUE(announced_.empty());
    EXPECT_GT(dealer_->totals()[0].frames, 10);
}

TEST_F(ChunkDealerTest, assignsFewerExpensiveDraws) {
    begin(3, 90);
    for (int i = 0; i < 60; ++i) frame(costlyFirst);
    ASSERT_FALSE(announced_.empty());
    expectWhole();
    // Total cost 2.8: a third is 0.93, within the first fifth of the draws.
    EXPECT_LT(shareOf(0).end, 0.14);
    EXPECT_LT(shareOf(1).end, 0.3);
    const QueueTotals totals = dealer_->totals()[0];
    EXPECT_TRUE(totals.chunks);
    EXPECT_EQ(totals.columns, 90);
    EXPECT_GT(totals.moves, 0);
    EXPECT_LT(totals.moves, 20) << "it settles";
}

TEST_F(ChunkDealerTest, countsOtherWorkOfTheCollector) {
    begin(2, 100);
    for (int i = 0; i < 60; ++i) frame(even, 500);
    expectWhole();
    EXPECT_LT(shareOf(0).end, 0.32);
    EXPECT_GT(shareOf(0).end, 0.18);
}

TEST_F(ChunkDealerTest, ignoresFramesOfOlderSharesOrWithoutSharedDraws) {
    begin(3, 30);
    for (int i = 0; i < 20; ++i) frame(costlyFirst, 0, wire::kNotSplit);
    for (int i = 0; i < 20; ++i) frame(costlyFirst, 0, 0, 7);
    EXPECT_TRUE(announced_.empty());
    EXPECT_EQ(dealer_->totals()[0].frames, 0);
}

TEST_F(ChunkDealerTest, reassignsTheChunksOfALostNode) {
    begin(3, 30);
    for (int i = 0; i < 4; ++i) frame(even);
    alive_[1] = false;
    dealer_->nodeLost(1);
    ASSERT_EQ(announced_.size(), 1u);
    expectWhole();
    EXPECT_EQ(dealer_->totals()[0].nodes[1].second, 0);
    for (int i = 0; i < 30; ++i) frame(costlyFirst);
    expectWhole();
    alive_[1] = true;
    dealer_->nodeJoined(1);
    expectWhole();
    EXPECT_NEAR(shareOf(1).start, 1.0 / 3, 1e-9);
    const size_t announced = announced_.size();
    dealer_->nodeJoined(1); // it is alive
    EXPECT_EQ(announced_.size(), announced);
}

TEST_F(ChunkDealerTest, givesEachNodeAChunk) {
    begin(5, 2);
    dealer_->nodeLost(4);
    alive_[4] = false;
    expectWhole();
}

TEST_F(ChunkDealerTest, keepsRandomSharesCompleteAndInOrder) {
    plan_ = planSession(configOf(4, 16), "me");
    dealer_ = std::make_unique<ChunkEqualizer>(
        plan_, [this](const RangeAssignment& shares) { announced_.push_back(shares); }, "shares");
    alive_.assign(4, true);
    for (int i = 0; i < 50; ++i) {
        frame(even);
        expectWhole();
    }
    EXPECT_GE(announced_.size(), 200u);
}

TEST(ChunkEqualizer, doesNothingWithoutAQueueOrForTimeMultiplexedNodes) {
    const SessionPlan without = planSession(configOf(3, 0), "me");
    EXPECT_FALSE(ChunkEqualizer(without, [](const RangeAssignment&) { ADD_FAILURE(); }).deals());
    SessionConfig turns = configOf(2, 20);
    turns.passes.period = 2;
    turns.localNodes = 4;
    const SessionPlan plan = planSession(turns, "me");
    EXPECT_FALSE(ChunkEqualizer(plan, [](const RangeAssignment&) { ADD_FAILURE(); }).deals());
    ASSERT_FALSE(plan.warnings.empty());
    EXPECT_NE(plan.warnings[0].find("in turn"), std::string::npos) << plan.warnings[0];
}

TEST(RangeAssignment, roundTripsAndRejectsInvalidOnes) {
    const RangeAssignment shares{3, {{0, .25}, {.25, .25}, {.25, 1}}};
    const auto bytes = bytesOf(shares);
    EXPECT_EQ(sharesOf(bytes), shares);
    for (size_t size = 0; size < bytes.size(); ++size) EXPECT_FALSE(sharesOf(std::span(bytes).first(size))) << size;
    for (const Range wrong :
         {Range{.5, .25}, Range{-.1, 1}, Range{0, 1.1}, Range{std::numeric_limits<double>::quiet_NaN(), 1},
          Range{0, std::numeric_limits<double>::quiet_NaN()}})
        EXPECT_FALSE(sharesOf(bytesOf(RangeAssignment{1, {wrong}})));
}

} // namespace
} // namespace mural
