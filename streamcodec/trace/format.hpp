// File format of traces, little-endian. docs/reference/trace.md has the grammar.
//
//   file    = Header about Block* Index Trailer
//   Block   = BlockHeader, entries compressed with Zstandard
//   entries = (EntryHeader payload, padded to kEntryAlign)*
//   Index   = IndexHeader IndexRow*
//
// Each part has a checksum (XXH3, 64 bits) over its other bytes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "streamcodec/wire/packet.hpp"

namespace mural::trace {

constexpr char kMagic[8] = {'M', 'U', 'R', 'A', 'L', 'R', 'E', 'C'};
constexpr char kEndMagic[8] = {'M', 'U', 'R', 'A', 'L', 'E', 'N', 'D'};
constexpr uint32_t kVersion = 1;
constexpr uint32_t kBlockMagic = 0x4b434c42; // "BLCK"
constexpr uint32_t kIndexMagic = 0x58444e49; // "INDX"

struct Header {
    char magic[8];
    uint32_t version;
    uint32_t wireVersion;    // format of the records: wire::kVersion
    uint64_t registryDigest; // command set of the records
    uint32_t aboutBytes;     // size of the following JSON (streamcodec/trace/about.hpp)
    uint32_t reserved;
    uint64_t checksum; // over the fields above and the JSON
};
static_assert(sizeof(Header) == 40);
constexpr uint32_t kMaxAboutBytes = 1u << 20;

struct BlockHeader {
    uint32_t magic;
    uint32_t packedBytes; // size of the following data
    uint32_t rawBytes;    // decompressed size
    uint32_t entries;
    uint64_t firstFrame;  // wall frame at the start of the block, from 1
    uint32_t framesEnded; // in it
    uint32_t reserved;
    uint64_t checksum; // over the fields above and the data
};
static_assert(sizeof(BlockHeader) == 40);
// Size at which a block ends: with the current frame, or within a much larger one.
constexpr size_t kBlockBytes = size_t{1} << 20;
constexpr size_t kMaxBlockBytes = size_t{8} << 20;

struct EntryHeader {
    uint32_t sizeBytes; // of the payload
    uint32_t stream;    // client << 16 | thread, as in wire::PacketHeader; 0: the payload is an Event
    uint64_t timeNs;    // since the start of the trace
};
static_assert(sizeof(EntryHeader) == 16);
constexpr size_t kEntryAlign = 8;
constexpr size_t entryBytes(size_t payloadBytes) {
    return sizeof(EntryHeader) + (payloadBytes + kEntryAlign - 1) / kEntryAlign * kEntryAlign;
}

// First word of an entry of stream 0.
enum class Event : uint32_t {
    ClientCame = 1, // u32 client, i32 pid, name
    ClientGone = 2, // u32 client
};

struct IndexHeader {
    uint32_t magic;
    uint32_t blocks;
    uint64_t frames;   // wall frames in the whole file
    uint64_t checksum; // over the fields above and the rows
};
static_assert(sizeof(IndexHeader) == 24);

struct IndexRow {
    uint64_t offset; // of the block in the file
    uint64_t firstFrame;
    uint32_t framesEnded;
    uint32_t entries;
};
static_assert(sizeof(IndexRow) == 24);

struct Trailer {
    uint64_t indexOffset;
    uint64_t checksum; // over the field above
    char magic[8];
};
static_assert(sizeof(Trailer) == 24);

} // namespace mural::trace
