// The spans of one thread: no gaps, no overlaps, bounded memory.
#include "nodes/frame_spans/thread_spans.hpp"

#include <gtest/gtest.h>
#include <random>

#include "nodes/frame_spans/frame_spans_message.hpp"
#include "nodes/frame_spans/span_scope.hpp"

namespace mural {
namespace {

constexpr int64_t kMs = 1'000'000;

// Checks that the spans cover the time from begin to end.
void expectTiling(const std::vector<Span>& spans, int64_t beginNs, int64_t endNs) {
    int64_t atNs = beginNs;
    for (const Span& span : spans) {
        EXPECT_EQ(span.beginNs, atNs);
        EXPECT_GT(span.endNs, span.beginNs);
        atNs = span.endNs;
    }
    EXPECT_EQ(atNs, endNs);
}

TEST(ThreadSpans, recordsNothingBeforeItStarts) {
    ThreadSpans spans;
    spans.enter(SpanKind::Replay, 5);
    EXPECT_TRUE(spans.take(10).empty());
    EXPECT_FALSE(spans.isActive());
}

TEST(ThreadSpans, returnsTheStatesInOrder) {
    ThreadSpans spans;
    spans.start(SpanKind::Replay, 0);
    EXPECT_EQ(spans.enter(SpanKind::WaitPackets, 3 * kMs), SpanKind::Replay);
    EXPECT_EQ(spans.enter(SpanKind::Replay, 5 * kMs), SpanKind::WaitPackets);
    EXPECT_EQ(spans.take(9 * kMs), (std::vector<Span>{{SpanKind::Replay, 0, 3 * kMs},
                                                      {SpanKind::WaitPackets, 3 * kMs, 5 * kMs},
                                                      {SpanKind::Replay, 5 * kMs, 9 * kMs}}));
    EXPECT_EQ(spans.take(10 * kMs), (std::vector<Span>{{SpanKind::Replay, 9 * kMs, 10 * kMs}}));
}

TEST(ThreadSpans, keepsLaterSpansForTheNextFrame) {
    ThreadSpans spans;
    spans.start(SpanKind::Send, 0);
    spans.enter(SpanKind::WaitProgram, 2 * kMs);
    spans.enter(SpanKind::Send, 6 * kMs);
    EXPECT_EQ(spans.take(4 * kMs),
              (std::vector<Span>{{SpanKind::Send, 0, 2 * kMs}, {SpanKind::WaitProgram, 2 * kMs, 4 * kMs}}));
    EXPECT_EQ(spans.take(7 * kMs),
              (std::vector<Span>{{SpanKind::WaitProgram, 4 * kMs, 6 * kMs}, {SpanKind::Send, 6 * kMs, 7 * kMs}}));
}

TEST(ThreadSpans, addsShortSpansToTheirPredecessors) {
    ThreadSpans spans;
    spans.start(SpanKind::Replay, 0);
    for (int64_t i = 1; i <= 1000; ++i) {
        spans.enter(SpanKind::WaitPackets, i * 10'000);
        spans.enter(SpanKind::Replay, i * 10'000 + ThreadSpans::kMinNs / 2);
    }
    EXPECT_EQ(spans.take(11 * kMs), (std::vector<Span>{{SpanKind::Replay, 0, 11 * kMs}}));
}

TEST(ThreadSpans, staysBoundedAndWithoutGapsForAnyStates) {
    std::mt19937 random(11);
    for (int round = 0; round < 20; ++round) {
        ThreadSpans spans;
        spans.start(SpanKind::Replay, 0);
        int64_t nowNs = 0, beganNs = 0;
        for (int i = 0; i < 20'000; ++i) {
            nowNs += random() % 50'000;
            spans.enter(static_cast<SpanKind>(random() % wire::kSpanKinds), nowNs);
            if (random() % 3000 != 0) continue;
            nowNs += 1;
            const std::vector<Span> taken = spans.take(nowNs);
            EXPECT_LE(taken.size(), ThreadSpans::kMaxSpans + 1);
            expectTiling(taken, beganNs, nowNs);
            beganNs = nowNs;
        }
    }
}

TEST(ThreadSpans, keepsLongSpansWhenItDropsShortOnes) {
    ThreadSpans spans;
    spans.start(SpanKind::Readback, 0);
    int64_t nowNs = 100 * kMs;
    for (int i = 0; i < 10'000; ++i) {
        spans.enter(SpanKind::WaitPackets, nowNs += 5'000);
        spans.enter(SpanKind::Replay, nowNs += 5'000);
    }
    const std::vector<Span> taken = spans.take(nowNs + 1);
    ASSERT_GE(taken.size(), 2u);
    EXPECT_EQ(taken.front().kind, SpanKind::Readback);
    EXPECT_GE(taken.front().ns(), 99 * kMs);
}

TEST(ThreadSpans, keepsTheTimesOfManyShortSpans) {
    ThreadSpans spans;
    spans.start(SpanKind::WaitPackets, 0);
    int64_t nowNs = 100 * kMs, workNs = 0, waitNs = nowNs;
    for (int i = 0; i < 10'000; ++i) {
        spans.enter(SpanKind::Replay, nowNs);
        spans.enter(SpanKind::WaitPackets, nowNs += 7'000);
        nowNs += 3'000;
        workNs += 7'000;
        waitNs += 3'000;
    }
    int64_t works = 0, waits = 0;
    for (const Span& span : spans.take(nowNs)) (wire::isWait(span.kind) ? waits : works) += span.ns();
    EXPECT_EQ(works, workNs);
    EXPECT_EQ(waits, waitNs);
}

TEST(SpanScope, returnsToTheOuterStateOfItsThread) {
    ThreadSpans spans;
    { const SpanScope ignored(SpanKind::Decode); }
    recordThread(spans, true, SpanKind::WaitPackets);
    const int64_t beganNs = quickNowNs();
    {
        const SpanScope replays(SpanKind::Replay);
        sleepUntilNs(beganNs + kMs);
        const SpanScope reads(SpanKind::Readback);
        sleepUntilNs(beganNs + 2 * kMs);
    }
    sleepUntilNs(beganNs + 3 * kMs);
    std::vector<SpanKind> kinds;
    for (const Span& span : spans.take(quickNowNs())) kinds.push_back(span.kind);
    recordThread(spans, false, SpanKind::WaitPackets);
    EXPECT_EQ(currentSpans, nullptr);
    while (kinds.size() > 3) kinds.erase(kinds.begin()); // the time before the scope may be long enough
    EXPECT_EQ(kinds, (std::vector<SpanKind>{SpanKind::Replay, SpanKind::Readback, SpanKind::WaitPackets}));
}

TEST(FrameSpansMessage, rejectsUnknownKindsOverlapsAndTimesOutOfRange) {
    const auto problemOf = [](const std::vector<wire::FrameSpan>& spans) {
        const auto checked = checkSpans(spans);
        return checked ? std::string() : checked.error().message;
    };
    EXPECT_EQ(problemOf({}), "");
    EXPECT_EQ(problemOf({{0, 0, 5, 7}, {1, 0, 7, 9}, {1, 1, 0, 9}}), "");
    EXPECT_NE(problemOf({{wire::kSpanKinds, 0, 5, 7}}), "");
    EXPECT_NE(problemOf({{0, wire::kSpanThreads, 5, 7}}), "");
    EXPECT_NE(problemOf({{0, 0, 5, 4}}), "");
    EXPECT_NE(problemOf({{0, 0, 5, 7}, {1, 0, 6, 9}}), "");
    EXPECT_NE(problemOf({{0, 0, 5, 7}, {1, 1, 0, 1}, {1, 0, 6, 9}}), "");
    EXPECT_NE(problemOf({{0, 0, INT64_MIN, 0}}), "") << "the head subtracts an offset";
    EXPECT_NE(problemOf({{0, 0, 5, INT64_MAX}}), "");
}

TEST(FrameSpansMessage, returnsWhatWasAddedUpToItsLimit) {
    const std::vector<Span> replay = {{SpanKind::WaitPackets, 1, 2}, {SpanKind::Replay, 2, 5}};
    const std::vector<Span> pictures = {{SpanKind::Compress, 3, 4}};
    std::vector<wire::FrameSpan> message;
    addSpans(message, wire::SpanThread::Replay, replay);
    addSpans(message, wire::SpanThread::Pictures, pictures);
    EXPECT_EQ(spansOf(message, wire::SpanThread::Replay), replay);
    EXPECT_EQ(spansOf(message, wire::SpanThread::Pictures), pictures);
    addSpans(message, wire::SpanThread::Pictures, std::vector<Span>(1000, {SpanKind::Compress, 5, 5}));
    EXPECT_EQ(message.size(), wire::kMaxFrameSpans);
}

} // namespace
} // namespace mural
