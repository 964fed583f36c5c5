// The frame tracker: completion of frames by several nodes, and credit for the program.
#include "nodes/head/frames/frame_tracker.hpp"
#include "streamcodec/wire/node_messages.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace mural {
namespace {

class FrameTrackerTest : public testing::Test {
protected:
    FrameTracker tracker{2, [this](uint32_t client, uint32_t finished, uint32_t shown) {
                             credits.push_back({client, finished, shown});
                         }};
    std::vector<std::vector<uint32_t>> credits; // {client, finished, shown}

    bool done(int node, uint32_t frame, uint32_t window = 1, uint32_t width = 64, uint32_t client = 1) {
        wire::FrameDoneMessage m{};
        m.client = client;
        m.window = window;
        m.frame = frame;
        m.width = width;
        m.height = 10;
        return tracker.frameDone(node, m, frame).ok();
    }
    using Credits = std::vector<std::vector<uint32_t>>;
};

TEST_F(FrameTrackerTest, followsTheSlowestNode) {
    done(0, 1);
    done(0, 2);
    EXPECT_TRUE(credits.empty());
    done(1, 1);
    EXPECT_EQ(credits, (Credits{{1, 1, 1}}));
    done(1, 2);
    EXPECT_EQ(credits.back(), (std::vector<uint32_t>{1, 2, 2}));
}

TEST_F(FrameTrackerTest, waitsForAnAddedNodeFromItsMembershipOn) {
    done(0, 1);
    tracker.addNodes(1);
    done(1, 1);
    EXPECT_EQ(credits.back(), (std::vector<uint32_t>{1, 1, 1}));
    tracker.nodeJoins(2);
    tracker.nodeJoined(2, {{1, 1}}, 0);
    done(0, 2);
    done(1, 2);
    EXPECT_EQ(credits.back(), (std::vector<uint32_t>{1, 1, 1}));
    done(2, 2);
    EXPECT_EQ(credits.back(), (std::vector<uint32_t>{1, 2, 2}));
}

TEST_F(FrameTrackerTest, doesNotWaitForALostNode) {
    done(0, 1);
    done(0, 2);
    tracker.nodeLost(1, 5);
    EXPECT_EQ(credits, (Credits{{1, 2, 2}}));
    done(0, 3);
    EXPECT_EQ(credits.back()[1], 3u);
    tracker.nodeLost(0, 6); // no node left: no credit
    EXPECT_EQ(credits.size(), 2u);
}

TEST_F(FrameTrackerTest, countsAllDrawablesOfTheMainWindowsXWindow) {
    constexpr uint64_t kXWindow = 0x200001;
    tracker.isOn(1, 1, kXWindow);
    tracker.isOn(1, 2, kXWindow);
    tracker.isOn(1, 3, kXWindow + 1);
    for (const int node : {0, 1}) {
        done(node, 1, 1);
        done(node, 2, 2); // as large, and on the same X window
        done(node, 3, 3); // as large, elsewhere
        done(node, 4, 1);
    }
    EXPECT_EQ(tracker.totals().wallFrames, 3);
}

TEST_F(FrameTrackerTest, acceptsReorderedFramesOfSeveralThreads) {
    for (const int node : {0, 1}) {
        done(node, 2);
        done(node, 3);
    }
    EXPECT_TRUE(credits.empty());
    done(0, 1);
    done(1, 1);
    EXPECT_EQ(credits, (Credits{{1, 3, 3}}));
}

TEST_F(FrameTrackerTest, skipsAFrameThatNeverComes) {
    for (uint32_t frame = 2; frame < 30; ++frame)
        for (const int node : {0, 1}) done(node, frame);
    ASSERT_FALSE(credits.empty());
    EXPECT_EQ(credits.back()[1], 29u);
}

TEST_F(FrameTrackerTest, delaysOnlyShownFramesForHeldPictures) {
    tracker.delayPicture(1, 1);
    tracker.delayPicture(1, 2);
    for (const uint32_t frame : {1u, 2u})
        for (const int node : {0, 1}) done(node, frame);
    EXPECT_EQ(credits, (Credits{{1, 1, 0}, {1, 2, 0}}));
    tracker.pictureReleased(1, 1);
    EXPECT_EQ(credits.back(), (std::vector<uint32_t>{1, 2, 1}));
    tracker.pictureReleased(1, 2);
    EXPECT_EQ(credits.back(), (std::vector<uint32_t>{1, 2, 2}));
}

TEST_F(FrameTrackerTest, rejectsARepeatedFrame) {
    EXPECT_TRUE(done(0, 1));
    EXPECT_FALSE(done(0, 1));
    EXPECT_FALSE(done(0, 0));
}

TEST_F(FrameTrackerTest, countsProgramsSeparately) {
    done(0, 1, 1, 64, 1);
    done(1, 1, 1, 64, 2);
    EXPECT_TRUE(credits.empty());
    done(1, 1, 1, 64, 1);
    EXPECT_EQ(credits, (Credits{{1, 1, 1}}));
}

TEST_F(FrameTrackerTest, treatsTheLargestWindowAsTheWall) {
    uint32_t frame = 0;
    const auto both = [&](uint32_t window, uint32_t width) {
        ++frame;
        done(0, frame, window, width);
        done(1, frame, window, width);
        return tracker.totals().wallFrames;
    };
    EXPECT_EQ(both(1, 10), 1); // a splash screen
    EXPECT_EQ(both(1, 10), 2);
    EXPECT_EQ(both(2, 50), 3); // the real window: the wall's frames continue
    EXPECT_EQ(both(1, 10), 3);
    EXPECT_EQ(both(3, 50), 3); // equal size: not larger
    EXPECT_EQ(both(2, 20), 4); // made smaller
    EXPECT_EQ(both(3, 50), 5);
    EXPECT_EQ(tracker.totals().firstNs, 1);
    EXPECT_EQ(tracker.totals().latestNs, 7);
    tracker.windowGone(1, 3);
    EXPECT_EQ(both(1, 10), 5); // the largest remaining window is next
    EXPECT_EQ(both(2, 20), 6);
    tracker.windowGone(1, 1); // another one
    EXPECT_EQ(both(2, 20), 7);
    tracker.clientGone(1);
    done(0, 1, 9, 5, 2);
    done(1, 1, 9, 5, 2);
    EXPECT_EQ(tracker.totals().wallFrames, 8);
}

} // namespace
} // namespace mural
