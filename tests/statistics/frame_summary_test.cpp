// Means of the stages.
#include "tools/mural/stat/frame_summary.hpp"

#include <gtest/gtest.h>

#include "tests/statistics/sample_frames.hpp"

namespace mural::cli {
namespace {

TEST(FrameSummary, hasTheMeanOfEachStage) {
    const FrameSummary summary = summarize(sampleFrames().frames);
    EXPECT_EQ(summary.frames, 3u);
    EXPECT_DOUBLE_EQ(summary.frameMs, 10);
    EXPECT_DOUBLE_EQ(summary.framesPerSecond, 100);
    const StageMeans& node = summary.stages.at({SpanProcess::Node, 1});
    EXPECT_NEAR(node[static_cast<size_t>(SpanKind::Replay)], 4, 1e-9);
    EXPECT_NEAR(node[static_cast<size_t>(SpanKind::Readback)], 1, 1e-9);
    EXPECT_NEAR(summary.stages.at({SpanProcess::Head, 0})[static_cast<size_t>(SpanKind::Assemble)], 2, 1e-9);
}

TEST(FrameSummary, namesTheSlowestStageThatIsNoWait) {
    const FrameSummary::Slowest slowest = summarize(sampleFrames().frames).slowest();
    EXPECT_EQ(slowest.stage, "replay");
    EXPECT_EQ(slowest.where, "node 1");
    EXPECT_NEAR(slowest.ms, 4, 1e-9);
}

TEST(FrameSummary, ignoresTheRateOfOtherPrograms) {
    std::vector<FrameRecord> frames = sampleFrames().frames;
    FrameRecord other = frames.front();
    other.client = 2;
    other.doneNs += 77'000'000'000;
    frames.push_back(other);
    EXPECT_DOUBLE_EQ(summarize(frames).frameMs, 10);
}

TEST(FrameSummary, printsALinePerNode) {
    const auto lines = summaryLines(summarize(sampleFrames().frames));
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_NE(lines[0].find("10.00 ms, 100.0 frames/s; slowest stage: replay on node 1, 4.00 ms"), std::string::npos)
        << lines[0];
    EXPECT_NE(lines[3].find("node 1"), std::string::npos);
    EXPECT_NE(lines[3].find("packets"), std::string::npos) << lines[3];
    EXPECT_EQ(summaryLines(summarize({})).size(), 1u);
}

} // namespace
} // namespace mural::cli
