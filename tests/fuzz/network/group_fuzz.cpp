// A host and a member of a group whose control messages and datagrams are changed, invented, lost and reordered. Other
// members are invented completely. All bytes are valid for the cipher: they simulate a malicious member or host.
#include <deque>
#include <utility>

#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/network/datagram_pipe.hpp"
#include "tests/fuzz/network/fixed_random.hpp"
#include "tests/fuzz/network/group_steps.hpp"
#include "tests/fuzz/network/input_reader.hpp"
#include "transport/rsp/protocol/group_core.hpp"

namespace mural::fuzz {

namespace {

using namespace rsp;

constexpr size_t kMaxSteps = 500;
constexpr size_t kMaxConnections = 32;
constexpr MemberId kMember = 1; // the genuine one connects first

struct Message {
    MemberId to;
    std::vector<std::byte> bytes;
};

// Executes the requests of a group core: messages to the genuine peer are kept, all others are dropped.
class End : public GroupOutput {
public:
    explicit End(const GroupSettings& settings) : core(settings, *this) {}

    void control(MemberId to, const ControlMessage& message) override {
        must(encode(message).size() <= 70'000, "a message has its limits");
        if (messages.size() < 256) messages.push_back({to, encode(message)});
    }
    std::span<std::byte> datagram(MemberId to, size_t bytes) override { return pipe.datagram(to, bytes); }
    bool behind() override { return false; }
    void welcomed(const Welcome&) override {}
    void memberCame(MemberId, const MemberInfo&) override {}
    void memberGone(MemberId, GoneReason) override {}
    void memberRerouted(MemberId, bool) override {}
    void hangUp(MemberId id, const std::string&) override { hungUp.push_back(id); }

    void read() {
        for (const auto& [id, info] : core.members()) {
            if (Receiver* r = core.receiver(id)) r->consume(r->readable().size());
        }
    }

    std::deque<Message> messages;
    DatagramPipe pipe;
    std::vector<MemberId> hungUp;
    GroupCore core;
};

GroupSettings settings(bool host) {
    GroupSettings s;
    s.host = host;
    s.keys = makeSessionKeys(Seal::None);
    s.group = "239.255.77.85:4277";
    s.datagramBytes = 512;
    s.windowDatagrams = 64;
    s.socketDatagrams = 64;
    return s;
}

class Pair {
public:
    Pair() : host_(settings(true)), member_(settings(false)) {
        open_.push_back(*host_.core.connected("192.0.2.1", "member", nowNs_));
        member_.core.begin();
    }
    uint64_t step(InputReader& in) {
        take(in);
        (void)host_.core.tick(nowNs_);
        (void)member_.core.tick(nowNs_);
        for (const MemberId id : std::exchange(host_.hungUp, {})) disconnect(id);
        return std::exchange(meant_, 0);
    }

private:
    void take(InputReader& in) {
        switch (static_cast<GroupStep>(in.byte() % static_cast<int>(GroupStep::Count))) {
        case GroupStep::Wait: nowNs_ += int64_t{in.word()} * 1000; break;
        case GroupStep::Connect:
            if (open_.size() >= kMaxConnections) break;
            if (const auto id = host_.core.connected("192.0.2.2", "other", nowNs_)) open_.push_back(*id);
            break;
        case GroupStep::Disconnect: disconnect(in.byte()); break;
        case GroupStep::ControlToHost: {
            const MemberId id = in.byte();
            toHost(id, in.piece());
            break;
        }
        case GroupStep::ControlToMember: toMember(in.piece()); break;
        case GroupStep::PassToHost: pass(in, member_, [this](const Message& m) { toHost(kMember, m.bytes); }); break;
        case GroupStep::PassToMember:
            pass(in, host_, [this](const Message& m) {
                if (m.to == kMember) toMember(m.bytes);
            });
            break;
        case GroupStep::DatagramToHost: host_.core.inputDatagram(in.piece(), nowNs_); break;
        case GroupStep::DatagramToMember: member_.core.inputDatagram(in.piece(), nowNs_); break;
        case GroupStep::PassDatagramToHost: passDatagram(in, member_, host_); break;
        case GroupStep::PassDatagramToMember: passDatagram(in, host_, member_); break;
        case GroupStep::WriteAtHost: write(host_, in.half()); break;
        case GroupStep::WriteAtMember: write(member_, in.half()); break;
        default: host_.read(), member_.read(); break;
        }
    }
    void disconnect(MemberId id) {
        if (std::erase(open_, id) == 0) return;
        host_.core.disconnected(id, nowNs_);
    }
    void toHost(MemberId from, const std::vector<std::byte>& bytes) {
        const auto message = decode(bytes);
        if (!message || std::ranges::find(open_, from) == open_.end()) return;
        host_.core.inputControl(from, *message, nowNs_);
        ++meant_;
    }
    void toMember(const std::vector<std::byte>& bytes) {
        const auto message = decode(bytes);
        if (!message || member_.core.over()) return;
        member_.core.inputControl(kHost, *message, nowNs_);
        ++meant_;
    }
    template <class To> static void pass(InputReader& in, End& from, To to) {
        const uint16_t at = in.half();
        const uint8_t bits = in.byte();
        if (from.messages.empty()) return;
        Message m = std::move(from.messages.front());
        from.messages.pop_front();
        change(m.bytes, at, bits);
        to(m);
    }
    void passDatagram(InputReader& in, End& from, End& to) const {
        const uint16_t at = in.half();
        const uint8_t bits = in.byte();
        auto datagram = from.pipe.take();
        if (!datagram) return;
        change(*datagram, at, bits);
        to.core.inputDatagram(*datagram, nowNs_);
    }
    static void write(End& end, size_t bytes) {
        Sender* sender = end.core.sender();
        if (!sender) return;
        (void)sender->write(std::vector<std::byte>(bytes));
        sender->flush();
    }

    int64_t nowNs_ = 1'000'000'000;
    End host_, member_;
    std::vector<MemberId> open_; // open control connections
    uint64_t meant_ = 0;
};

} // namespace

uint64_t fuzzOne(std::span<const std::byte> input) {
    fixRandom();
    InputReader in(input);
    Pair pair;
    uint64_t meant = 0;
    for (size_t steps = 0; !in.empty() && steps < kMaxSteps; ++steps) meant += pair.step(in);
    return meant;
}

} // namespace mural::fuzz
