// Wire format of RSP datagrams, little-endian. docs/architecture/transport.md describes the layouts.
//
//   all         0 u8 version<<4|type   1 u8 flags   2 u16 from   4 u32 session   8 u64 counter       (16 bytes)
//   DATA        16 u32 sequence   20 u8 index  21 u8 group size  22 u8 row  23 u8 rows sent
//               24 u32 sent at, us   28 u32 next sequence   32 payload
//   PARITY      as DATA: sequence of the group's first datagram; the payload is one parity symbol
//   POLL        as DATA without payload: sequence and size of the last group; receivers answer immediately
//   FEEDBACK    16 u32 cumulative  20 u32 edge  24 u32 highest  28 u32 echo, us  32 u32 held, us  36 u16 to
//               38 u16 entries  40 u32 lost  44 u32 dropped by the socket
//               then 12 bytes per entry: u32 base, u32 missing, u8 rows held, u8 span, u16 0
//
// The authentication tag follows (datagram_cipher.hpp, which also sets session and counter). The parser runs after
// authentication and still validates every field.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/base/little_endian.hpp"
#include "transport/rsp/wire/sequence.hpp"

namespace mural::rsp {

using MemberId = uint16_t;
constexpr MemberId kEverybody = 0xffff;

constexpr uint8_t kVersion = 1;
constexpr size_t kHeaderBytes = 16;
constexpr size_t kStreamHeaderBytes = 32; // of DATA, PARITY and POLL
constexpr size_t kFeedbackHeaderBytes = 48;
constexpr size_t kFeedbackEntryBytes = 12;
constexpr size_t kMaxEntries = 64; // per FEEDBACK: bounds the retransmissions that a member can request at once
constexpr int kMaxInGroup = 32;    // bitmaps have 32 bits
constexpr int kMaxRows = 224;      // 256 - kMaxInGroup: the field has no more elements
constexpr size_t kLengthBytes = 2; // a parity symbol also covers the lengths of the group's datagrams
// Overhead of Ethernet, IPv4 and UDP per datagram, including gap and preamble, for link rates.
constexpr size_t kWireOverheadBytes = 66;

enum class Type : uint8_t { Data = 1, Parity = 2, Poll = 3, Feedback = 4, Probe = 5 };

namespace flag {
constexpr uint8_t kPoll = 1;   // requests immediate feedback
constexpr uint8_t kRepair = 2; // retransmission
} // namespace flag

struct Header {
    Type type{};
    uint8_t flags = 0;
    MemberId from = 0;
    uint32_t session = 0;
    uint64_t counter = 0;
};

// Fields of DATA, PARITY and POLL.
struct StreamDatagram {
    Type type = Type::Data;
    uint8_t flags = 0;
    MemberId from = 0;
    Sequence sequence;     // DATA: its own; otherwise the number of the group's first datagram
    uint8_t index = 0;     // DATA: index in the group
    uint8_t groupSize = 0; // 0: not known yet
    uint8_t row = 0;       // PARITY: index of the parity symbol
    uint8_t rowsSent = 0;
    uint32_t sentUs = 0; // sender's clock, wraps
    Sequence next;       // one past the newest sequence number sent
    std::span<const std::byte> payload;

    [[nodiscard]] Sequence groupBase() const { return type == Type::Data ? sequence - index : sequence; }
};

struct Missing {
    Sequence base;
    uint32_t missing = 0; // bit i: base + i is missing
    uint8_t rows = 0;     // received parity symbols of this group
    uint8_t span = 0;     // sequence numbers covered from base on, 1 to 32
};

struct Feedback {
    MemberId from = 0;
    uint8_t flags = 0;
    MemberId to = 0;         // writer of the stream
    Sequence cumulative;     // cumulative acknowledgement: everything before has been received
    Sequence edge;           // end of the receive window
    Sequence highest;        // one past the newest received sequence number
    uint32_t echoUs = 0;     // send time of the newest datagram
    uint32_t ackDelayUs = 0; // time since its arrival
    uint32_t lost = 0;       // total lost in the network
    uint32_t dropped = 0;    // total dropped by the receiver's socket
    uint16_t entryCount = 0;
    std::array<Missing, kMaxEntries> entries{};
};

// Writes the header without session and counter. Requires sufficient room.
void writeStreamHeader(const StreamDatagram& d, std::span<std::byte> into);
[[nodiscard]] size_t feedbackBytes(const Feedback& f);
void writeFeedback(const Feedback& f, std::span<std::byte> into);

inline uint8_t byteAt(std::span<const std::byte> d, size_t at) { return std::to_integer<uint8_t>(d[at]); }

// Parses the header. Rejects datagrams that are too short, of another version, or with invalid fields. Inline, because
// it runs per datagram.
[[nodiscard]] inline std::optional<Header> readHeader(std::span<const std::byte> d) {
    if (d.size() < kHeaderBytes || byteAt(d, 0) >> 4 != kVersion) return {};
    const auto type = static_cast<Type>(byteAt(d, 0) & 0xf);
    if (type < Type::Data || type > Type::Probe) return {};
    return Header{type, byteAt(d, 1), loadLittle<uint16_t>(d.data() + 2), loadLittle<uint32_t>(d.data() + 4),
                  loadLittle<uint64_t>(d.data() + 8)};
}
// Returns true if the datagram must be processed immediately: POLL, PROBE, or FEEDBACK while this member has
// unacknowledged data. Requires a valid header.
[[nodiscard]] inline bool isUrgent(std::span<const std::byte> d, bool waitsForAnswers) {
    const auto type = static_cast<Type>(byteAt(d, 0) & 0xf);
    return (type == Type::Feedback && waitsForAnswers) || type == Type::Probe || (byteAt(d, 1) & flag::kPoll) != 0;
}
[[nodiscard]] std::optional<StreamDatagram> readStream(std::span<const std::byte> datagram);
// Parses the body of a datagram with a valid header.
[[nodiscard]] std::optional<StreamDatagram> readStream(const Header& header, std::span<const std::byte> datagram);
[[nodiscard]] std::optional<Feedback> readFeedback(std::span<const std::byte> datagram);

} // namespace mural::rsp
