#include <cstring>
#include <gtest/gtest.h>

#include "nodes/exchange/picture_exchange.hpp"

namespace mural::test {
namespace {

ChannelSecret secretOf(unsigned char fill) {
    ChannelSecret secret;
    std::memset(secret.data(), fill, secret.size());
    return secret;
}

std::vector<std::byte> bytesOf(size_t count, int value) { return std::vector<std::byte>(count, static_cast<std::byte>(value)); }

TEST(PictureExchange, namesSayTheRank) {
    EXPECT_EQ(PictureExchange::rankOf(PictureExchange::nameOf(12)), 12);
    EXPECT_EQ(PictureExchange::rankOf("range"), 0);
    EXPECT_EQ(PictureExchange::rankOf("range3x"), 0);
    EXPECT_EQ(PictureExchange::rankOf("node3"), 0);
}

TEST(PictureExchange, bothSendAtOnceMoreThanBuffersHold) {
    PictureExchange low(0, secretOf(1)), high(2, secretOf(1));
    ASSERT_TRUE(low.listen(true));
    ASSERT_TRUE(high.connectTo(0, "127.0.0.1", low.port(), Deadline::inMs(5000)));
    constexpr size_t kBytes = 32 << 20;
    ASSERT_TRUE(low.send(2, bytesOf(kBytes, 1), Deadline::inMs(5000)));
    ASSERT_TRUE(high.send(0, bytesOf(kBytes, 2), Deadline::inMs(5000)));
    ASSERT_TRUE(low.send(2, bytesOf(3, 3), Deadline::inMs(5000)));
    auto first = high.receive(0, kBytes, Deadline::inMs(20000));
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_EQ(*first, bytesOf(kBytes, 1));
    EXPECT_EQ(*high.receive(0, kBytes, Deadline::inMs(20000)), bytesOf(3, 3));
    EXPECT_EQ(*low.receive(2, kBytes, Deadline::inMs(20000)), bytesOf(kBytes, 2));
    EXPECT_EQ(low.bytesSent(), kBytes + 3);
    EXPECT_GE(low.takeTransfer(2).bytes, kBytes);
    EXPECT_EQ(low.takeTransfer(2).bytes, 0u);
}

TEST(PictureExchange, whoKnowsNotTheSecretIsNotLetIn) {
    PictureExchange low(0, secretOf(1)), stranger(1, secretOf(2));
    ASSERT_TRUE(low.listen(true));
    EXPECT_FALSE(stranger.connectTo(0, "127.0.0.1", low.port(), Deadline::inMs(5000)));
    EXPECT_EQ(low.receive(1, 100, Deadline::inMs(300)).error().message, "no connection of range 2 came");
    EXPECT_EQ(low.receive(1, 100, Deadline::inMs(300)).error().message, "range 2 is gone");
}

TEST(PictureExchange, whoIsGoneIsSaidAtOnce) {
    PictureExchange low(0, secretOf(1));
    ASSERT_TRUE(low.listen(true));
    {
        PictureExchange high(1, secretOf(1));
        ASSERT_TRUE(high.connectTo(0, "127.0.0.1", low.port(), Deadline::inMs(5000)));
        ASSERT_TRUE(high.send(0, bytesOf(1 << 20, 7), Deadline::inMs(5000)));
    } // what was sent still comes
    EXPECT_TRUE(low.receive(1, 1 << 20, Deadline::inMs(5000)));
    const int64_t beganNs = monotonicNowNs();
    EXPECT_FALSE(low.receive(1, 1 << 20, Deadline::inMs(20000)));
    EXPECT_FALSE(low.send(1, bytesOf(10, 1), Deadline::inMs(20000)));
    EXPECT_LT(monotonicNowNs() - beganNs, 5 * kNsPerS);
}

TEST(PictureExchange, whatIsTooLargeEndsTheConnection) {
    PictureExchange low(0, secretOf(1)), high(1, secretOf(1));
    ASSERT_TRUE(low.listen(true));
    ASSERT_TRUE(high.connectTo(0, "127.0.0.1", low.port(), Deadline::inMs(5000)));
    ASSERT_TRUE(high.send(0, bytesOf(101, 7), Deadline::inMs(5000)));
    EXPECT_EQ(low.receive(1, 100, Deadline::inMs(5000)).error().message, "range 2: a picture of 101 bytes came where 100 are the most");
    EXPECT_EQ(low.receive(1, 100, Deadline::inMs(5000)).error().message, "range 2 is gone");
}

} // namespace
} // namespace mural::test
