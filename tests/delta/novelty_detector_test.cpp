// When the rest of a packet is sent as plain bytes.
#include "streamcodec/delta/novelty_detector.hpp"

#include <gtest/gtest.h>

namespace mural::delta {
namespace {

constexpr bool kLong = true, kOther = false;

// The number of consecutive new records examined before the limit.
int examinedRecords(NoveltyDetector& novelty) {
    int count = 0;
    for (; !novelty.many() && count < 1000; ++count) novelty.isNew();
    return count;
}

TEST(NoveltyDetector, decreasesTheLimitAfterEachPlainRest) {
    NoveltyDetector novelty;
    novelty.packetBegins(1, 0, kLong);
    EXPECT_EQ(examinedRecords(novelty), 64);
    for (const int expected : {2, 1, 0, 0}) {
        novelty.sendRestPlain(100);
        novelty.packetBegins(1, 100, kLong);
        EXPECT_EQ(examinedRecords(novelty), expected);
    }
    novelty.packetBegins(1, 100, kLong); // the previous packet was complete
    EXPECT_EQ(examinedRecords(novelty), 4);
    novelty.packetBegins(1, 100, kOther);
    EXPECT_EQ(examinedRecords(novelty), 32);
    novelty.packetEnds(true); // pages follow
    novelty.packetBegins(1, 100, kLong);
    EXPECT_EQ(examinedRecords(novelty), 32);
    for (const int expected : {16, 8, 4, 4}) {
        novelty.sendRestPlain(100);
        novelty.packetBegins(1, 100, kLong);
        EXPECT_EQ(examinedRecords(novelty), expected);
    }
}

// Otherwise repetitions would stay undetected.
TEST(NoveltyDetector, examinesSomeInEachFrame) {
    NoveltyDetector novelty;
    novelty.packetBegins(1, 0, kLong);
    for (int packet = 0; packet < 10; ++packet) {
        (void)examinedRecords(novelty);
        novelty.sendRestPlain(70);
        novelty.packetBegins(1, 70, kLong);
    }
    ASSERT_EQ(examinedRecords(novelty), 0);
    novelty.sendRestPlain(70);
    novelty.packetBegins(2, 70, kLong);
    EXPECT_EQ(examinedRecords(novelty), 4);
}

TEST(NoveltyDetector, examinesAllWhenOmittedRecordsRepeat) {
    NoveltyDetector novelty;
    novelty.packetBegins(1, 0, kLong);
    (void)examinedRecords(novelty);
    novelty.sendRestPlain(64);
    novelty.packetBegins(2, 64, kLong);
    novelty.found(0, 64); // as in the log
    novelty.another(64);
    EXPECT_EQ(examinedRecords(novelty), 64); // the first frame loads what others draw
    novelty.sendRestPlain(128);
    novelty.packetBegins(3, 128, kLong);
    novelty.found(64, 64);
    novelty.another(128);
    EXPECT_EQ(examinedRecords(novelty), 1000);
}

} // namespace
} // namespace mural::delta
