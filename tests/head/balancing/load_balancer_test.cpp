// The areas and ranges that the head announces, from the reports of nodes.
#include "nodes/head/balancing/load_balancer.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <utility>

#include "nodes/head/planning/make_plan.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {
namespace {

constexpr uint32_t kWidth = 640, kHeight = 320;
constexpr int kSamples = 128; // points per direction at which costs are taken

class BalancerTest : public ::testing::Test {
protected:
    void begin(const SessionConfig& config, const std::string& plant = {}) {
        auto plan = makePlan(config, "me");
        ASSERT_TRUE(plan.ok()) << plan.error().message;
        plan_ = std::move(*plan);
        areas_.clear();
        ranges_.clear();
        paces_.clear();
        redraws_ = 0;
        balancer_ = std::make_unique<LoadBalancer>(
            plan_,
            LoadBalancer::Announce{
                [this](const ViewportAssignment& areas) { areas_.push_back(areas); },
                [this](const RangeAssignment& ranges) { ranges_.push_back(ranges); },
                [this](uint32_t client, double framesPerSecond) { paces_.emplace_back(client, framesPerSecond); },
                [this](uint32_t, uint32_t) { ++redraws_; }},
            plant);
        alive_.assign(plan_.nodes.size(), true);
        frames_ = 0;
    }

    [[nodiscard]] Viewport areaOf(size_t node) const {
        return areas_.empty() ? plan_.nodes[node].area.value_or(Viewport{}) : areas_.back().ofNodes[node];
    }
    [[nodiscard]] Range rangeOf(size_t node) const {
        return ranges_.empty() ? plan_.nodes[node].pass.share : ranges_.back().ofNodes[node];
    }
    [[nodiscard]] int64_t pixelsOf(size_t node) const { return apply({0, 0, kWidth, kHeight}, areaOf(node)).area(); }

    // All living nodes finish a frame with these busy times.
    void finish(const std::vector<double>& busy, wire::FrameDoneMessage m = {}) {
        m.client = client_;
        m.window = 1;
        m.frame = ++frames_;
        if (m.width == 0) m.width = kWidth, m.height = kHeight;
        if (m.areas == 0 && !areas_.empty()) m.areas = areas_.back().number;
        if (m.shares == 0 && !ranges_.empty()) m.shares = ranges_.back().number;
        if (m.areas == kOld) m.areas = 0;
        if (m.shares == kOld) m.shares = 0;
        for (size_t node = 0; node < alive_.size(); ++node) {
            if (!alive_[node]) continue;
            m.busyNs = static_cast<uint64_t>(1e4 * busy[node]);
            balancer_->frameDone(static_cast<int>(node), m, int64_t{frames_} * 16'000'000);
        }
    }

    // A pixel costs `cost` of its position, from 0 to 1.
    void drawAreas(const std::function<double(double x, double y)>& cost, wire::FrameDoneMessage m = {},
                   const std::vector<double>& speeds = {}) {
        std::vector<double> busy(alive_.size(), 0);
        for (size_t node = 0; node < alive_.size(); ++node) {
            const Viewport v = areaOf(node);
            for (int y = 0; y < kSamples; ++y)
                for (int x = 0; x < kSamples; ++x) {
                    const double px = (x + .5) / kSamples, py = (y + .5) / kSamples;
                    if (px >= v.x && px < v.x + v.w && py >= v.y && py < v.y + v.h) busy[node] += cost(px, py);
                }
            if (!speeds.empty()) busy[node] /= speeds[node];
        }
        efficiency_ = efficiencyOf(busy);
        finish(busy, m);
    }

    // A draw costs `cost` of its place in the frame, from 0 to 1; the collector has `more` additional work.
    void drawRanges(const std::function<double(double)>& cost, double more = 0, wire::FrameDoneMessage m = {}) {
        std::vector<double> busy(alive_.size(), 0);
        busy[0] = more;
        for (size_t node = 0; node < alive_.size(); ++node) {
            const Range range = rangeOf(node);
            for (int i = 0; i < 1000; ++i)
                if (const double at = (i + .5) / 1000; at >= range.start && at < range.end) busy[node] += cost(at);
        }
        efficiency_ = efficiencyOf(busy);
        finish(busy, m);
    }

