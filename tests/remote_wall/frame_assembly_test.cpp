// Assembly of frames from the tiles of several sources.
#include <gtest/gtest.h>

#include "nodes/remote_wall/frame_assembly.hpp"

namespace mural::remote {
namespace {

constexpr PictureSize kSize{128, 64, 1};

class FrameAssemblyTest : public ::testing::Test {
protected:
    static Tile tile(uint64_t frame, int x) { return {frame, kSize, 0, {x, 0, 64, 64}, 0, {}}; }
    static FrameEnd ended(uint64_t frame, uint32_t tiles, bool isWhole = false) {
        return {frame, kSize, tiles, isWhole, frame};
    }
    // Source 0 has the left half, source 1 the right one.
    bool send(uint32_t source, uint64_t frame, bool isWhole = false) {
        return assembly_.add(source, tile(frame, source == 0 ? 0 : 64)) &&
               assembly_.end(source, ended(frame, 1, isWhole));
    }
    std::vector<uint64_t> complete() {
        std::vector<uint64_t> numbers;
        for (const CompleteFrame& frame : assembly_.takeComplete()) numbers.push_back(frame.number);
        return numbers;
    }
    using Numbers = std::vector<uint64_t>;
    FrameAssembly assembly_{2};
};

TEST_F(FrameAssemblyTest, completesAFrameWithItsLastSource) {
    ASSERT_TRUE(send(0, 1, true));
    EXPECT_TRUE(complete().empty());
    ASSERT_TRUE(send(1, 1, true));
    const auto frames = assembly_.takeComplete();
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].tiles.size(), 2U);
    EXPECT_EQ(frames[0].wallFrame, 1U);
    EXPECT_EQ(assembly_.incomplete(), 0U);
}

TEST_F(FrameAssemblyTest, acceptsFramesWithoutTiles) {
    ASSERT_TRUE(send(0, 1, true) && send(1, 1, true));
    ASSERT_TRUE(assembly_.end(0, ended(2, 0)) && assembly_.end(1, ended(2, 0)));
    EXPECT_EQ(complete(), (Numbers{1, 2}));
}

TEST_F(FrameAssemblyTest, beginsWithAWholeFrame) {
    ASSERT_TRUE(send(0, 1) && send(1, 1));
    EXPECT_TRUE(complete().empty());
    EXPECT_FALSE(assembly_.takeLoss()); // the sources begin with whole frames
}

TEST_F(FrameAssemblyTest, keepsThreeIncompleteFrames) {
    ASSERT_TRUE(send(0, 1, true) && send(1, 1, true));
    for (const uint64_t frame : {2, 3, 4, 5}) ASSERT_TRUE(send(0, frame));
    EXPECT_EQ(assembly_.incomplete(), FrameAssembly::kMaxIncomplete);
    EXPECT_TRUE(assembly_.takeLoss());
    EXPECT_FALSE(assembly_.takeLoss());
    for (const uint64_t frame : {2, 3, 4, 5}) ASSERT_TRUE(send(1, frame));
    EXPECT_EQ(complete(), (Numbers{1})); // the others lack the tiles of frame 2
    ASSERT_TRUE(send(0, 6, true) && send(1, 6, true));
    ASSERT_TRUE(send(0, 7) && send(1, 7));
    EXPECT_EQ(complete(), (Numbers{6, 7}));
}

TEST_F(FrameAssemblyTest, dropsFramesThatASourceHasSkipped) {
    ASSERT_TRUE(send(0, 1, true) && send(1, 1, true));
    ASSERT_TRUE(send(0, 2));
    ASSERT_TRUE(send(1, 3) && send(0, 3));
    EXPECT_EQ(complete(), (Numbers{1}));
    EXPECT_TRUE(assembly_.takeLoss());
    EXPECT_EQ(assembly_.incomplete(), 0U);
}

TEST_F(FrameAssemblyTest, rejectsDisorder) {
    ASSERT_TRUE(send(0, 5, true));
    EXPECT_FALSE(assembly_.add(0, tile(5, 0)));
    EXPECT_FALSE(assembly_.end(0, ended(4, 0)));
    EXPECT_FALSE(assembly_.add(2, tile(6, 0)));                   // there are two sources
    EXPECT_FALSE(assembly_.end(1, ended(5, 3)));                  // without its tiles
    EXPECT_FALSE(assembly_.end(1, {5, {64, 64, 1}, 0, true, 5})); // of another size
}

TEST_F(FrameAssemblyTest, boundsTheTilesOfAFrame) {
    ASSERT_TRUE(assembly_.add(0, tile(1, 0)) && assembly_.add(0, tile(1, 0)));
    EXPECT_FALSE(assembly_.add(0, tile(1, 0)));
}

} // namespace
} // namespace mural::remote
