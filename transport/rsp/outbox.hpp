// Where the protocol puts the datagrams that it wants sent. The other side seals them and gives them to a socket, or to
// a simulated network.
#pragma once

#include <algorithm>

#include "transport/rsp/datagram.hpp"

namespace mural::rsp {

// One sending takes datagrams of one size: so many at most, and so many bytes with their own heads. A shaper on its way (tc's
// tbf) cuts what is longer than its bucket, 64 KiB most of the time, into datagrams that it passes one by one; what fits goes
// through it in one piece, which costs a sender less. Seven datagrams of 8972 bytes do, and 42 of 1472.
constexpr size_t kMostInSending = 64;
constexpr size_t kMostSendingBytes = 63'700;
constexpr size_t kDatagramHeadsBytes = 42; // Ethernet, IPv4, UDP

constexpr size_t mostInSending(size_t datagramBytes) {
    return std::clamp<size_t>(kMostSendingBytes / (datagramBytes + kDatagramHeadsBytes), 1, kMostInSending);
}

class Outbox {
public:
    Outbox() = default;
    Outbox(const Outbox&) = delete;
    Outbox& operator=(const Outbox&) = delete;
    virtual ~Outbox() = default;

    // Room for one datagram of so many bytes, without the seal's tag, to the group (kEverybody) or to one member. It is
    // filled before the next call.
    virtual std::span<std::byte> datagram(MemberId to, size_t bytes) = 0;
};

} // namespace mural::rsp