    static double efficiencyOf(const std::vector<double>& busy) {
        double sum = 0, longest = 0;
        for (const double b : busy) sum += b, longest = std::max(longest, b);
        return sum / (static_cast<double>(busy.size()) * longest);
    }

    // Checks that each pixel of the picture belongs to one area, and that all edges lie on the grid.
    void expectWholePicture(int width = kWidth, int height = kHeight, int stepX = 1, int stepY = 1) const {
        const PixelViewport whole{0, 0, width, height};
        int64_t covered = 0;
        ASSERT_FALSE(areas_.empty());
        for (const Viewport& area : areas_.back().ofNodes) {
            const PixelViewport pixels = apply(whole, area);
            if (pixels.empty()) continue;
            covered += pixels.area();
            for (const int edge : {pixels.x, pixels.right()}) EXPECT_TRUE(edge % stepX == 0 || edge == width) << edge;
            for (const int edge : {pixels.y, pixels.top()}) EXPECT_TRUE(edge % stepY == 0 || edge == height) << edge;
            for (const Viewport& other : areas_.back().ofNodes) {
                if (&other != &area) {
                    EXPECT_TRUE(intersect(pixels, apply(whole, other)).empty());
                }
            }
        }
        EXPECT_EQ(covered, whole.area());
    }

    // Checks that each draw belongs to one living node, in the order of their ranges.
    void expectAllDraws() const {
        double at = 0;
        for (size_t node = 0; node < alive_.size(); ++node) {
            const Range range = rangeOf(node);
            if (!alive_[node]) {
                EXPECT_TRUE(range.empty()) << node;
                continue;
            }
            EXPECT_EQ(range.start, at) << node;
            EXPECT_FALSE(range.empty()) << node;
            at = range.end;
        }
        EXPECT_EQ(at, 1);
    }

    static double even(double, double) { return 1; }
    static double corner(double x, double y) { return x < 0.2 && y < 0.3 ? 30 : 1; }
    static double evenDraws(double) { return 1; }
    static double costlyFirst(double at) { return at < 0.2 ? 10 : 1; }

    static constexpr uint32_t kOld = UINT32_MAX; // the number of the first assignment

