// The datagrams by which `mural doctor --network` finds out what arrives. No part of a session: RSP's ends refuse them by
// their first byte. Little endian:
//
//   0 "MURALNP1"   8 u64 survey   16 u8 way   17 u8 1: from the doctor, 0: to it   18 u16 size of the whole   20 u32 0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace mural::cli {

// What it was sent to.
enum class ProbeWay : uint8_t {
    Single = 0,    // the machine's own address
    Group = 1,     // the multicast group
    LinkLocal = 2, // a multicast group that switches let through everywhere (RFC 4541, 2.1.2)
};
constexpr ProbeWay kProbeWays[] = {ProbeWay::Single, ProbeWay::Group, ProbeWay::LinkLocal};

constexpr size_t kLeastProbeBytes = 24;

struct ProbeDatagram {
    uint64_t survey = 0; // random: others' are not ours
    ProbeWay way = ProbeWay::Single;
    bool fromDoctor = false;
    uint16_t sizeBytes = kLeastProbeBytes;
};

// `into` has the datagram's size.
void writeProbe(const ProbeDatagram& probe, std::span<std::byte> into);
// Nothing for what is no probe, or has not come whole.
[[nodiscard]] std::optional<ProbeDatagram> readProbe(std::span<const std::byte> datagram);

} // namespace mural::cli
