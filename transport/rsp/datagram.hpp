// The datagrams of RSP on the wire, little endian. The layouts are told in docs/transport.md.
//
//   every one   0 u8 version<<4|type   1 u8 flags   2 u16 from   4 u32 session   8 u64 counter       (16 bytes)
//   DATA        16 u32 sequence   20 u8 index  21 u8 group size  22 u8 row  23 u8 rows sent
//               24 u32 sent at, us   28 u32 next sequence   32 payload
//   PARITY      as DATA: sequence of the group's first datagram; the payload is one row of its erasure code
//   POLL        as DATA without payload: sequence and size of the last group; who reads answers at once
//   FEEDBACK    16 u32 cumulative  20 u32 edge  24 u32 highest  28 u32 echo, us  32 u32 held, us  36 u16 to
//               38 u16 entries  40 u32 lost  44 u32 dropped by the socket
//               then 12 bytes per entry: u32 base, u32 missing, u8 rows held, u8 span, u16 0
//
// Behind them stands the tag of the seal (datagram_seal.hpp), which also fills in session and counter.
// Parsing takes what the seal has let through; it still trusts nothing: what is out of bounds is no datagram.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/little_endian.hpp"
#include "transport/rsp/sequence.hpp"

namespace mural::rsp {

using MemberId = uint16_t;
constexpr MemberId kEverybody = 0xffff;

constexpr uint8_t kVersion = 1;
constexpr size_t kHeadBytes = 16;
constexpr size_t kStreamHeadBytes = 32; // of DATA, PARITY and POLL
constexpr size_t kFeedbackHeadBytes = 48;
constexpr size_t kFeedbackEntryBytes = 12;
constexpr size_t kMostEntries = 64; // per FEEDBACK: bounds what a member can ask for at once
constexpr int kMostInGroup = 32;    // bitmaps are 32 bits wide
constexpr int kMostRows = 224;      // 256 - kMostInGroup: the erasure code's field has no more elements
constexpr size_t kLengthBytes = 2;  // a row of the code covers the lengths of the group's datagrams, too
// Ethernet, IPv4 and UDP around each datagram, gap and preamble included: what a link's rate is spent on.
constexpr size_t kWireOverheadBytes = 66;

enum class Type : uint8_t { Data = 1, Parity = 2, Poll = 3, Feedback = 4, Probe = 5 };

namespace flag {
constexpr uint8_t kPoll = 1;   // answer at once
constexpr uint8_t kRepair = 2; // sent before
} // namespace flag

struct Head {
    Type type{};
    uint8_t flags = 0;
    MemberId from = 0;
    uint32_t session = 0;
    uint64_t counter = 0;
};

// DATA, PARITY and POLL.
struct StreamDatagram {
    Type type = Type::Data;
    uint8_t flags = 0;
    MemberId from = 0;
    Sequence sequence; // DATA: its own; else the group's first
    uint8_t index = 0; // DATA: place in the group
    uint8_t groupSize = 0; // 0: not known yet
    uint8_t row = 0;       // PARITY
    uint8_t rowsSent = 0;
    uint32_t sentUs = 0; // the sender's clock, wraps
    Sequence next;       // behind the newest that was sent
    std::span<const std::byte> payload;

    [[nodiscard]] Sequence groupBase() const { return type == Type::Data ? sequence - index : sequence; }
};

struct Missing {
    Sequence base;
    uint32_t missing = 0; // bit i: base + i is not there
    uint8_t rows = 0;     // of this group's parity that are there
    uint8_t span = 0;     // how many numbers from base on this tells of, 1 to 32
};

struct Feedback {
    MemberId from = 0;
    uint8_t flags = 0;
    MemberId to = 0;     // whose stream it is about
    Sequence cumulative; // all before it are here
    Sequence edge;       // none from here on may be sent
    Sequence highest;    // behind the newest that came
    uint32_t echoUs = 0; // the newest datagram's time of sending
    uint32_t heldUs = 0; // since that came
    uint32_t lost = 0;   // so far, on the way
    uint32_t dropped = 0; // so far, by the receiver's own socket
    uint16_t entryCount = 0;
    std::array<Missing, kMostEntries> entries{};
};

// Writes the head of a datagram without session and counter; `into` has at least its bytes.
void writeStreamHead(const StreamDatagram& d, std::span<std::byte> into);
[[nodiscard]] size_t feedbackBytes(const Feedback& f);
void writeFeedback(const Feedback& f, std::span<std::byte> into);

inline uint8_t byteAt(std::span<const std::byte> d, size_t at) { return std::to_integer<uint8_t>(d[at]); }

// Nothing for what is too short, of another version, or out of bounds. Here, for it is done for each datagram that comes.
[[nodiscard]] inline std::optional<Head> readHead(std::span<const std::byte> d) {
    if (d.size() < kHeadBytes || byteAt(d, 0) >> 4 != kVersion) return {};
    const auto type = static_cast<Type>(byteAt(d, 0) & 0xf);
    if (type < Type::Data || type > Type::Probe) return {};
    return Head{type, byteAt(d, 1), loadLittle<uint16_t>(d.data() + 2), loadLittle<uint32_t>(d.data() + 4), loadLittle<uint64_t>(d.data() + 8)};
}
// Of one that has a head: somebody waits for what comes of it; for what members answer, only who has sent something.
[[nodiscard]] inline bool isUrgent(std::span<const std::byte> d, bool waitsForAnswers) {
    const auto type = static_cast<Type>(byteAt(d, 0) & 0xf);
    return (type == Type::Feedback && waitsForAnswers) || type == Type::Probe || (byteAt(d, 1) & flag::kPoll) != 0;
}
[[nodiscard]] std::optional<StreamDatagram> readStream(std::span<const std::byte> datagram);
// The same of one whose head was read.
[[nodiscard]] std::optional<StreamDatagram> readStream(const Head& head, std::span<const std::byte> datagram);
[[nodiscard]] std::optional<Feedback> readFeedback(std::span<const std::byte> datagram);

} // namespace mural::rsp
