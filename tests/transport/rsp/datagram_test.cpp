// Encoding of RSP datagrams, and comparison of sequence numbers.
#include "transport/rsp/wire/datagram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace mural::rsp {
namespace {

using Bytes = std::vector<std::byte>;

TEST(Sequence, comparesAcrossTheWrap) {
    const Sequence last(0xffffffff);
    EXPECT_LT(last, last + 1);
    EXPECT_EQ((last + 1).value(), 0u);
    EXPECT_EQ((last + 5) - last, 5);
    EXPECT_EQ(last - (last + 5), -5);
    EXPECT_EQ(later(last, last + 3), last + 3);
    EXPECT_EQ(earlier(last, last + 3), last);
}

Bytes streamBytes(StreamDatagram d, size_t payloadBytes) {
    Bytes bytes(kStreamHeaderBytes + payloadBytes, std::byte{7});
    writeStreamHeader(d, bytes);
    return bytes;
}

TEST(Datagram, decodesItsOwnStreamHeaders) {
    StreamDatagram d;
    d.type = Type::Parity;
    d.flags = flag::kRepair;
    d.from = 513;
    d.sequence = Sequence(0xfffffff0);
    d.groupSize = 17;
    d.row = 200;
    d.rowsSent = 201;
    d.sentUs = 123456789;
    d.next = Sequence(5);
    const Bytes bytes = streamBytes(d, 40);
    const auto back = readStream(bytes);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->type, d.type);
    EXPECT_EQ(back->flags, d.flags);
    EXPECT_EQ(back->from, d.from);
    EXPECT_EQ(back->sequence, d.sequence);
    EXPECT_EQ(back->groupSize, d.groupSize);
    EXPECT_EQ(back->row, d.row);
    EXPECT_EQ(back->rowsSent, d.rowsSent);
    EXPECT_EQ(back->sentUs, d.sentUs);
    EXPECT_EQ(back->next, d.next);
    EXPECT_EQ(back->payload.size(), 40u);
}

TEST(Datagram, rejectsFieldsOutOfBounds) {
    StreamDatagram d;
    d.index = 31;
    EXPECT_TRUE(readStream(streamBytes(d, 1)));
    EXPECT_FALSE(readStream(streamBytes(d, 0))) << "DATA of nothing";
    d.index = 32;
    EXPECT_FALSE(readStream(streamBytes(d, 1)));
    d.index = 3;
    d.groupSize = 3;
    EXPECT_FALSE(readStream(streamBytes(d, 1))) << "behind its group's end";
    d = {};
    d.type = Type::Parity;
    EXPECT_FALSE(readStream(streamBytes(d, 10))) << "a row of no group";
    d.groupSize = 33;
    EXPECT_FALSE(readStream(streamBytes(d, 10)));
    d.groupSize = 2;
    EXPECT_FALSE(readStream(streamBytes(d, 2))) << "a row of lengths alone";
    d.row = 224;
    EXPECT_FALSE(readStream(streamBytes(d, 10)));
    d = {};
    d.type = Type::Poll;
    EXPECT_TRUE(readStream(streamBytes(d, 0)));
    EXPECT_FALSE(readStream(streamBytes(d, 1)));
    Bytes other = streamBytes({}, 1);
    other[0] ^= std::byte{0x10};
    EXPECT_FALSE(readHeader(other)) << "another version";
}

TEST(Datagram, decodesItsOwnFeedback) {
    Feedback f;
    f.from = 3;
    f.to = 9;
    f.cumulative = Sequence(10);
    f.edge = Sequence(1000);
    f.highest = Sequence(99);
    f.echoUs = 1;
    f.ackDelayUs = 2;
    f.lost = 3;
    f.dropped = 4;
    f.entryCount = 2;
    f.entries[0] = {Sequence(10), 0x80000001, 4, 32};
    f.entries[1] = {Sequence(42), 0x3, 0, 2};
    Bytes bytes(feedbackBytes(f));
    writeFeedback(f, bytes);
    const auto back = readFeedback(bytes);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->cumulative, f.cumulative);
    EXPECT_EQ(back->edge, f.edge);
    EXPECT_EQ(back->highest, f.highest);
    EXPECT_EQ(back->lost, 3u);
    EXPECT_EQ(back->dropped, 4u);
    EXPECT_EQ(back->to, 9);
    ASSERT_EQ(back->entryCount, 2);
    EXPECT_EQ(back->entries[0].missing, 0x80000001);
    EXPECT_EQ(back->entries[0].rows, 4);
    EXPECT_EQ(back->entries[1].base, Sequence(42));

    EXPECT_FALSE(readFeedback(std::span(bytes).first(bytes.size() - 1))) << "cut";
    f.entries[1].missing = 4;
    writeFeedback(f, bytes);
    EXPECT_FALSE(readFeedback(bytes)) << "misses what it does not span";
}

// Members send feedback with and without a request. Only a writer with data in flight waits for it.
TEST(Datagram, marksFeedbackUrgentForAWaitingWriter) {
    const Feedback f;
    Bytes bytes(feedbackBytes(f));
    writeFeedback(f, bytes);
    EXPECT_TRUE(isUrgent(bytes, true));
    EXPECT_FALSE(isUrgent(bytes, false));
    StreamDatagram d;
    EXPECT_FALSE(isUrgent(streamBytes(d, 1), true));
    d.flags = flag::kPoll;
    EXPECT_TRUE(isUrgent(streamBytes(d, 1), false));
}

TEST(Datagram, survivesArbitraryBytes) {
    std::mt19937 random(3);
    Feedback f;
    f.entryCount = 5;
    for (auto& e : f.entries) e.span = 32;
    Bytes feedback(feedbackBytes(f));
    writeFeedback(f, feedback);
    const Bytes data = streamBytes({}, 100);
    size_t accepted = 0;
    for (int i = 0; i < 200'000; ++i) {
        Bytes bytes = random() % 2 ? feedback : data;
        if (random() % 4 == 0) bytes.resize(random() % (bytes.size() + 1));
        for (uint32_t flips = random() % 8; flips > 0 && !bytes.empty(); --flips)
            bytes[random() % bytes.size()] = static_cast<std::byte>(random());
        const auto s = readStream(bytes);
        const auto b = readFeedback(bytes);
        accepted += s.has_value() + b.has_value();
        if (s) {
            EXPECT_LE(s->payload.size(), bytes.size());
        }
        if (b) {
            EXPECT_LE(b->entryCount, kMaxEntries);
        }
    }
    EXPECT_GT(accepted, 1000u);
}

} // namespace
} // namespace mural::rsp
