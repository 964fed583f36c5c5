// Spans of a program from its counters, also from invalid ones.
#include "nodes/head/statistics/program_spans.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

ProgramWaits waitsOf(uint64_t space, uint64_t frames, uint64_t reply, uint64_t window) {
    return {0, space, frames, reply, window};
}

TEST(ProgramSpans, beginWithTheWaitForCredit) {
    EXPECT_EQ(programSpans(100, 1000, waitsOf(0, 50, 0, 0), waitsOf(20, 350, 5, 0)),
              (std::vector<Span>{{SpanKind::WaitCredit, 100, 400},
                                 {SpanKind::WaitSpace, 400, 420},
                                 {SpanKind::WaitReply, 420, 425},
                                 {SpanKind::Capture, 425, 1000}}));
}

TEST(ProgramSpans, areCaptureAloneWithoutWaits) {
    EXPECT_EQ(programSpans(5, 9, {}, {}), (std::vector<Span>{{SpanKind::Capture, 5, 9}}));
    EXPECT_TRUE(programSpans(9, 9, {}, {}).empty());
    EXPECT_TRUE(programSpans(9, 5, {}, {}).empty());
}

// Threads wait at the same time, and a program may write anything.
TEST(ProgramSpans, endWithTheFrameForAnyCounters) {
    const auto spans = programSpans(0, 100, waitsOf(0, 0, 0, 7), waitsOf(~uint64_t{0}, 60, ~uint64_t{0}, 3));
    ASSERT_EQ(spans.size(), 2u);
    EXPECT_EQ(spans[0], (Span{SpanKind::WaitCredit, 0, 60}));
    EXPECT_EQ(spans[1], (Span{SpanKind::WaitSpace, 60, 100}));
}

} // namespace
} // namespace mural
