#include "tools/mural/record_costs/frame_work.hpp"

#include <sstream>

#include <gtest/gtest.h>

namespace mural::cli {
namespace {

std::string lineOf(int window, int frame, int node, double seconds, int width = 100) {
    std::ostringstream line;
    line << R"({"client":1,"window":)" << window << R"(,"frame":)" << frame << R"(,"width":)" << width
         << R"(,"height":100,"node":)" << node << R"(,"busySeconds":)" << seconds << "}\n";
    return line.str();
}

TEST(FrameWork, takesTheWindowWithTheMostPixels) {
    std::istringstream in(lineOf(1, 1, 0, .5, 20) + lineOf(2, 1, 0, .25) + lineOf(1, 2, 0, .75, 20));
    const auto work = readFrameWork(in, 1, 1);
    ASSERT_TRUE(work.ok());
    ASSERT_EQ(work->size(), 1u);
    EXPECT_EQ(work->at(1), std::vector<double>{.25});
}

TEST(FrameWork, leavesOutFramesThatSomeNodeLacksAndFirstFrames) {
    std::istringstream in(lineOf(1, 1, 0, 1) + lineOf(1, 1, 1, 1) + lineOf(1, 3, 1, .5) + lineOf(1, 2, 1, 2) +
                          lineOf(1, 2, 0, 3));
    const auto work = readFrameWork(in, 2, 2);
    ASSERT_TRUE(work.ok());
    ASSERT_EQ(work->size(), 1u);
    EXPECT_EQ(work->at(2), (std::vector<double>{3, 2})); // in the order of the nodes
}

TEST(FrameWork, namesABadLine) {
    std::istringstream half(lineOf(1, 1, 0, 1) + R"({"client":1,"fra)");
    EXPECT_EQ(readFrameWork(half, 1, 1).error().message, "line 2 is no JSON object");
    std::istringstream lacks(R"({"client":1,"frame":2,"node":0})");
    EXPECT_EQ(readFrameWork(lacks, 1, 1).error().message, "line 1 has no frame, node or busySeconds");
    std::istringstream nothing;
    EXPECT_TRUE(readFrameWork(nothing, 1, 1)->empty());
}

} // namespace
} // namespace mural::cli
