// The thread-safe collection: its lease, the nodes' clocks, several threads.
#include "nodes/head/statistics/frame_statistics.hpp"

#include <gtest/gtest.h>
#include <thread>

namespace mural {
namespace {

constexpr int64_t kSettled = FrameRing::kSettleNs;

std::vector<wire::FrameSpan> spansAt(int64_t beginNs, int64_t endNs) {
    return {{static_cast<uint32_t>(SpanKind::Replay), 0, beginNs, endNs},
            {static_cast<uint32_t>(SpanKind::Compress), 1, beginNs, endNs}};
}

TEST(FrameStatistics, recordNothingWithoutARequest) {
    FrameStatistics statistics({NodeClock::shared()});
    statistics.addNode(0, {1, 1, 1, 0, 0}, spansAt(1, 2), 5);
    statistics.finish(1, 1, 1, 5);
    EXPECT_TRUE(statistics.since(0, kSettled * 100).empty());
}

TEST(FrameStatistics, endSomeTimeAfterTheLastRequest) {
    FrameStatistics statistics({});
    EXPECT_TRUE(statistics.request(0));
    EXPECT_FALSE(statistics.request(FrameStatistics::kLeaseNs - 1));
    EXPECT_FALSE(statistics.expire(2 * FrameStatistics::kLeaseNs - 2));
    EXPECT_TRUE(statistics.isOn());
    EXPECT_TRUE(statistics.expire(2 * FrameStatistics::kLeaseNs - 1));
    EXPECT_FALSE(statistics.isOn());
    EXPECT_FALSE(statistics.expire(INT64_MAX));
    EXPECT_TRUE(statistics.request(0));
}

TEST(FrameStatistics, placeANodesSpansOnTheHeadsClock) {
    FrameStatistics statistics({NodeClock::shared(), NodeClock()});
    statistics.request(0);
    statistics.addRoundTrip(1, {1000, 501'000, 501'000, 1000}); // 500 us ahead
    statistics.addNode(0, {1, 2, 3, 0, 0}, spansAt(40, 50), 60);
    statistics.addNode(1, {1, 2, 3, 0, 0}, spansAt(500'040, 500'050), 61);
    statistics.finish(1, 2, 3, 70);
    const auto records = statistics.since(0, 70 + kSettled);
    ASSERT_EQ(records.size(), 1u);
    ASSERT_EQ(records[0].tracks.size(), 4u);
    for (const SpanTrack& track : records[0].tracks) {
        EXPECT_EQ(track.spans.at(0).beginNs, 40) << track.number << track.thread;
        EXPECT_EQ(track.spans.at(0).endNs, 50);
    }
    EXPECT_EQ(statistics.clocks().at(1).errorNs(), 0);
}

TEST(FrameStatistics, acceptTracksOfSeveralThreads) {
    constexpr uint32_t kManyFrames = 500;
    FrameStatistics statistics({NodeClock::shared(), NodeClock::shared(), NodeClock::shared()});
    statistics.request(0);
    std::vector<std::thread> threads;
    for (int node = 0; node < 3; ++node)
        threads.emplace_back([&statistics, node] {
            for (uint32_t frame = 1; frame <= kManyFrames; ++frame) {
                statistics.addNode(node, {1, 1, frame, 0, 0}, spansAt(frame, frame + 1), frame);
                statistics.finish(1, 1, frame, frame);
                (void)statistics.since(frame, frame);
            }
        });
    for (std::thread& thread : threads) thread.join();
    const auto records = statistics.since(0, kManyFrames + kSettled);
    ASSERT_EQ(records.size(), kManyFrames);
    for (const FrameRecord& record : records) EXPECT_EQ(record.tracks.size(), 6u);
}

} // namespace
} // namespace mural
