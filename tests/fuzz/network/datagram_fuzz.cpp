// Datagrams of RSP and their cipher. Input: a byte that selects the cipher, then steps: a byte for the action, and its
// bytes.
#include <algorithm>

#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/network/fixed_random.hpp"
#include "tests/fuzz/network/input_reader.hpp"
#include "transport/rsp/wire/datagram_cipher.hpp"

namespace mural::fuzz {

namespace {

using namespace rsp;

constexpr MemberId kWriter = 3;

struct Ends {
    explicit Ends(Seal seal)
        : keys(makeSessionKeys(seal)),
          others(makeSessionKeys(seal)),
          sealer(keys, kWriter),
          right(keys),
          wrong((others.session = keys.session, others)) {
        right.addMember(kWriter);
        wrong.addMember(kWriter);
    }
    SessionKeys keys, others;
    DatagramSealer sealer;
    DatagramOpener right, wrong;
};

bool same(const Feedback& a, const Feedback& b) {
    const auto sameEntry = [](const Missing& x, const Missing& y) {
        return x.base == y.base && x.missing == y.missing && x.rows == y.rows && x.span == y.span;
    };
    return a.from == b.from && a.to == b.to && a.flags == b.flags && a.cumulative == b.cumulative && a.edge == b.edge &&
           a.highest == b.highest && a.echoUs == b.echoUs && a.ackDelayUs == b.ackDelayUs && a.lost == b.lost &&
           a.dropped == b.dropped && a.entryCount == b.entryCount &&
           std::equal(a.entries.begin(), a.entries.begin() + a.entryCount, b.entries.begin(), sameEntry);
}

// Parses a datagram. A valid one must be unchanged after writing and reading it again.
uint64_t parse(std::span<const std::byte> datagram) {
    uint64_t meant = 0;
    if (const auto d = readStream(datagram)) {
        std::vector<std::byte> again(datagram.begin(), datagram.end());
        writeStreamHeader(*d, again);
        const auto twice = readStream(again);
        must(twice && twice->sequence == d->sequence && twice->next == d->next &&
                 twice->payload.size() == d->payload.size(),
             "a stream's datagram is read as it was written");
        must(kStreamHeaderBytes + d->payload.size() == datagram.size(), "a payload lies within its datagram");
        ++meant;
    }
    if (const auto f = readFeedback(datagram)) {
        std::vector<std::byte> again(feedbackBytes(*f));
        writeFeedback(*f, again);
        const auto twice = readFeedback(again);
        must(twice && same(*f, *twice), "feedback is read as it was written");
        ++meant;
    }
    return meant;
}

// Sends a genuine datagram, changed in transit by `bits`.
void sealAndOpen(Ends& e, Seal seal, const std::vector<std::byte>& payload, uint16_t at, uint8_t bits) {
    std::vector<std::byte> sealed(kStreamHeaderBytes + payload.size() + tagBytes(seal));
    StreamDatagram header;
    header.from = kWriter;
    writeStreamHeader(header, sealed);
    std::ranges::copy(payload, sealed.begin() + kStreamHeaderBytes);
    e.sealer.seal(sealed);
    const bool changed = change(sealed, at, bits);
    std::vector<std::byte> first = sealed, second = sealed, strange = sealed;
    const auto opened = e.right.open(first);
    const bool taken = !opened.empty();
    // Without a cipher forgeries cannot be detected: invented counters reject the genuine datagrams.
    if (seal == Seal::None) return;
    must(taken == !changed, "what is genuine is taken, and nothing else");
    must(e.wrong.open(strange).empty(), "nothing is taken with another key");
    if (!changed) {
        must(taken && std::ranges::equal(opened.subspan(kStreamHeaderBytes), payload),
             "what is taken is what was sealed");
        must(e.right.open(second).empty(), "nothing is taken twice");
    }
}

} // namespace

uint64_t fuzzOne(std::span<const std::byte> input) {
    fixRandom();
    InputReader in(input);
    auto seal = static_cast<Seal>(in.byte() % 4);
    if (!available(seal)) seal = Seal::ChaCha;
    Ends ends(seal);
    uint64_t meant = 0;
    while (!in.empty()) {
        const uint8_t what = in.byte();
        const uint16_t at = what % 3 == 2 ? in.half() : uint16_t{0};
        const uint8_t bits = what % 3 == 2 ? in.byte() : uint8_t{0};
        auto bytes = in.piece();
        if (what % 3 == 0)
            meant += parse(bytes);
        else if (what % 3 == 2)
            sealAndOpen(ends, seal, bytes, at, bits), ++meant;
        else if (const auto opened = ends.right.open(bytes); !opened.empty())
            meant += parse(opened), must(seal == Seal::None, "nothing is taken without a key");
    }
    return meant;
}

} // namespace mural::fuzz
