// A reading end alone, with a writer that says what can't be.
#include <gtest/gtest.h>

#include "transport/rsp/receiver.hpp"

namespace mural::rsp {
namespace {

class Nowhere : public Outbox {
public:
    std::span<std::byte> datagram(MemberId, size_t bytes) override {
        bytes_.resize(bytes);
        return bytes_;
    }
    [[nodiscard]] Feedback told() const { return readFeedback(bytes_).value_or(Feedback{}); }

private:
    std::vector<std::byte> bytes_;
};

// Found by stream_fuzz: each number up to there was counted as lost, one by one.
TEST(Receiver, APollFarAheadTellsOfNoMoreThanTheWindow) {
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
    EXPECT_EQ(out.told().highest, Sequence(7) + 256);
}

// Found by stream_fuzz: it was before what had come, and behind the newest; all between, half of the numbers there are, was lost then, one by one.
TEST(Receiver, ADatagramOfHalfTheNumbersBeforeTellsOfNoLoss) {
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
    EXPECT_EQ(out.told().highest, Sequence(7) + 101);
}

} // namespace
} // namespace mural::rsp
