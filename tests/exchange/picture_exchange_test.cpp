// Connections between nodes that exchange parts of pictures: secrets, lost peers, restarted nodes.
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

std::vector<std::byte> bytesOf(size_t count, int value) {
    return std::vector<std::byte>(count, static_cast<std::byte>(value));
}

TEST(PictureExchange, namesRankAndIncarnation) {
    const auto there = [](PictureExchange::Name name) {
        return PictureExchange::nameOf(PictureExchange::textOf(name)) == name;
    };
    EXPECT_TRUE(there({12, 0}));
    EXPECT_TRUE(there({0, 31}));
    for (const char* other : {"range", "range3", "range3.", "range3.x", "range3.1x", "range-1.0", "range.1", "node3.0"})
        EXPECT_FALSE(PictureExchange::nameOf(other)) << other;
}

TEST(PictureExchange, letsBothEndsSendMoreThanBuffersHold) {
    PictureExchange low({0, 0}, secretOf(1)), high({2, 0}, secretOf(1));
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

TEST(PictureExchange, rejectsAWrongSecret) {
    PictureExchange low({0, 0}, secretOf(1)), stranger({1, 0}, secretOf(2));
    ASSERT_TRUE(low.listen(true));
    EXPECT_FALSE(stranger.connectTo(0, "127.0.0.1", low.port(), Deadline::inMs(5000)));
    EXPECT_EQ(low.receive(1, 100, Deadline::inMs(300)).error().message, "no connection from range 2 came");
    EXPECT_EQ(low.receive(1, 100, Deadline::inMs(300)).error().message, "range 2 is disconnected");
}

TEST(PictureExchange, reportsALostPeerAtOnce) {
    PictureExchange low({0, 0}, secretOf(1));
    ASSERT_TRUE(low.listen(true));
    {
        PictureExchange high({1, 0}, secretOf(1));
        ASSERT_TRUE(high.connectTo(0, "127.0.0.1", low.port(), Deadline::inMs(5000)));
        ASSERT_TRUE(high.send(0, bytesOf(1 << 20, 7), Deadline::inMs(5000)));
    } // sent data still arrives
    EXPECT_TRUE(low.receive(1, 1 << 20, Deadline::inMs(5000)));
    const int64_t beganNs = monotonicNowNs();
    EXPECT_FALSE(low.receive(1, 1 << 20, Deadline::inMs(20000)));
    EXPECT_FALSE(low.send(1, bytesOf(10, 1), Deadline::inMs(20000)));
    EXPECT_LT(monotonicNowNs() - beganNs, 5 * kNsPerS);
}

TEST(PictureExchange, closesTheConnectionAfterAnOversizedMessage) {
    PictureExchange low({0, 0}, secretOf(1)), high({1, 0}, secretOf(1));
    ASSERT_TRUE(low.listen(true));
    ASSERT_TRUE(high.connectTo(0, "127.0.0.1", low.port(), Deadline::inMs(5000)));
    ASSERT_TRUE(high.send(0, bytesOf(101, 7), Deadline::inMs(5000)));
    EXPECT_EQ(low.receive(1, 100, Deadline::inMs(5000)).error().message,
              "range 2: the size of a picture, 101 bytes, exceeds the limit of 100");
    EXPECT_EQ(low.receive(1, 100, Deadline::inMs(5000)).error().message, "range 2 is disconnected");
}

// The predecessor's state remains until the newcomer is announced as a participant.
TEST(PictureExchange, replacesANodeWhenItsSuccessorIsAnnounced) {
    PictureExchange low({0, 0}, secretOf(1));
    ASSERT_TRUE(low.listen(true));
    {
        PictureExchange before({1, 0}, secretOf(1));
        ASSERT_TRUE(before.connectTo(0, "127.0.0.1", low.port(), Deadline::inMs(5000)));
        ASSERT_TRUE(before.send(0, bytesOf(10, 1), Deadline::inMs(5000)));
        EXPECT_TRUE(low.receive(1, 100, Deadline::inMs(5000)));
    }
    {
        PictureExchange onItsWay({1, 1}, secretOf(1)); // lost before it became a member
        ASSERT_TRUE(onItsWay.connectTo(0, "127.0.0.1", low.port(), Deadline::inMs(5000)));
    }
    PictureExchange again({1, 2}, secretOf(1));
    ASSERT_TRUE(again.connectTo(0, "127.0.0.1", low.port(), Deadline::inMs(5000)));
    ASSERT_TRUE(again.send(0, bytesOf(10, 2), Deadline::inMs(5000)));
    EXPECT_FALSE(low.receive(1, 100, Deadline::inMs(5000))) << "the old one's end";
    low.renew(1, 2);
    EXPECT_EQ(*low.receive(1, 100, Deadline::inMs(5000)), bytesOf(10, 2));
    ASSERT_TRUE(low.send(1, bytesOf(10, 3), Deadline::inMs(5000)));
    EXPECT_EQ(*again.receive(0, 100, Deadline::inMs(5000)), bytesOf(10, 3));
}

// It was a member, is lost again, and its successor is connected: its sent data is still readable.
TEST(PictureExchange, deliversDataOfEachIncarnation) {
    PictureExchange low({0, 0}, secretOf(1));
    ASSERT_TRUE(low.listen(true));
    for (int incarnation = 0; incarnation < 4; ++incarnation) {
        PictureExchange high({1, static_cast<uint32_t>(incarnation)}, secretOf(1));
        ASSERT_TRUE(high.connectTo(0, "127.0.0.1", low.port(), Deadline::inMs(5000)));
        ASSERT_TRUE(high.send(0, bytesOf(10, incarnation), Deadline::inMs(5000)));
    }
    for (int incarnation = 0; incarnation < 4; ++incarnation) {
        if (incarnation == 2) continue; // it never became a member
        if (incarnation > 0) low.renew(1, static_cast<uint32_t>(incarnation));
        auto came = low.receive(1, 100, Deadline::inMs(5000));
        ASSERT_TRUE(came) << incarnation << ": " << came.error().message;
        EXPECT_EQ(*came, bytesOf(10, incarnation));
    }
    EXPECT_FALSE(low.receive(1, 100, Deadline::inMs(5000)));
}

// A returning collector connects to the others too, and learns their incarnation from the welcome message.
TEST(PictureExchange, connectsTheLowestRankWhenItReturns) {
    PictureExchange high({2, 5}, secretOf(1));
    ASSERT_TRUE(high.listen(true));
    PictureExchange again({0, 1}, secretOf(1));
    ASSERT_TRUE(again.connectTo(2, "127.0.0.1", high.port(), Deadline::inMs(5000)));
    high.renew(0, 1);
    again.renew(2, 5); // it is the connected one
    ASSERT_TRUE(again.send(2, bytesOf(10, 4), Deadline::inMs(5000)));
    EXPECT_EQ(*high.receive(0, 100, Deadline::inMs(5000)), bytesOf(10, 4));
    again.renew(2, 6); // this incarnation has not connected
    EXPECT_FALSE(again.send(2, bytesOf(10, 4), Deadline::inMs(5000)));
}

// No node waits for a connection that was not made in time.
TEST(PictureExchange, treatsAMissingPeerAsLostAtOnce) {
    PictureExchange low({0, 0}, secretOf(1)), again({0, 1}, secretOf(1));
    ASSERT_TRUE(low.listen(true));
    low.renew(1, 1); // never connected
    {
        PictureExchange before({2, 0}, secretOf(1));
        ASSERT_TRUE(before.connectTo(0, "127.0.0.1", low.port(), Deadline::inMs(5000)));
        low.renew(2, 1); // returned, but not connected here
    }
    const int64_t beganNs = monotonicNowNs();
    for (const int rank : {1, 2}) {
        EXPECT_FALSE(low.receive(rank, 100, Deadline::inMs(20000)));
        EXPECT_FALSE(low.send(rank, bytesOf(10, 1), Deadline::inMs(20000)));
        EXPECT_FALSE(again.receive(rank, 100, Deadline::inMs(20000))) << "it has gone to all that there are";
    }
    EXPECT_LT(monotonicNowNs() - beganNs, 5 * kNsPerS);
}

// After connecting, a node is known to its peer, however soon the peer asks.
TEST(PictureExchange, acceptsAPeerOnceItIsWelcomed) {
    PictureExchange low({0, 0}, secretOf(1));
    ASSERT_TRUE(low.listen(true));
    for (uint32_t incarnation = 1; incarnation < 60; ++incarnation) {
        PictureExchange high({1, incarnation}, secretOf(1));
        ASSERT_TRUE(high.connectTo(0, "127.0.0.1", low.port(), Deadline::inMs(5000)));
        low.renew(1, incarnation);
        ASSERT_TRUE(low.send(1, bytesOf(5, 7), Deadline::inMs(5000))) << incarnation;
        ASSERT_EQ(*high.receive(0, 100, Deadline::inMs(5000)), bytesOf(5, 7));
    }
}

} // namespace
} // namespace mural::test
