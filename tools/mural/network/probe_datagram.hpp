// Probe datagrams of `mural doctor --network`. Not part of a session: RSP rejects them by their first byte.
// Little-endian:
//
//   0 "MURALNP1"   8 u64 survey   16 u8 way   17 u8 1: from the doctor, 0: to it   18 u16 total size   20 u32 0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace mural::cli {

// Destination of a probe.
enum class ProbePath : uint8_t {
    Single = 0,    // the machine's unicast address
    Group = 1,     // the multicast group
    LinkLocal = 2, // a multicast group that switches always forward (RFC 4541, 2.1.2)
};
constexpr ProbePath kProbePaths[] = {ProbePath::Single, ProbePath::Group, ProbePath::LinkLocal};

constexpr size_t kMinProbeBytes = 24;

struct ProbeDatagram {
    uint64_t survey = 0; // random; distinguishes surveys
    ProbePath path = ProbePath::Single;
    bool fromDoctor = false;
    uint16_t sizeBytes = kMinProbeBytes;
};

// `into` has the size of the datagram.
void writeProbe(const ProbeDatagram& probe, std::span<std::byte> into);
// Returns an empty value for other or truncated datagrams.
[[nodiscard]] std::optional<ProbeDatagram> readProbe(std::span<const std::byte> datagram);

} // namespace mural::cli
