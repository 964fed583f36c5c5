#include <gtest/gtest.h>

#include "nodes/head/statistics/overlay_numbers.hpp"

namespace mural {
namespace {

constexpr int64_t kRecordMs = 1'000'000;

FrameRecord frame(uint64_t number) {
    const auto begin = static_cast<int64_t>(number) * 10 * kRecordMs;
    FrameRecord record;
    record.number = number;
    record.frame = static_cast<uint32_t>(number) + 5;
    record.doneNs = begin + 10 * kRecordMs;
    record.tracks = {{SpanProcess::Node,
                      1,
                      "replay",
                      {{SpanKind::Replay, begin, begin + 4 * kRecordMs},
                       {SpanKind::WaitPackets, begin + 4 * kRecordMs, begin + 10 * kRecordMs}}},
                     {SpanProcess::Node,
                      1,
                      "pictures",
                      {{SpanKind::WaitFrame, begin, begin + 9 * kRecordMs},
                       {SpanKind::Compress, begin + 9 * kRecordMs, begin + 10 * kRecordMs}}},
                     {SpanProcess::Head,
                      1,
                      "reader",
                      {{SpanKind::WaitNode, begin, begin + 8 * kRecordMs},
                       {SpanKind::Assemble, begin + 8 * kRecordMs, begin + 10 * kRecordMs}}},
                     {SpanProcess::Head, 0, "output", {{SpanKind::Output, begin, begin + 10 * kRecordMs}}},
                     {SpanProcess::Program, 0, "gl", {{SpanKind::Capture, begin, begin + 10 * kRecordMs}}}};
    return record;
}

TEST(OverlayNumbers, belongToTheirNode) {
    OverlayNumbers numbers({{0, "node 0 on a"}, {1, "node 1 on b"}});
    numbers.add({frame(1), frame(2)});
    ASSERT_EQ(numbers.nodes().size(), 2U);
    EXPECT_EQ(numbers.nodes()[1].name, "node 1 on b");
    EXPECT_TRUE(numbers.nodes()[0].frames.frames().empty());
    const FrameHistory history = numbers.nodes()[1].frames;
    ASSERT_EQ(history.frames().size(), 2U);
    EXPECT_EQ(history.frames().back().frame, 7U);
    EXPECT_DOUBLE_EQ(history.meanMs(FramePart::Replay), 4);
    EXPECT_DOUBLE_EQ(history.meanMs(FramePart::Wait), 6);
    EXPECT_DOUBLE_EQ(history.meanMs(FramePart::Compress), 1);
    EXPECT_DOUBLE_EQ(history.meanMs(FramePart::Assemble), 2);
    EXPECT_DOUBLE_EQ(history.framesPerSecond(), 100);
}

TEST(OverlayNumbers, countFramesOnce) {
    OverlayNumbers numbers({{1, "node 1"}, {4, "node 4"}});
    numbers.add({frame(1), frame(2)});
    EXPECT_EQ(numbers.next(), 3U);
    numbers.add({frame(2), frame(3)});
    EXPECT_EQ(numbers.nodes()[0].frames.frames().size(), 3U);
}

TEST(OverlayNumbers, ignoreUnknownNodes) {
    OverlayNumbers numbers({{0, "node 0"}});
    numbers.add({frame(1)});
    EXPECT_TRUE(numbers.nodes()[0].frames.frames().empty());
}

} // namespace
} // namespace mural
