// The header of a record, shared by encoder and decoders. See docs/reference/wire-format.md.
//
//   Record = u32 header (low 16 bits opcode, high 16 bits length in 4-byte words, header included;
//            kLongForm: the next u32 is the length in words), arguments
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace mural::record {

constexpr uint32_t kLongForm = 0xffff;   // in the length field: the next word holds the length
constexpr uint32_t kInlineBytes = 16384; // larger values precede their record as blobs
constexpr uint32_t kBlobPieceBytes = 65536;

// The first word of a variable-size value. Values below kTagBlob count inline bytes.
constexpr uint32_t kTagNull = 0xffffffff;
constexpr uint32_t kTagOffset = 0xfffffffe; // a u64 offset into a bound buffer follows
constexpr uint32_t kTagBlob = 0xfffffffd;   // the oldest unused blob of this stream

constexpr bool isLongForm(uint32_t firstWord) { return firstWord >> 16 == kLongForm; }
constexpr size_t headerBytesOf(uint32_t firstWord) { return isLongForm(firstWord) ? 8 : 4; }

struct Header {
    uint16_t opcode = 0;
    uint8_t headerBytes = 0; // 4, or 8 in long form; 0: malformed
    size_t sizeBytes = 0;    // of the record, header included; at most the bytes that are left
    explicit operator bool() const { return headerBytes != 0; }
};

// Reads the header of the record at `at`; `leftBytes`: number of readable bytes there. The result is false for a record
// that is longer, or shorter than its header.
inline Header readHeader(const std::byte* at, size_t leftBytes) {
    uint32_t words[2] = {};
    if (leftBytes < 4) return {};
    std::memcpy(words, at, 4);
    uint64_t length = words[0] >> 16;
    uint8_t headerBytes = 4;
    if (length == kLongForm) {
        if (leftBytes < 8) return {};
        std::memcpy(words + 1, at + 4, 4);
        length = words[1];
        headerBytes = 8;
    }
    const uint64_t sizeBytes = length * 4;
    if (sizeBytes < headerBytes || sizeBytes > leftBytes) return {};
    return {static_cast<uint16_t>(words[0]), headerBytes, static_cast<size_t>(sizeBytes)};
}

} // namespace mural::record
