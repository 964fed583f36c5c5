// The plans of a session one after the other: the order of pictures, and the receivers of assignments.
#include "nodes/head/session/plan_sequence.hpp"

#include <cstring>
#include <gtest/gtest.h>

#include "nodes/head/planning/plan_change.hpp"

namespace mural {
namespace {

class PlanSequenceTest : public testing::Test {
protected:
    PlanSequenceTest() {
        config.columns = 2;
        config.display = Display::App;
        plans = std::make_unique<PlanSequence>(
            config, planSession(config, "me"),
            PlanSequence::Hooks{[this](const WindowPicture& p) { whole.push_back(p.frame); },
                                [this](WindowPicture p) { shown.push_back(p.frame); },
                                [this] { ++closed; },
                                {[this](const ViewportAssignment&) { ++announced; },
                                 [this](const RangeAssignment&) { ++announced; },
                                 {}}});
    }
    // Prepares a stage with three tiles; nodes 2 to 4 draw them.
    std::shared_ptr<SessionStage> prepare() {
        SessionConfig wanted = config;
        wanted.columns = 3;
        const auto current = plans->current();
        auto change = changeOf(
            {current->config, current->plan, plans->outputs()}, wanted, planSession(wanted, "me"),
            [](int) { return true; }, plans->nodeCount());
        EXPECT_TRUE(change.ok());
        return plans->prepare(wanted, change->plan);
    }
    void changeTo(const std::shared_ptr<SessionStage>& next) {
        plans->change(next, {}, {0, 1}, 1);
        for (int node = 2; node < 5; ++node) {
            plans->nodeJoins(node, static_cast<uint32_t>(node));
            plans->nodeInView(node, static_cast<uint32_t>(node));
        }
    }
    // The node sends its part of a window of 6 x 1 pixels, and ends the frame.
    void draw(int node, uint32_t frame) {
        const auto stage = plans->of(node);
        PictureAssembler& pictures = stage->pictures;
        const wire::PictureHeader header{1, 1, frame, 0, 0, 1, 1, 6, 1, 0xabc, 0, 0};
        ASSERT_TRUE(pictures.part(node, header, ByteBuffer::ofSize(4)).ok());
        pictures.frameDone(node, 1, 1, frame);
    }

    using Frames = std::vector<uint32_t>;
    SessionConfig config;
    Frames whole, shown;
    int closed = 0, announced = 0;
    std::unique_ptr<PlanSequence> plans;
};

TEST_F(PlanSequenceTest, showsPicturesOfTheNextPlanAfterThoseOfTheEarlierOne) {
    draw(0, 1);
    const auto next = prepare();
    EXPECT_EQ(plans->of(0), plans->current());
    EXPECT_EQ(plans->of(4), next) << "it joins this one";
    changeTo(next);
    EXPECT_FALSE(plans->isSettled());
    for (int node = 2; node < 5; ++node) draw(node, 3);
    EXPECT_EQ(whole, Frames{3});
    EXPECT_TRUE(shown.empty()) << "earlier frames are incomplete";
    draw(0, 2);
    draw(1, 1);
    EXPECT_EQ(shown, Frames{1});
    plans->nodeLost(0); // has left
    draw(1, 2);
    EXPECT_EQ(shown, (Frames{1, 2}));
    plans->nodeLost(1);
    EXPECT_EQ(shown, (Frames{1, 2, 3}));
    EXPECT_TRUE(plans->isSettled());
    for (int node = 2; node < 5; ++node) draw(node, 4);
    EXPECT_EQ(shown, (Frames{1, 2, 3, 4}));
    EXPECT_EQ(whole, (Frames{3, 1, 2, 4}));
}

TEST_F(PlanSequenceTest, doesNotWaitForNodesOfAPlanThatIsPreparedOnly) {
    prepare();
    draw(0, 1);
    draw(1, 1);
    EXPECT_EQ(shown, Frames{1});
    EXPECT_TRUE(plans->isSettled());
    EXPECT_EQ(plans->nodeCount(), 5);
}

TEST_F(PlanSequenceTest, movesAKeptNodeWhenItPassesTheChange) {
    const auto next = plans->prepare(config, plans->current()->plan);
    const auto first = plans->current();
    plans->change(next, {0, 1}, {}, 7);
    EXPECT_EQ(plans->of(0), first);
    draw(0, 1);
    plans->nodeInView(0, 7);
    EXPECT_EQ(plans->of(0), next);
    draw(0, 2);
    EXPECT_FALSE(plans->isSettled());
    draw(1, 1);
    EXPECT_EQ(shown, Frames{1});
    plans->nodeInView(1, 7);
    EXPECT_TRUE(plans->isSettled());
    draw(1, 2);
    EXPECT_EQ(shown, (Frames{1, 2}));
}

TEST_F(PlanSequenceTest, goesOnWithoutAKeptNodeThatIsLost) {
    const auto next = plans->prepare(config, plans->current()->plan);
    plans->change(next, {0, 1}, {}, 7);
    plans->nodeInView(0, 7);
    plans->nodeLost(1);
    EXPECT_TRUE(plans->isSettled());
    draw(0, 1);
    EXPECT_EQ(shown, Frames{1});
}

TEST_F(PlanSequenceTest, dropsStagesThatAreOverOrNeverBecameCurrent) {
    const std::weak_ptr first = plans->current();
    const std::weak_ptr failed = prepare();
    std::weak_ptr second = prepare();
    EXPECT_TRUE(failed.expired());
    EXPECT_TRUE(plans->nodePlan(3)->isVacant) << "a node of the failed change";
    plans->change(second.lock(), {}, {0, 1}, 1);
    plans->nodeLost(0);
    plans->nodeLost(1);
    EXPECT_FALSE(plans->nodePlan(1)->isVacant) << "until the next change";
    const auto third = plans->prepare(config, plans->current()->plan);
    plans->change(third, {5, 6, 7}, {}, 2);
    EXPECT_TRUE(first.expired());
    EXPECT_TRUE(plans->nodePlan(1)->isVacant);
    for (int node = 5; node < 8; ++node) plans->nodeInView(node, 2);
    EXPECT_FALSE(second.expired());
    plans->change(plans->prepare(config, third->plan), {5, 6, 7}, {}, 3);
    EXPECT_TRUE(second.expired());
}

TEST_F(PlanSequenceTest, closesTheHeadsWindowsWhenNodesShowTheWall) {
    config.display = Display::Windows;
    config.passes.kernelWidth = 2; // the head combines the pixels of both nodes
    plans = std::make_unique<PlanSequence>(
        config, planSession(config, "me"),
        PlanSequence::Hooks{[](const WindowPicture&) {}, [](WindowPicture) {}, [this] { ++closed; }, {}});
    ASSERT_TRUE(plans->current()->ownsWallWindows);
    SessionConfig wanted = config;
    wanted.passes.kernelWidth = 1;
    const int before = plans->nodeCount();
    SessionPlan plan = planSession(wanted, "me");
    auto change = changeOf(
        {config, plans->current()->plan, plans->outputs()}, wanted, std::move(plan), [](int) { return true; }, before);
    ASSERT_TRUE(change.ok());
    const auto next = plans->prepare(wanted, change->plan);
    ASSERT_FALSE(next->ownsWallWindows);
    plans->change(next, {}, change->leaving, 1);
    EXPECT_EQ(closed, 0) << "the last pictures are not shown yet";
    for (const int node : change->leaving) plans->nodeLost(node);
    EXPECT_EQ(closed, 1);
}

} // namespace
} // namespace mural