    SessionPlan plan_;
    std::unique_ptr<LoadBalancer> balancer_;
    std::vector<ViewportAssignment> areas_;
    std::vector<RangeAssignment> ranges_;
    std::vector<std::pair<uint32_t, double>> paces_; // client, frames per second
    int redraws_ = 0;
    std::vector<bool> alive_;
    uint32_t frames_ = 0, client_ = 1;
    double efficiency_ = 0; // of the last frame
};

// ---- tile queues

SessionConfig tilesOf(int nodes, int width = 32, int height = 32) {
    SessionConfig config;
    config.tileWidth = width;
    config.tileHeight = height;
    config.localNodes = nodes;
    return config;
}

TEST_F(BalancerTest, alignsTilesToTheGridOfTheWindow) {
    begin(tilesOf(3));
    drawAreas(even);
    ASSERT_EQ(areas_.size(), 1u);
    EXPECT_EQ(areas_.back().number, 1u);
    expectWholePicture(kWidth, kHeight, 32, 32);
    for (int i = 0; i < 50; ++i) drawAreas(even);
    EXPECT_LE(areas_.size(), 3u) << "an even load";
}

TEST_F(BalancerTest, assignsFewerTilesToABusierNode) {
    begin(tilesOf(2));
    for (int i = 0; i < 100; ++i) {
        drawAreas(corner);
        expectWholePicture(kWidth, kHeight, 32, 32);
    }
    const double first = static_cast<double>(pixelsOf(0)), second = static_cast<double>(pixelsOf(1));
    EXPECT_GT(std::max(first, second) / std::min(first, second), 3);
    const auto totals = balancer_->totals();
    ASSERT_EQ(totals.size(), 1u);
    EXPECT_EQ(totals[0].kind, "tile_queue");
    EXPECT_GT(totals[0].moves, 0);
    EXPECT_GT(totals[0].efficiency, .9);
    EXPECT_NEAR(totals[0].nodes[0].part + totals[0].nodes[1].part, 1, 1e-9);
    EXPECT_EQ(areas_.size(), static_cast<size_t>(totals[0].moves) + 1);
}

TEST_F(BalancerTest, ignoresFramesOfOlderAreas) {
    begin(tilesOf(2));
    drawAreas(even);
    wire::FrameDoneMessage m{};
    m.areas = kOld;
    for (int i = 0; i < 20; ++i) drawAreas(corner, m);
    EXPECT_EQ(areas_.size(), 1u);
    EXPECT_EQ(balancer_->totals()[0].frames, 0);
}

TEST_F(BalancerTest, supportsUnevenSizesAndSmallWindows) {
    begin(tilesOf(4, 50, 70));
    wire::FrameDoneMessage m{};
    m.width = 333, m.height = 217;
    drawAreas(even, m);
    expectWholePicture(333, 217, 50, 70);
    m.width = 500, m.height = 300; // larger
    drawAreas(even, m);
    expectWholePicture(500, 300, 50, 70);
    begin(tilesOf(4, 500, 500)); // one tile would serve a single node
    m.width = m.height = 300;
    drawAreas(even, m);
    for (const Viewport& area : areas_.back().ofNodes) EXPECT_FALSE(area.empty());
}

TEST_F(BalancerTest, reassignsTheTilesOfALostNode) {
    begin(tilesOf(3));
    for (int i = 0; i < 5; ++i) drawAreas(even);
    alive_[1] = false;
    balancer_->nodeLost(1);
    expectWholePicture();
    EXPECT_TRUE(areaOf(1).empty());
    for (int i = 0; i < 30; ++i) drawAreas(corner);
    expectWholePicture();
    alive_[1] = true;
    balancer_->nodeJoined(1);
    expectWholePicture();
    EXPECT_FALSE(areaOf(1).empty());
    const size_t before = areas_.size();
    balancer_->nodeJoined(1);
    EXPECT_EQ(areas_.size(), before) << "it is there already";
}

TEST_F(BalancerTest, givesUpTheAreaOfALivingNode) {
    begin(tilesOf(3));
    EXPECT_TRUE(balancer_->giveUp(1)); // no window: there is nothing to draw
    EXPECT_TRUE(balancer_->hasGivenUp(1));
    balancer_->takeBack(1);
    finish({4, 4, 4});
    ASSERT_GT(pixelsOf(1), 0);
    ASSERT_TRUE(balancer_->giveUp(1));
    EXPECT_EQ(pixelsOf(1), 0);
    expectWholePicture(kWidth, kHeight);
    EXPECT_FALSE(balancer_->hasGivenUp(1)); // no frame is drawn with these areas yet
    wire::FrameDoneMessage old{};
    old.areas = kOld;
    finish({4, 4, 4}, old);
    EXPECT_FALSE(balancer_->hasGivenUp(1));
    EXPECT_EQ(pixelsOf(1), 0);
    finish({4, 0, 4});
    EXPECT_TRUE(balancer_->hasGivenUp(1));
    wire::FrameDoneMessage other{}; // a second window that has not taken the areas over
    other.client = 2;
    other.window = 9;
    other.frame = 1;
    other.width = other.height = 10;
    balancer_->frameDone(1, other, 0);
    EXPECT_FALSE(balancer_->hasGivenUp(1));
    balancer_->windowGone(2, 9);
    EXPECT_TRUE(balancer_->hasGivenUp(1));
    balancer_->takeBack(1);
    EXPECT_GT(pixelsOf(1), 0);
    EXPECT_FALSE(balancer_->hasGivenUp(1));
}

TEST_F(BalancerTest, followsAnotherProgramAfterTheFirstHasEnded) {
    begin(tilesOf(2));
    drawAreas(even);
    balancer_->windowGone(1, wire::kAllWindows);
    client_ = 2;
    wire::FrameDoneMessage m{};
    m.width = 320, m.height = 160;
    drawAreas(even, m);
    expectWholePicture(320, 160);
    client_ = 3;
    const size_t before = areas_.size();
    m.width = m.height = 64;
    drawAreas(even, m);
    EXPECT_EQ(areas_.size(), before) << "a smaller window beside it";
}

// ---- chunk queues

SessionConfig rangesOf(int nodes) {
    SessionConfig config;
    config.passes.ranges = nodes;
    config.localNodes = nodes;
    return config;
}

SessionConfig chunksOf(int nodes, int chunks) {
    SessionConfig config = rangesOf(nodes);
    config.chunks = chunks;
    return config;
}

TEST_F(BalancerTest, movesNoChunksForEqualCosts) {
    begin(chunksOf(4, 64));
    for (int i = 0; i < 20; ++i) drawRanges(evenDraws);
    EXPECT_LE(ranges_.size(), 1u);
    EXPECT_GT(balancer_->totals()[0].frames, 10);
}

TEST_F(BalancerTest, assignsFewerExpensiveChunks) {
    begin(chunksOf(3, 90));
    for (int i = 0; i < 60; ++i) drawRanges(costlyFirst);
    ASSERT_FALSE(ranges_.empty());
    expectAllDraws();
    // Total cost 2.8: a third is 0.93, within the first fifth of the draws.
    EXPECT_LT(rangeOf(0).end, 0.14);
    EXPECT_LT(rangeOf(1).end, 0.3);
    const EqualizerTotals totals = balancer_->totals()[0];
    EXPECT_EQ(totals.division, Division::Ranges);
    EXPECT_EQ(totals.kind, "chunk_queue");
    EXPECT_GT(totals.moves, 0);
    EXPECT_LT(totals.moves, 20) << "it settles";
}

TEST_F(BalancerTest, countsOtherWorkOfTheCollector) {
    begin(chunksOf(2, 100));
    for (int i = 0; i < 60; ++i) drawRanges(evenDraws, 500);
    expectAllDraws();
    EXPECT_LT(rangeOf(0).end, 0.32);
    EXPECT_GT(rangeOf(0).end, 0.18);
}

TEST_F(BalancerTest, ignoresFramesOfOlderRangesOrWithoutDividedDraws) {
    begin(chunksOf(3, 30));
    drawRanges(evenDraws);
    const size_t before = ranges_.size();
    wire::FrameDoneMessage undivided{}, other{};
    undivided.flags = wire::kNotSplit;
    other.shares = 77;
    for (int i = 0; i < 20; ++i) drawRanges(costlyFirst, 0, undivided);
    for (int i = 0; i < 20; ++i) drawRanges(costlyFirst, 0, other);
    EXPECT_EQ(ranges_.size(), before);
}

TEST_F(BalancerTest, reassignsTheChunksOfALostNode) {
    begin(chunksOf(3, 30));
    for (int i = 0; i < 4; ++i) drawRanges(evenDraws);
    alive_[1] = false;
    balancer_->nodeLost(1);
    expectAllDraws();
    EXPECT_EQ(balancer_->totals()[0].nodes[1].part, 0);
    for (int i = 0; i < 30; ++i) drawRanges(costlyFirst);
    expectAllDraws();
    alive_[1] = true;
    balancer_->nodeJoined(1);
    expectAllDraws();
    const size_t announced = ranges_.size();
    balancer_->nodeJoined(1); // it is alive
    EXPECT_EQ(ranges_.size(), announced);
}

TEST_F(BalancerTest, givesEachNodeAChunk) {
    begin(chunksOf(5, 2));
    balancer_->nodeLost(4);
    alive_[4] = false;
    expectAllDraws();
}

TEST_F(BalancerTest, keepsRandomDivisionsComplete) {
    begin(chunksOf(4, 16), "shares");
    for (int i = 0; i < 50; ++i) {
        drawRanges(evenDraws);
        expectAllDraws();
    }
    EXPECT_GE(ranges_.size(), 150u);
    begin(tilesOf(5), "areas");
    for (int i = 0; i < 50; ++i) {
        drawAreas(even);
        expectWholePicture();
    }
    EXPECT_GE(areas_.size(), 150u);
}

// ---- equalizers

class SplitTest : public BalancerTest, public ::testing::WithParamInterface<balance::Balance> {
protected:
    [[nodiscard]] SessionConfig balanced(int nodes, int ranges = 1) const {
        SessionConfig config;
        config.localNodes = nodes;
        config.passes.ranges = ranges;
        config.balance = GetParam();
        return config;
    }
};

TEST_P(SplitTest, balancesAnUnevenPicture) {
    begin(balanced(4));
    ASSERT_EQ(plan_.nodes.size(), 4u);
    drawAreas(corner);
    EXPECT_LT(efficiency_, .5) << "the even split";
    for (int i = 0; i < 40; ++i) {
        drawAreas(corner);
        expectWholePicture();
    }
    EXPECT_GT(efficiency_, .85);
    EXPECT_GT(balancer_->totals()[0].efficiency, .85);
}

TEST_P(SplitTest, givesSlowNodesLess) {
    begin(balanced(4));
    for (int i = 0; i < 60; ++i) drawAreas(even, {}, {1, 1, .5, 1});
    expectWholePicture();
    EXPECT_GT(efficiency_, .9);
    EXPECT_NEAR(static_cast<double>(pixelsOf(2)) / (kWidth * kHeight), 1. / 7, .04);
}

TEST_P(SplitTest, balancesRanges) {
    begin(balanced(3, 3));
    ASSERT_EQ(plan_.nodes.size(), 3u);
    for (int i = 0; i < 40; ++i) {
        drawRanges(costlyFirst);
        expectAllDraws();
    }
    EXPECT_GT(efficiency_, .9);
}

TEST_P(SplitTest, reassignsThePartOfALostNode) {
    begin(balanced(4));
    alive_[2] = false;
    balancer_->nodeLost(2); // before the first frame
    EXPECT_TRUE(areaOf(2).empty()) << "the first frame of a new window has no part of it";
    for (int i = 0; i < 20; ++i) {
        drawAreas(corner);
        expectWholePicture();
        EXPECT_TRUE(areaOf(2).empty());
    }
    alive_[2] = true;
    balancer_->nodeJoined(2);
    for (int i = 0; i < 40; ++i) drawAreas(corner);
    expectWholePicture();
    EXPECT_FALSE(areaOf(2).empty());
    EXPECT_GT(efficiency_, .8);
    for (const int lost : {0, 1, 3}) {
        alive_[static_cast<size_t>(lost)] = false;
        balancer_->nodeLost(lost);
        expectWholePicture();
    }
    EXPECT_EQ(pixelsOf(2), int64_t{kWidth} * kHeight);
}

TEST_P(SplitTest, reassignsTheRangeOfALostNode) {
    begin(balanced(3, 3));
    for (int i = 0; i < 5; ++i) drawRanges(costlyFirst);
    alive_[1] = false;
    balancer_->nodeLost(1);
    expectAllDraws();
    for (int i = 0; i < 20; ++i) drawRanges(costlyFirst);
    expectAllDraws();
    alive_[1] = true;
    balancer_->nodeJoined(1);
    for (int i = 0; i < 20; ++i) drawRanges(costlyFirst);
    expectAllDraws();
}

TEST_P(SplitTest, keepsAnEvenLoad) {
    begin(balanced(4));
    for (int i = 0; i < 30; ++i) drawAreas(even);
    EXPECT_GT(efficiency_, .95);
}

INSTANTIATE_TEST_SUITE_P(Kinds, SplitTest,
                         ::testing::Values(balance::Balance::Auto, balance::Balance::Load, balance::Balance::Tree),
                         [](const auto& kind) {
                             return kind.param == balance::Balance::Auto   ? "CostMap"
                                    : kind.param == balance::Balance::Load ? "Load"
                                                                           : "Tree";
                         });

// Two areas of two ranges each: nodes 0 and 1 composite one, nodes 2 and 3 the other.
class GroupTest : public BalancerTest {
protected:
    void SetUp() override {
        SessionConfig config;
        config.configFile = std::string(MURAL_SOURCE_DIR) + "/configs/db-of-areas.eqc";
        config.allLocal = true;
        begin(config);
        ASSERT_EQ(plan_.nodes.size(), 4u);
        ASSERT_EQ(plan_.nodes[3].collector, 2);
    }
    void expectEqualAreas() const {
        EXPECT_EQ(areaOf(0), areaOf(1));
        EXPECT_EQ(areaOf(2), areaOf(3));
        EXPECT_EQ(pixelsOf(0) + pixelsOf(2), int64_t{kWidth} * kHeight);
    }
    // The second range costs `more` times as much as the first.
    void drawRanges(double more) {
        drawAreas([](double x, double) { return x < .25 ? 5 : 1; }, {}, {1, 1 / more, 1, 1 / more});
    }
};

TEST_F(GroupTest, dividesTheTimeOfTheSlowestRange) {
    for (int i = 0; i < 60; ++i) {
        drawRanges(3);
        if (!areas_.empty()) expectEqualAreas();
    }
    EXPECT_NEAR(static_cast<double>(pixelsOf(0)) / (kWidth * kHeight), .2, .05) << "both areas have half of the cost";
    EXPECT_GT(pixelsOf(2), pixelsOf(0));
}

TEST_F(GroupTest, leavesTheAreaOfALostNode) {
    for (int i = 0; i < 10; ++i) drawRanges(1);
    alive_[3] = false;
    balancer_->nodeLost(3);
    EXPECT_TRUE(areaOf(2).empty() && areaOf(3).empty()) << "the other node of the area lacks its range";
    expectEqualAreas();
    for (int i = 0; i < 10; ++i) drawRanges(1);
    alive_[3] = true;
    balancer_->nodeJoined(3);
    for (int i = 0; i < 40; ++i) drawRanges(1);
    EXPECT_FALSE(areaOf(2).empty());
    expectEqualAreas();
}

TEST_F(BalancerTest, doesNothingWithoutEqualizers) {
    SessionConfig config;
    config.columns = 2;
    begin(config);
    EXPECT_FALSE(balancer_->isActive());
    for (int i = 0; i < 5; ++i) drawAreas(corner);
    balancer_->nodeLost(0);
    EXPECT_TRUE(balancer_->totals().empty());
    EXPECT_TRUE(areas_.empty());
    EXPECT_TRUE(ranges_.empty());
}

TEST_F(BalancerTest, dividesNoFramesOfTimeMultiplexedNodes) {
    SessionConfig turns = chunksOf(2, 20);
    turns.passes.period = 2;
    turns.localNodes = 4;
    begin(turns);
    for (const EqualizerTotals& totals : balancer_->totals()) EXPECT_EQ(totals.division, Division::Frames) << totals.id;
    ASSERT_FALSE(plan_.warnings.empty());
    EXPECT_NE(plan_.warnings[0].find("in turn"), std::string::npos) << plan_.warnings[0];
}

TEST(RangeAssignment, roundTripsAndRejectsInvalidOnes) {
    const RangeAssignment ranges{3, {{0, .25}, {.25, .25}, {.25, 1}}};
    const auto bytes = bytesOf(ranges);
    EXPECT_EQ(sharesOf(bytes), ranges);
    for (size_t size = 0; size < bytes.size(); ++size) EXPECT_FALSE(sharesOf(std::span(bytes).first(size))) << size;
    for (const Range wrong :
         {Range{.5, .25}, Range{-.1, 1}, Range{0, 1.1}, Range{std::numeric_limits<double>::quiet_NaN(), 1},
          Range{0, std::numeric_limits<double>::quiet_NaN()}})
        EXPECT_FALSE(sharesOf(bytesOf(RangeAssignment{1, {wrong}})));
}

SessionConfig turns() {
    SessionConfig config;
    config.configFile = std::string(MURAL_SOURCE_DIR) + "/configs/dplex.eqc";
    config.allLocal = true;
    return config;
}

TEST_F(BalancerTest, pacesTheProgramByTheSlowestOfTheNodesThatDrawInTurn) {
    begin(turns());
    ASSERT_EQ(plan_.nodes.size(), 3u);
    constexpr double kMs = 100; // of finish()
    for (int i = 0; i < 30; ++i) {
        std::vector<double> busy(3, 0.05 * kMs);
        busy[static_cast<size_t>(i % 3)] = (i % 3 == 1 ? 90 : 60) * kMs;
        finish(busy);
    }
    ASSERT_FALSE(paces_.empty());
    EXPECT_EQ(paces_.back().first, client_);
    EXPECT_NEAR(paces_.back().second, 3 / 0.090 * 1.05, 0.1);
    const EqualizerTotals totals = balancer_->totals().at(0);
    EXPECT_EQ(totals.kind, "framerate_equalizer");
    EXPECT_EQ(totals.division, Division::Frames);
    EXPECT_EQ(totals.nodes.size(), 3u);
    EXPECT_NEAR(totals.framesPerSecond, paces_.back().second, 1e-9);
}

TEST_F(BalancerTest, pacesNoFastProgram) {
    begin(turns());
    for (int i = 0; i < 30; ++i) finish({100, 100, 100}); // 1 ms
    for (const auto& [client, framesPerSecond] : paces_) EXPECT_EQ(framesPerSecond, 0);
}

TEST_F(BalancerTest, endsThePaceOfAProgramThatIsNoLongerFollowed) {
    begin(turns());
    for (int i = 0; i < 30; ++i) finish({9000, 9000, 9000});
    ASSERT_FALSE(paces_.empty());
    EXPECT_GT(paces_.back().second, 0);
    const size_t before = paces_.size();
    balancer_->windowGone(client_, wire::kAllWindows);
    client_ = 2;
    finish({9000, 9000, 9000});
    ASSERT_GT(paces_.size(), before);
    EXPECT_EQ(paces_[before], (std::pair<uint32_t, double>{1, 0}));
}

// ---- zooms

class ZoomTest : public BalancerTest {
protected:
    void SetUp() override {
        SessionConfig config;
        config.configFile = std::string(MURAL_SOURCE_DIR) + "/configs/dfr.eqc";
        config.allLocal = true;
        begin(config);
        ASSERT_EQ(plan_.nodes.size(), 2u);
        ASSERT_TRUE(balancer_->movesZooms());
    }
    [[nodiscard]] double zoom() const { return areas_.empty() ? 1 : areas_.back().zoomOf(0); }
    void send(bool isRepeated) { balancer_->frameSent({client_, 1, ++sent_, isRepeated, nowNs_}); }
    // Both nodes draw a frame that takes this long at full resolution. fixedMs: the part that no zoom changes.
    void draw(double fullMs, double fixedMs = 0, uint32_t flags = 0) {
        send(false);
        const double drawn = flags == 0 ? zoom() * zoom() : 1;
        const auto tookNs = static_cast<int64_t>(1e6 * (fixedMs + drawn * fullMs));
        finish(tookNs, flags);
    }
    void finish(int64_t tookNs, uint32_t flags = 0) {
        nowNs_ += tookNs;
        wire::FrameDoneMessage m{};
        m.client = client_;
        m.window = 1;
        m.frame = sent_;
        m.width = kWidth;
        m.height = kHeight;
        m.areas = keptAreas_ ? keptAreas_ : areas_.empty() ? 0 : areas_.back().number;
        m.flags = flags;
        m.busyNs = static_cast<uint64_t>(tookNs);
        for (int node = 0; node < 2; ++node) balancer_->frameDone(node, m, nowNs_);
        tookMs_ = static_cast<double>(tookNs) / 1e6;
    }

