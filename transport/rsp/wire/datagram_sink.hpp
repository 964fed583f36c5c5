// Destination of the protocol's datagrams: seals them and passes them to a socket or a simulated network.
#pragma once

#include <algorithm>

#include "transport/rsp/wire/datagram.hpp"

namespace mural::rsp {

// Limits of one batch, whose datagrams have equal size: number, and bytes including headers. A shaper (tc tbf) splits a
// batch larger than its bucket, usually 64 KiB, into single datagrams; a batch that fits passes whole and costs the
// sender less. Seven datagrams of 8972 bytes fit, and 42 of 1472.
constexpr size_t kMaxInSending = 64;
constexpr size_t kMaxSendingBytes = 63'700;
constexpr size_t kDatagramHeadsBytes = 42; // Ethernet, IPv4, UDP

constexpr size_t maxInSend(size_t datagramBytes) {
    return std::clamp<size_t>(kMaxSendingBytes / (datagramBytes + kDatagramHeadsBytes), 1, kMaxInSending);
}

class DatagramSink {
public:
    DatagramSink() = default;
    DatagramSink(const DatagramSink&) = delete;
    DatagramSink& operator=(const DatagramSink&) = delete;
    virtual ~DatagramSink() = default;

    // Returns room for one datagram, without tag, to the group (kEverybody) or one member. The caller fills it before
    // the next call.
    virtual std::span<std::byte> datagram(MemberId to, size_t bytes) = 0;
};

} // namespace mural::rsp
