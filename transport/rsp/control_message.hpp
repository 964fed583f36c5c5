// What members and host of a group tell each other over their secure channels. Little endian; texts and lists are
// bounded; what does not parse whole is refused.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "transport/rsp/keys.hpp"
#include "transport/rsp/sequence.hpp"
#include "transport/uuid.hpp"

namespace mural::rsp {

// Member to host, first.
struct Join {
    Uuid uuid{};
    uint16_t udpPort = 0;            // of its own socket
    uint32_t socketDatagrams = 0;    // that its socket holds
    uint16_t mostDatagramBytes = 0;  // UDP payload that its card takes whole
    uint8_t seals = 0;               // bit s: it can do Seal(s)
    bool multicast = true;           // it wants datagrams, if they reach it
};
// Host to member: you are one.
struct Welcome {
    MemberId self = 0;
    SessionKeys keys;
    std::string group; // address and port, as text
    uint16_t datagramBytes = 0;
    uint32_t windowDatagrams = 0;
    uint32_t probeNonce = 0; // comes in the probes that this member shall see
};
// Member to host: the probe came.
struct Probed {
    uint32_t nonce = 0;
};
// Host to all: another member, at that address. Each now begins its stream to it.
struct MemberCame {
    MemberId id = 0;
    Uuid uuid{};
    std::string address;
    uint16_t udpPort = 0;
    bool multicast = false; // else its datagrams go by Tunnel
};
// Of a writer, through the host: your stream begins here.
struct StreamStart {
    MemberId writer = 0;
    MemberId reader = 0;
    Sequence first;
};
enum class GoneReason : uint8_t { Left = 0, Silent = 1, Stalled = 2, Cut = 3, Removed = 4 };
struct MemberGone {
    MemberId id = 0;
    GoneReason reason = GoneReason::Left;
};
// A datagram, unsealed, for who is not reached by UDP.
struct Tunnel {
    MemberId to = 0;
    std::vector<std::byte> datagram;
};
// Host to member: no; then the channel ends.
struct Refused {
    std::string why;
};
struct Leave {};
// Host to all: multicast does not reach this member any longer, its datagrams go by Tunnel from now on; or it does again.
struct Rerouted {
    MemberId id = 0;
    bool multicast = false;
    uint32_t probeNonce = 0; // comes in the probes that the member answers when one reaches it
};
struct Ping {
    uint64_t number = 0;
    bool answer = false;
};

using ControlMessage = std::variant<Join, Welcome, Probed, MemberCame, StreamStart, MemberGone, Tunnel, Refused, Leave, Ping, Rerouted>;

[[nodiscard]] std::vector<std::byte> encode(const ControlMessage& message);
[[nodiscard]] std::optional<ControlMessage> decode(std::span<const std::byte> bytes);

} // namespace mural::rsp
