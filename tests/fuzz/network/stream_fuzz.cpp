// Both ends of one stream: datagrams arrive in any order, changed or invented, between calls of the ends. The datagrams
// are valid for the cipher: they simulate a malicious member.
#include <utility>

#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/network/datagram_pipe.hpp"
#include "tests/fuzz/network/input_reader.hpp"
#include "tests/fuzz/network/stream_steps.hpp"
#include "transport/rsp/protocol/receiver.hpp"
#include "transport/rsp/protocol/sender.hpp"

namespace mural::fuzz {

namespace {

using namespace rsp;

constexpr StreamShape kShape{100, 128};
constexpr MemberId kReader = 1;
constexpr size_t kMaxSteps = 2000;

class Stream {
public:
    explicit Stream(Sequence first)
        : sender_(senderSettings(), first), receiver_(receiverSettings(), sender_.addMember(kReader, nowNs_)) {}

    uint64_t step(InputReader& in) {
        switch (static_cast<StreamStep>(in.byte() % static_cast<int>(StreamStep::Count))) {
        case StreamStep::Wait: nowNs_ += int64_t{in.word()} * 1000; break;
        case StreamStep::ToReader: toReader(in.piece()); break;
        case StreamStep::ToWriter: toWriter(in.piece()); break;
        case StreamStep::Write: {
            const std::vector<std::byte> bytes(in.half(), std::byte{7});
            must(sender_.write(bytes) <= bytes.size(), "no more is written than was given");
            break;
        }
        case StreamStep::Flush: sender_.flush(); break;
        case StreamStep::Read: receiver_.consume(std::min<size_t>(in.half(), receiver_.readable().size())); break;
        case StreamStep::PassOn: pass(in, sent_, [this](const auto& d) { toReader(d); }); break;
        case StreamStep::Answer: pass(in, feedback_, [this](const auto& d) { toWriter(d); }); break;
        case StreamStep::Lose: (void)sent_.take(); break;
        case StreamStep::AddMember: (void)sender_.addMember(in.byte(), nowNs_); break;
        default: sender_.removeMember(in.byte()); break;
        }
        const Sequence before = receiver_.cumulative();
        must(sender_.tick(nowNs_, sent_) > INT64_MIN, "the writer wants to be asked again some time");
        const uint32_t lostBefore = receiver_.lost();
        (void)receiver_.tick(nowNs_, feedback_);
        must(receiver_.lost() - lostBefore <= kShape.windowDatagrams, "no more is lost than a window");
        must(receiver_.cumulative() == before, "telling moves nothing");
        must(sender_.roomBytes() <= kShape.payloadBytes * kShape.windowDatagrams,
             "there is no more room than the window");
        for (const std::byte b : receiver_.readable()) sum_ = static_cast<uint8_t>(sum_ + std::to_integer<uint8_t>(b));
        return std::exchange(meant_, 0);
    }

private:
    static SenderSettings senderSettings() {
        SenderSettings s;
        s.shape = kShape;
        return s;
    }
    static ReceiverSettings receiverSettings() {
        ReceiverSettings s;
        s.shape = kShape;
        s.self = kReader;
        s.socketDatagrams = 64;
        return s;
    }
    template <class To> static void pass(InputReader& in, DatagramPipe& pipe, To to) {
        const uint16_t at = in.half();
        const uint8_t bits = in.byte();
        auto datagram = pipe.take();
        if (!datagram) return;
        change(*datagram, at, bits);
        to(*datagram);
    }
    void toReader(const std::vector<std::byte>& bytes) {
        const auto d = readStream(bytes);
        if (!d) return;
        const Sequence before = receiver_.cumulative();
        receiver_.input(*d, nowNs_);
        must(before <= receiver_.cumulative(), "what has come does not go");
        ++meant_;
    }
    void toWriter(const std::vector<std::byte>& bytes) {
        const auto f = readFeedback(bytes);
        if (!f) return;
        sender_.input(*f, nowNs_);
        ++meant_;
    }

    int64_t nowNs_ = 1'000'000'000;
    Sender sender_;
    Receiver receiver_;
    DatagramPipe sent_, feedback_;
    uint64_t meant_ = 0;
    volatile uint8_t sum_ = 0; // touches all readable bytes
};

} // namespace

// Runs one input: the number of the first datagram (4 bytes), then steps.
uint64_t fuzzOne(std::span<const std::byte> input) {
    InputReader in(input);
    Stream stream{Sequence(in.word())};
    uint64_t meant = 0;
    for (size_t steps = 0; !in.empty() && steps < kMaxSteps; ++steps) meant += stream.step(in);
    return meant;
}

} // namespace mural::fuzz
