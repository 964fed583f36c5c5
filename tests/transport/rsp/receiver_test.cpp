// A single receiver, with a writer that sends invalid data.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "transport/rsp/protocol/receiver.hpp"

namespace mural::rsp {
namespace {

class Nowhere : public DatagramSink {
public:
    std::span<std::byte> datagram(MemberId, size_t bytes) override {
        bytes_.resize(bytes);
        return bytes_;
    }
    [[nodiscard]] Feedback feedback() const { return readFeedback(bytes_).value_or(Feedback{}); }

private:
    std::vector<std::byte> bytes_;
};

// Found by stream_fuzz: each number up to there was counted as lost, one by one.
TEST(Receiver, limitsLossesToTheWindowForAPollFarAhead) {
    ReceiverSettings settings;
    settings.shape = {1400, 256};
    Receiver receiver(settings, Sequence(7));
    Nowhere out;
    StreamDatagram poll;
    poll.type = Type::Poll;
    poll.flags = flag::kPoll;
    poll.sequence = Sequence(7);
    poll.next = Sequence(7) + 0x7000'0000;
    receiver.input(poll, 1'000'000);
    (void)receiver.tick(1'000'000, out);
    EXPECT_EQ(receiver.lost(), 256u);
    EXPECT_EQ(out.feedback().highest, Sequence(7) + 256);
}

// Found by stream_fuzz: the datagram was before received ones and after the newest, so half of all numbers counted as
// lost, one by one.
TEST(Receiver, countsNoLossForADatagramHalfTheNumbersBehind) {
    ReceiverSettings settings;
    settings.shape = {1400, 256};
    Receiver receiver(settings, Sequence(7));
    Nowhere out;
    const std::vector<std::byte> payload(10);
    StreamDatagram data;
    data.payload = payload;
    data.sequence = Sequence(7) + 100;
    data.index = 4;
    receiver.input(data, 1'000'000);
    data.sequence = Sequence(7) - 0x7fff'ffff + 50;
    data.index = 0;
    receiver.input(data, 2'000'000);
    (void)receiver.tick(50'000'000, out);
    EXPECT_EQ(receiver.lost(), 0u);
    EXPECT_EQ(out.feedback().highest, Sequence(7) + 101);
}

// Feedback is timely for the writer, but no more frequent: it costs both ends.
TEST(Receiver, sendsFeedbackTwicePerWindow) {
    ReceiverSettings settings;
    settings.shape = {100, 256};
    settings.socketDatagrams = 10'000;
    Receiver receiver(settings, Sequence(7));
    Nowhere out;
    const std::vector<std::byte> payload(100);
    int64_t nowNs = 1'000'000'000;
    (void)receiver.tick(nowNs, out);
    const uint64_t before = receiver.feedbackSent();
    constexpr int kWindows = 8;
    for (int i = 0; i < kWindows * 256; ++i) {
        StreamDatagram data;
        data.sequence = Sequence(7) + i;
        data.index = static_cast<uint8_t>(i % kMaxInGroup);
        data.payload = payload;
        receiver.input(data, nowNs += 20'000);
        receiver.consume(100);
        (void)receiver.tick(nowNs, out);
        ASSERT_LE(receiver.cumulative() - out.feedback().cumulative, 128) << i;
    }
    EXPECT_EQ(receiver.feedbackSent() - before, 2u * kWindows);
}

// A socket places payloads where the window requests them. Those are used in place, others copied, duplicates rejected,
// and slots do not leak.
TEST(Receiver, usesPayloadsInPlace) {
    ReceiverSettings settings;
    settings.shape = {100, 64};
    Receiver receiver(settings, Sequence(7));
    ReceiveBuffers landing = receiver.landing();
    ASSERT_GE(landing.bufferBytes, kStreamHeaderBytes + 100);
    ASSERT_GE(landing.buffers.size(), 4u);
    const auto come = [&](int number, std::span<const std::byte> payload) {
        StreamDatagram data;
        data.sequence = Sequence(7) + number;
        data.index = static_cast<uint8_t>(number % kMaxInGroup);
        data.payload = payload;
        receiver.input(data, 1'000'000);
    };
    const auto landed = [&](size_t place, int value) {
        std::byte* const at = landing.buffers[place] + kStreamHeaderBytes;
        std::fill_n(at, 100, static_cast<std::byte>(value));
        return std::span<const std::byte>(at, 100);
    };
    std::array<std::span<const std::byte>, 3> pieces;
    EXPECT_EQ(receiver.readable(pieces), 0u);
    come(0, landed(0, 10));
    come(1, landed(2, 11)); // one slot was skipped: another stream's, or a duplicate
    ASSERT_EQ(receiver.readable(pieces), 2u);
    EXPECT_EQ(pieces[0].data(), landing.buffers[0] + kStreamHeaderBytes);
    EXPECT_EQ(pieces[1].data(), landing.buffers[2] + kStreamHeaderBytes);
    come(1, landed(3, 99)); // a duplicate: rejected, and its slot is reused
    const std::vector<std::byte> elsewhere(100, std::byte{12});
    come(2, elsewhere);
    const ReceiveBuffers next = receiver.landing();
    for (std::byte* const place : next.buffers)
        for (const auto& piece : std::span(pieces).first(2)) EXPECT_NE(place + kStreamHeaderBytes, piece.data());
    for (const size_t again : {1, 3})
        EXPECT_NE(std::ranges::find(next.buffers, landing.buffers[again]), next.buffers.end()) << again;
    receiver.consume(40);
    ASSERT_EQ(receiver.readable(pieces), 3u);
    EXPECT_EQ(pieces[0].size(), 60u) << "what is left of it";
    EXPECT_EQ(receiver.readable().data(), pieces[0].data());
    std::vector<int> read;
    for (const auto piece : pieces) read.push_back(std::to_integer<int>(piece[0]));
    EXPECT_EQ(read, (std::vector{10, 11, 12}));
    receiver.consume(260);
    EXPECT_EQ(receiver.readable(pieces), 0u);
    // A whole unread window still leaves the usual number of slots.
    for (int i = 3; i < 3 + 64; ++i) {
        landing = receiver.landing();
        come(i, i % 3 == 0 ? std::span<const std::byte>(elsewhere)
                           : landed(static_cast<size_t>(i) % landing.buffers.size(), i));
    }
    EXPECT_EQ(receiver.landing().buffers.size(), next.buffers.size());
    for (int i = 3; i < 3 + 64; ++i) {
        ASSERT_FALSE(receiver.readable().empty());
        EXPECT_EQ(std::to_integer<int>(receiver.readable()[99]), i % 3 == 0 ? 12 : i);
        receiver.consume(100);
    }
}

} // namespace
} // namespace mural::rsp
