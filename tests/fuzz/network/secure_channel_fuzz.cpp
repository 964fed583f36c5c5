// Both ends of a secure channel, with bytes between them that are changed, truncated, added and delayed. In every case
// an end accepts only messages of the other end, in their order.
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/network/fixed_random.hpp"
#include "tests/fuzz/network/input_reader.hpp"
#include "tests/fuzz/network/secure_channel_steps.hpp"
#include "transport/secure/secure_channel.hpp"

namespace mural::fuzz {

namespace {

using Bytes = std::vector<std::byte>;

struct End {
    SecureChannel channel;
    Bytes onTheWay{}; // in transit to the other end
    std::vector<Bytes> sent{};
    std::vector<Bytes> taken{};
};

uint64_t give(End& to, const End& from, std::span<const std::byte> bytes) {
    const size_t before = to.taken.size();
    (void)to.channel.input(bytes, to.taken);
    must(to.taken.size() <= from.sent.size(), "nothing is taken that was not sent");
    for (size_t i = before; i < to.taken.size(); ++i)
        must(to.taken[i] == from.sent[i], "what is taken is what was sent");
    return to.taken.size() - before;
}

uint64_t step(InputReader& in, End& from, End& to, ChannelStep what) {
    switch (what) {
    case ChannelStep::Pass: {
        const uint16_t count = in.half(), at = in.half();
        const uint8_t bits = in.byte();
        const auto made = from.channel.takeOutput();
        from.onTheWay.insert(from.onTheWay.end(), made.begin(), made.end());
        Bytes bytes(from.onTheWay.begin(),
                    from.onTheWay.begin() + static_cast<std::ptrdiff_t>(std::min<size_t>(count, from.onTheWay.size())));
        from.onTheWay.erase(from.onTheWay.begin(), from.onTheWay.begin() + static_cast<std::ptrdiff_t>(bytes.size()));
        change(bytes, at, bits);
        return give(to, from, bytes);
    }
    case ChannelStep::Add: return give(to, from, in.piece());
    case ChannelStep::Send: {
        auto message = in.piece();
        if (from.channel.send(message)) from.sent.push_back(std::move(message));
        return 0;
    }
    default: from.channel.finish(); return 0;
    }
}

} // namespace

// Runs one input: a byte that says whether the ends have the same secret, then steps. The upper bit of a step selects
// the end.
uint64_t fuzzOne(std::span<const std::byte> input) {
    fixRandom();
    InputReader in(input);
    const bool same = (in.byte() & 1) == 0;
    ChannelSecret secret{}, other{};
    if (!same) other[0] = std::byte{1};
    End member{SecureChannel::connecting("wall0", secret)};
    End host{SecureChannel::accepting(
        [other](const std::string& name) { return name.size() < 40 ? std::optional(other) : std::nullopt; })};
    uint64_t meant = 0;
    while (!in.empty()) {
        const uint8_t what = in.byte();
        const auto kind = static_cast<ChannelStep>((what & 0x7f) % static_cast<int>(ChannelStep::Count));
        meant += (what & 0x80) ? step(in, host, member, kind) : step(in, member, host, kind);
    }
    must(same || (host.taken.empty() && member.taken.empty() && !host.channel.open() && !member.channel.open()),
         "who does not know the secret gets nowhere");
    return meant;
}

} // namespace mural::fuzz
