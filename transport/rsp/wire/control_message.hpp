// Control messages between members and the host of a group, over secure channels. Little-endian; texts and lists are
// bounded; a message that does not parse completely is rejected.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "transport/rsp/wire/keys.hpp"
#include "transport/rsp/wire/sequence.hpp"
#include "transport/uuid.hpp"

namespace mural::rsp {

// Member to host: first message.
struct Join {
    Uuid uuid{};
    uint16_t udpPort = 0;          // port of its unicast socket
    uint32_t socketDatagrams = 0;  // capacity of its socket buffer
    uint16_t maxDatagramBytes = 0; // largest UDP payload without fragmentation
    uint8_t seals = 0;             // bit s: supports Seal(s)
    bool multicast = true;         // wants multicast if it is reachable
};
// Host to member: accepted.
struct Welcome {
    MemberId self = 0;
    SessionKeys keys;
    std::string group; // multicast address and port as text
    uint16_t datagramBytes = 0;
    uint32_t windowDatagrams = 0;
    uint32_t probeNonce = 0; // nonce of the multicast probes for this member
};
// Member to host: a probe arrived.
struct Probed {
    uint32_t nonce = 0;
};
// Host to all: a new member. Each member now begins its stream to it.
struct MemberCame {
    MemberId id = 0;
    Uuid uuid{};
    std::string address;
    uint16_t udpPort = 0;
    bool multicast = false; // false: its datagrams travel as Tunnel messages
};
// Writer to member, through the host: start of the writer's stream.
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
// A datagram, unsealed, for a member that UDP does not reach.
struct Tunnel {
    MemberId to = 0;
    std::vector<std::byte> datagram;
};
// Host to member: rejected. The channel ends.
struct Refused {
    std::string why;
};
struct Leave {};
// Host to all: whether multicast reaches this member. Otherwise its datagrams travel as Tunnel messages.
struct Rerouted {
    MemberId id = 0;
    bool multicast = false;
    uint32_t probeNonce = 0; // nonce of the probes that the member answers
};
struct Ping {
    uint64_t number = 0;
    bool answer = false;
};

using ControlMessage =
    std::variant<Join, Welcome, Probed, MemberCame, StreamStart, MemberGone, Tunnel, Refused, Leave, Ping, Rerouted>;

[[nodiscard]] std::vector<std::byte> encode(const ControlMessage& message);
[[nodiscard]] std::optional<ControlMessage> decode(std::span<const std::byte> bytes);

} // namespace mural::rsp
