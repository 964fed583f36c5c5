// The ring of frames: order, bounds, completeness.
#include "nodes/head/statistics/frame_ring.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

constexpr int64_t kLater = FrameRing::kSettleNs;

SpanTrack trackOf(int node) { return {SpanProcess::Node, node, "replay", {{SpanKind::Replay, 1, 2}}}; }

std::vector<uint32_t> framesOf(const std::vector<FrameRecord>& records) {
    std::vector<uint32_t> frames;
    for (const FrameRecord& record : records) frames.push_back(record.frame);
    return frames;
}

TEST(FrameRing, joinsTheTracksOfAFrame) {
    FrameRing ring;
    ring.add(1, 7, trackOf(0), 10);
    ring.add(2, 7, trackOf(0), 10);
    ring.add(1, 7, trackOf(1), 11);
    ring.finish(1, 3, 7, 12);
    ring.finish(2, 4, 7, 13);
    const auto records = ring.since(0, 13 + kLater);
    ASSERT_EQ(records.size(), 2u);
    EXPECT_EQ(records[0].tracks.size(), 2u);
    EXPECT_EQ(records[0].client, 1u);
    EXPECT_EQ(records[0].window, 3u);
    EXPECT_EQ(records[0].doneNs, 12);
    EXPECT_EQ(records[1].tracks.size(), 1u);
}

TEST(FrameRing, keepsTheFirstEnd) {
    FrameRing ring;
    ring.finish(1, 3, 7, 12);
    ring.finish(1, 3, 7, 15);
    EXPECT_EQ(ring.since(0, 12 + kLater).at(0).doneNs, 12);
}

TEST(FrameRing, dropsTheOldestFrameWhenItIsFull) {
    FrameRing ring(3);
    for (uint32_t frame = 1; frame <= 10; ++frame) ring.finish(1, 1, frame, frame);
    EXPECT_EQ(ring.size(), 3u);
    EXPECT_EQ(framesOf(ring.since(0, 10 + kLater)), (std::vector<uint32_t>{8, 9, 10}));
    EXPECT_EQ(framesOf(ring.since(0, 10 + kLater, 2)), (std::vector<uint32_t>{9, 10}));
    EXPECT_TRUE(ring.since(0, 10 + kLater, 0).empty());
    EXPECT_TRUE(ring.since(11, 10 + kLater, 2).empty());
}

TEST(FrameRing, returnsEachFrameOnceToAClientThatContinues) {
    FrameRing ring(100);
    uint64_t next = 0;
    std::vector<uint32_t> seen;
    for (uint32_t frame = 1; frame <= 50; ++frame) {
        const int64_t nowNs = frame * kLater / 4;
        ring.add(1, frame, trackOf(0), nowNs);
        ring.finish(1, 1, frame, nowNs);
        for (const FrameRecord& record : ring.since(next, nowNs)) {
            seen.push_back(record.frame);
            next = record.number + 1;
        }
    }
    for (size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], i + 1);
    EXPECT_EQ(seen.size(), 46u); // the last frames may receive further tracks
}

TEST(FrameRing, waitsForAnUnfinishedFrameForALimitedTime) {
    FrameRing ring;
    ring.add(1, 1, trackOf(0), 0);
    ring.finish(1, 1, 2, 1);
    EXPECT_TRUE(ring.since(0, 1 + kLater).empty());
    EXPECT_EQ(framesOf(ring.since(0, FrameRing::kPatienceNs)), (std::vector<uint32_t>{1, 2}));
}

TEST(FrameRing, continuesItsNumbersAfterAClear) {
    FrameRing ring;
    ring.finish(1, 1, 1, 1);
    ring.clear();
    EXPECT_EQ(ring.size(), 0u);
    ring.finish(1, 1, 2, 1);
    EXPECT_EQ(ring.since(0, 1 + kLater).at(0).number, 2u); // a client that asks for later ones misses nothing
}

} // namespace
} // namespace mural
