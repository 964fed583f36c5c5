#include <gtest/gtest.h>

#include "nodes/overlay/frame_parts.hpp"

namespace mural {
namespace {

constexpr int64_t kMs = 1'000'000;

double msOf(const FrameParts& parts, FramePart part) { return parts.ms[static_cast<size_t>(part)]; }

TEST(FrameParts, addTheSpansOfThreads) {
    FrameParts parts;
    addParts(parts,
             std::vector<Span>{{SpanKind::WaitPackets, 0, 3 * kMs},
                               {SpanKind::Receive, 3 * kMs, 4 * kMs},
                               {SpanKind::Replay, 4 * kMs, 9 * kMs},
                               {SpanKind::WaitBarrier, 9 * kMs, 10 * kMs}},
             true);
    addParts(parts, std::vector<Span>{{SpanKind::WaitFrame, 0, 8 * kMs}, {SpanKind::Transfer, 8 * kMs, 10 * kMs}},
             false);
    EXPECT_DOUBLE_EQ(msOf(parts, FramePart::Wait), 4); // without the other thread's wait
    EXPECT_DOUBLE_EQ(msOf(parts, FramePart::Decode), 1);
    EXPECT_DOUBLE_EQ(msOf(parts, FramePart::Replay), 5);
    EXPECT_DOUBLE_EQ(msOf(parts, FramePart::Transfer), 2);
    EXPECT_DOUBLE_EQ(parts.totalMs(), 12);
}

TEST(FrameParts, leaveOutTheWorkOfPrograms) {
    FrameParts parts;
    addParts(parts,
             std::vector<Span>{
                 {SpanKind::Capture, 0, kMs}, {SpanKind::Encode, kMs, 2 * kMs}, {SpanKind::Output, 2 * kMs, 3 * kMs}},
             true);
    EXPECT_DOUBLE_EQ(parts.totalMs(), 0);
}

TEST(FrameHistory, keepsTheLatestFrames) {
    FrameHistory history;
    EXPECT_EQ(history.framesPerSecond(), 0);
    for (uint32_t frame = 1; frame <= 100; ++frame) {
        FrameParts parts;
        parts.frame = frame;
        parts.endNs = frame * 20 * kMs;
        parts.ms[static_cast<size_t>(FramePart::Replay)] = frame <= 40 ? 1000 : 6;
        history.add(parts);
    }
    EXPECT_EQ(history.frames().size(), FrameHistory::kFrames);
    EXPECT_EQ(history.frames().front().frame, 41U);
    EXPECT_DOUBLE_EQ(history.framesPerSecond(), 50);
    EXPECT_DOUBLE_EQ(history.meanMs(FramePart::Replay), 6);
}

TEST(FrameHistory, derivesTheRateFromFramesWithAnEnd) {
    FrameHistory history;
    for (const int64_t endNs : {1000 * kMs, int64_t{0}, 1100 * kMs, int64_t{0}}) history.add({1, endNs, {}});
    EXPECT_DOUBLE_EQ(history.framesPerSecond(), 10);
}

} // namespace
} // namespace mural
