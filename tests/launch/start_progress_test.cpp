#include "nodes/head/membership/start_progress.hpp"

#include <gtest/gtest.h>

#include "common/base/clock.hpp"

namespace mural {
namespace {

constexpr int64_t kBegin = 1'000 * kNsPerS;

int64_t at(double seconds) { return kBegin + static_cast<int64_t>(seconds * static_cast<double>(kNsPerS)); }

std::string whyOf(int node) { return node == 1 ? "no route" : ""; }

TEST(StartProgress, showsLateNodesOnceAfterFiveSeconds) {
    StartProgress progress(kBegin);
    progress.add(0, "wall1");
    progress.add(1, "wall2.example");
    progress.reached(0, StartStep::Connected, at(0.5));
    progress.reached(1, StartStep::Launched, at(0.1));
    EXPECT_TRUE(progress.news(StartStep::Connected, at(4.9), whyOf).empty());
    const auto lines = progress.news(StartStep::Connected, at(5.1), whyOf);
    ASSERT_EQ(lines.size(), 3U);
    EXPECT_EQ(lines[0], "1 of 2 nodes is late, 5.1 s after the start:");
    EXPECT_EQ(lines[1], "node  host          launched    connected   waits for");
    EXPECT_EQ(lines[2], "1     wall2.example 0.1 s       -           its connection: no route");
    EXPECT_TRUE(progress.news(StartStep::Connected, at(9), whyOf).empty());
}

TEST(StartProgress, reportsNodesThatHaveCaughtUp) {
    StartProgress progress(kBegin);
    for (int node = 0; node < 3; ++node) progress.add(node, "wall" + std::to_string(node + 1));
    progress.reached(0, StartStep::Connected, at(1));
    EXPECT_EQ(progress.news(StartStep::Connected, at(6), whyOf).size(), 4U);
    progress.reached(1, StartStep::Connected, at(7.2));
    using Lines = std::vector<std::string>;
    EXPECT_EQ(progress.news(StartStep::GlReady, at(7.5), whyOf),
              Lines{"node 1 (wall2) has caught up: connected 7.2 s after the start"});
    EXPECT_TRUE(progress.news(StartStep::GlReady, at(7.6), whyOf).empty());
    progress.giveUp(2);
    progress.reached(0, StartStep::GlReady, at(8));
    EXPECT_EQ(progress.news(StartStep::GlReady, at(13), whyOf).size(), 3U);
    progress.reached(1, StartStep::FirstFrame, at(14));
    EXPECT_EQ(progress.news(StartStep::FirstFrame, at(14), whyOf),
              Lines{"node 1 (wall2) has caught up: GL ready 14.0 s after the start"});
}

TEST(StartProgress, expectsGlAfterTheLastConnection) {
    StartProgress progress(kBegin);
    progress.add(0, "wall1");
    progress.add(1, "wall2");
    progress.reached(0, StartStep::GlReady, at(1));
    progress.reached(1, StartStep::Connected, at(8));
    EXPECT_FALSE(progress.isLate(StartStep::GlReady, at(12)));
    EXPECT_TRUE(progress.isLate(StartStep::GlReady, at(13.1)));
}

TEST(StartProgress, expectsFramesAfterTheFirstOfAnyNode) {
    StartProgress progress(kBegin);
    progress.add(0, "wall1");
    progress.add(1, "wall2");
    EXPECT_FALSE(progress.isLate(StartStep::FirstFrame, at(1000)));
    progress.reached(0, StartStep::FirstFrame, at(1000));
    EXPECT_FALSE(progress.isLate(StartStep::FirstFrame, at(1004)));
    EXPECT_TRUE(progress.isLate(StartStep::FirstFrame, at(1006)));
    progress.giveUp(1);
    EXPECT_FALSE(progress.isLate(StartStep::FirstFrame, at(1006)));
}

} // namespace
} // namespace mural
