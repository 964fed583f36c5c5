// When the rest of a packet is sent as plain bytes.
#include "streamcodec/delta/novelty_detector.hpp"

#include <gtest/gtest.h>

namespace mural::delta {
namespace {

constexpr bool kLong = true, kOther = false;

// The number of consecutive new records examined before the limit.
int lookedAt(NoveltyDetector& news) {
    int count = 0;
    for (; !news.many() && count < 1000; ++count) news.isNew();
    return count;
}

TEST(NoveltyDetector, decreasesTheLimitAfterEachPlainRest) {
    NoveltyDetector news;
    news.packetBegins(1, 0, kLong);
    EXPECT_EQ(lookedAt(news), 64);
    for (const int expected : {2, 1, 0, 0}) {
        news.leaveOut(100);
        news.packetBegins(1, 100, kLong);
        EXPECT_EQ(lookedAt(news), expected);
    }
    news.packetBegins(1, 100, kLong); // the previous packet was complete
    EXPECT_EQ(lookedAt(news), 4);
    news.packetBegins(1, 100, kOther);
    EXPECT_EQ(lookedAt(news), 32);
    news.packetEnds(true); // pages follow
    news.packetBegins(1, 100, kLong);
    EXPECT_EQ(lookedAt(news), 32);
    for (const int expected : {16, 8, 4, 4}) {
        news.leaveOut(100);
        news.packetBegins(1, 100, kLong);
        EXPECT_EQ(lookedAt(news), expected);
    }
}

// Otherwise repetitions would stay undetected.
TEST(NoveltyDetector, examinesSomeInEachFrame) {
    NoveltyDetector news;
    news.packetBegins(1, 0, kLong);
    for (int packet = 0; packet < 10; ++packet) {
        (void)lookedAt(news);
        news.leaveOut(70);
        news.packetBegins(1, 70, kLong);
    }
    ASSERT_EQ(lookedAt(news), 0);
    news.leaveOut(70);
    news.packetBegins(2, 70, kLong);
    EXPECT_EQ(lookedAt(news), 4);
}

TEST(NoveltyDetector, examinesAllWhenOmittedRecordsRepeat) {
    NoveltyDetector news;
    news.packetBegins(1, 0, kLong);
    (void)lookedAt(news);
    news.leaveOut(64);
    news.packetBegins(2, 64, kLong);
    news.found(0, 64); // as in the log
    news.another(64);
    EXPECT_EQ(lookedAt(news), 64); // the first frame loads what others draw
    news.leaveOut(128);
    news.packetBegins(3, 128, kLong);
    news.found(64, 64);
    news.another(128);
    EXPECT_EQ(lookedAt(news), 1000);
}

} // namespace
} // namespace mural::delta
