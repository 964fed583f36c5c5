#include "transport/rsp/wire/datagram.hpp"

#include <algorithm>

#include "common/base/little_endian.hpp"

namespace mural::rsp {

namespace {

void writeHeader(std::byte* at, Type type, uint8_t flags, MemberId from) {
    at[0] = static_cast<std::byte>(kVersion << 4 | static_cast<uint8_t>(type));
    at[1] = static_cast<std::byte>(flags);
    storeLittle<uint16_t>(at + 2, from);
    std::fill(at + 4, at + kHeaderBytes, std::byte{0});
}

bool inBounds(const StreamDatagram& d) {
    if (d.groupSize > kMaxInGroup || d.index >= kMaxInGroup || d.row >= kMaxRows) return false;
    switch (d.type) {
    case Type::Data: return !d.payload.empty() && (d.groupSize == 0 || d.index < d.groupSize);
    case Type::Parity: return d.groupSize != 0 && d.payload.size() > kLengthBytes;
    default: return d.payload.empty();
    }
}

} // namespace

void writeStreamHeader(const StreamDatagram& d, std::span<std::byte> into) {
    std::byte* at = into.data();
    writeHeader(at, d.type, d.flags, d.from);
    storeLittle(at + 16, d.sequence.value());
    at[20] = static_cast<std::byte>(d.index);
    at[21] = static_cast<std::byte>(d.groupSize);
    at[22] = static_cast<std::byte>(d.row);
    at[23] = static_cast<std::byte>(d.rowsSent);
    storeLittle(at + 24, d.sentUs);
    storeLittle(at + 28, d.next.value());
}

size_t feedbackBytes(const Feedback& f) { return kFeedbackHeaderBytes + f.entryCount * kFeedbackEntryBytes; }

void writeFeedback(const Feedback& f, std::span<std::byte> into) {
    std::byte* at = into.data();
    writeHeader(at, Type::Feedback, f.flags, f.from);
    storeLittle(at + 16, f.cumulative.value());
    storeLittle(at + 20, f.edge.value());
    storeLittle(at + 24, f.highest.value());
    storeLittle(at + 28, f.echoUs);
    storeLittle(at + 32, f.ackDelayUs);
    storeLittle<uint16_t>(at + 36, f.to);
    storeLittle<uint16_t>(at + 38, f.entryCount);
    storeLittle(at + 40, f.lost);
    storeLittle(at + 44, f.dropped);
    at += kFeedbackHeaderBytes;
    for (size_t i = 0; i < f.entryCount; ++i, at += kFeedbackEntryBytes) {
        const Missing& m = f.entries[i];
        storeLittle(at, m.base.value());
        storeLittle(at + 4, m.missing);
        at[8] = static_cast<std::byte>(m.rows);
        at[9] = static_cast<std::byte>(m.span);
        storeLittle<uint16_t>(at + 10, 0);
    }
}

std::optional<StreamDatagram> readStream(std::span<const std::byte> d) {
    const auto header = readHeader(d);
    return header ? readStream(*header, d) : std::nullopt;
}

// Constructed in place: copying the freshly written struct would stall on store forwarding and dominate this function.
std::optional<StreamDatagram> readStream(const Header& header, std::span<const std::byte> d) {
    std::optional<StreamDatagram> read;
    if (header.type > Type::Poll || d.size() < kStreamHeaderBytes) return read;
    StreamDatagram& s = read.emplace();
    s.type = header.type;
    s.flags = header.flags;
    s.from = header.from;
    s.sequence = Sequence(loadLittle<uint32_t>(d.data() + 16));
    s.index = byteAt(d, 20);
    s.groupSize = byteAt(d, 21);
    s.row = byteAt(d, 22);
    s.rowsSent = byteAt(d, 23);
    s.sentUs = loadLittle<uint32_t>(d.data() + 24);
    s.next = Sequence(loadLittle<uint32_t>(d.data() + 28));
    s.payload = d.subspan(kStreamHeaderBytes);
    if (!inBounds(s)) read.reset();
    return read;
}

std::optional<Feedback> readFeedback(std::span<const std::byte> d) {
    const auto header = readHeader(d);
    if (!header || header->type != Type::Feedback || d.size() < kFeedbackHeaderBytes) return {};
    Feedback f;
    f.from = header->from;
    f.flags = header->flags;
    f.cumulative = Sequence(loadLittle<uint32_t>(d.data() + 16));
    f.edge = Sequence(loadLittle<uint32_t>(d.data() + 20));
    f.highest = Sequence(loadLittle<uint32_t>(d.data() + 24));
    f.echoUs = loadLittle<uint32_t>(d.data() + 28);
    f.ackDelayUs = loadLittle<uint32_t>(d.data() + 32);
    f.to = loadLittle<uint16_t>(d.data() + 36);
    f.entryCount = loadLittle<uint16_t>(d.data() + 38);
    f.lost = loadLittle<uint32_t>(d.data() + 40);
    f.dropped = loadLittle<uint32_t>(d.data() + 44);
    if (f.entryCount > kMaxEntries || d.size() != feedbackBytes(f)) return {};
    for (size_t i = 0; i < f.entryCount; ++i) {
        const std::byte* at = d.data() + kFeedbackHeaderBytes + i * kFeedbackEntryBytes;
        Missing& m = f.entries[i];
        m = {Sequence(loadLittle<uint32_t>(at)), loadLittle<uint32_t>(at + 4), std::to_integer<uint8_t>(at[8]),
             std::to_integer<uint8_t>(at[9])};
        if (m.span == 0 || m.span > kMaxInGroup) return {};
        if (m.span < 32 && m.missing >> m.span != 0) return {};
    }
    return f;
}

} // namespace mural::rsp