    uint32_t sent_ = 0;
    uint32_t keptAreas_ = 0; // number of the areas of all frames; 0: the latest
    int64_t nowNs_ = 1'000'000'000;
    double tookMs_ = 0;
};

TEST_F(ZoomTest, holdsTheRateAfterAStepOfTheLoad) {
    constexpr double kTargetMs = 1000. / 15;
    for (const double fullMs : {20., 150., 90., 20.}) {
        for (int i = 0; i < 10; ++i) draw(fullMs, 5);
        for (int i = 0; i < 30; ++i) {
            draw(fullMs, 5);
            if (fullMs + 5 < kTargetMs)
                EXPECT_EQ(zoom(), 1);
            else
                EXPECT_NEAR(tookMs_ / kTargetMs, 1, .1) << fullMs;
        }
    }
    const EqualizerTotals totals = balancer_->totals().at(0);
    EXPECT_EQ(totals.division, Division::Zooms);
    EXPECT_EQ(totals.kind, "DFR_equalizer");
    EXPECT_EQ(totals.zoom, zoom());
    EXPECT_GT(totals.moves, 0);
    EXPECT_LT(totals.moves, 60) << "a settled zoom stays";
}

TEST_F(ZoomTest, announcesFullResolutionBeforeTheFrameAfterARepeatedOne) {
    for (int i = 0; i < 20; ++i) draw(300);
    const double moving = zoom();
    EXPECT_LT(moving, .6);
    send(false);
    const size_t announced = areas_.size();
    send(true); // while both frames are in progress
    ASSERT_EQ(areas_.size(), announced + 1);
    EXPECT_EQ(zoom(), 1);
    finish(300'000'000);
    EXPECT_EQ(zoom(), 1) << "slow frames are right while nothing moves";
    send(false);
    EXPECT_NEAR(zoom(), moving, .05) << "it moves again";
}

TEST_F(ZoomTest, requestsOneRedrawOfACoarsePictureThatStandsStill) {
    for (int i = 0; i < 20; ++i) draw(300);
    balancer_->tick(nowNs_ + 100'000'000);
    EXPECT_EQ(redraws_, 0);
    for (int i = 0; i < 5; ++i) balancer_->tick(nowNs_ + 500'000'000 + i);
    EXPECT_EQ(redraws_, 1);
    nowNs_ += 600'000'000;
    keptAreas_ = areas_.back().number; // full resolution; its end announces the zoom of the next frame
    draw(300);
    keptAreas_ = 0;
    for (int i = 0; i < 5; ++i) balancer_->tick(nowNs_ + 500'000'000 + i);
    EXPECT_EQ(redraws_, 1) << "the picture is no longer coarse";
    for (int i = 0; i < 20; ++i) draw(300);
    balancer_->tick(nowNs_ + 500'000'000);
    EXPECT_EQ(redraws_, 2) << "it has moved again";
}

TEST_F(ZoomTest, requestsNoRedrawThatWouldBeCoarse) {
    for (int i = 0; i < 20; ++i) draw(300);
    ASSERT_TRUE(balancer_->freeze(balancer_->totals().at(0).id, true).ok());
    balancer_->tick(nowNs_ + 500'000'000);
    EXPECT_EQ(redraws_, 0) << "the zoom is frozen";
}

TEST_F(ZoomTest, requestsNoRedrawForeverOfAProgramThatKeepsTheZoom) {
    for (int i = 0; i < 20; ++i) draw(300);
    const uint32_t coarse = areas_.back().number;
    for (int i = 0; i < 10; ++i) {
        balancer_->tick(nowNs_ + 500'000'000);
        nowNs_ += 600'000'000;
        send(false);
        keptAreas_ = coarse;
        finish(10'000'000);
    }
    EXPECT_LE(redraws_, 2);
}

TEST_F(ZoomTest, announcesFullResolutionWhenNoFramesFollow) {
    for (int i = 0; i < 20; ++i) draw(300);
    const double moving = zoom();
    balancer_->tick(nowNs_ + 100'000'000);
    EXPECT_EQ(zoom(), moving);
    balancer_->tick(nowNs_ + 500'000'000);
    EXPECT_EQ(zoom(), 1);
    nowNs_ += 5'000'000'000;
    send(false);
    finish(300'000'000);
    EXPECT_NEAR(zoom(), moving, .05) << "the pause is no frame's time";
    send(false);
    balancer_->tick(nowNs_ + 5'000'000'000);
    EXPECT_NEAR(zoom(), moving, .05) << "nodes draw for long, but the program waits for them";
}

TEST_F(ZoomTest, ignoresOtherWindowsAndPrograms) {
    for (int i = 0; i < 20; ++i) draw(300);
    const double moving = zoom();
    balancer_->frameSent({client_, 2, 100, true, nowNs_});
    balancer_->frameSent({client_ + 1, 1, 100, true, nowNs_});
    EXPECT_EQ(zoom(), moving);
}

TEST_F(ZoomTest, measuresFramesWithoutZoomAsThose) {
    for (int i = 0; i < 20; ++i) draw(50, 0, wire::kDrawnUnzoomed);
    EXPECT_EQ(zoom(), 1);
    for (int i = 0; i < 20; ++i) draw(300, 0, wire::kDrawnUnzoomed);
    EXPECT_NEAR(zoom(), std::sqrt(1000. / 15 / 300), .03) << "not less and less";
}

TEST_F(ZoomTest, keepsAFrozenZoomAndAnnouncesItToReturningNodes) {
    for (int i = 0; i < 20; ++i) draw(300);
    const double moving = zoom();
    const std::string name = balancer_->totals().at(0).id;
    ASSERT_TRUE(balancer_->freeze(name, true).ok());
    ASSERT_TRUE(balancer_->set(name, "framerate", "1").ok());
    for (int i = 0; i < 20; ++i) draw(300);
    send(true);
    EXPECT_EQ(zoom(), moving);
    const size_t announced = areas_.size();
    balancer_->nodeLost(1);
    balancer_->nodeJoined(1);
    EXPECT_GT(areas_.size(), announced);
    EXPECT_EQ(zoom(), moving);
}

} // namespace
} // namespace mural
