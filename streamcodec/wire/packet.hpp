// Packets of the stream from the head to the render nodes, in traces, and on the way from the program to the head.
// Little-endian, 4-byte aligned. Grammar and versions: docs/reference/wire-format.md.
//
//   stream  = Packet*; after a Setup with `delta`: batches of packets (streamcodec/delta/batch_head.hpp)
//   Packet  = PacketHeader payload[sizeBytes]
//   payload of a packet of a capture stream = Record* (record.hpp, control_records.hpp)
#pragma once

#include <cstdint>

namespace mural::wire {

constexpr uint32_t kMagic = 0x4d52534d; // "MSRM"
constexpr uint32_t kVersion = 4;        // of packets and records, also in traces
constexpr uint32_t kBatchVersion =
    12; // of batches (streamcodec/delta/), head commands and messages, between head and nodes only

// Identifier of a capture stream: a client (a process of the program) and one of its threads.
// streamOf(0, 0) is the head's own stream, whose packets hold one HeadCommand each.
constexpr uint32_t streamOf(uint32_t client, uint32_t thread) { return client << 16 | thread; }
constexpr uint32_t clientOf(uint32_t stream) { return stream >> 16; }
constexpr uint16_t threadOf(uint32_t stream) { return static_cast<uint16_t>(stream); }

struct PacketHeader {
    uint32_t sizeBytes; // of the payload
    uint32_t stream;
};
constexpr uint32_t kMaxPacketBytes = 1u << 20;
// Maximum size of a batch of delta-coded packets (streamcodec/delta/), without its head.
constexpr uint32_t kMaxBatchBytes = 4u << 20;

} // namespace mural::wire
