// Record constants shared by encoder and decoder. See docs/reference/wire-format.md.
#pragma once

#include <cstdint>

namespace mural::record {

constexpr uint32_t kLongForm = 0xffff; // in the length field: the next word holds the length
constexpr uint32_t kInlineBytes = 16384; // larger values precede their record as blobs
constexpr uint32_t kBlobPieceBytes = 65536;

// The first word of a variable-size value. Values below kTagBlob count inline bytes.
constexpr uint32_t kTagNull = 0xffffffff;
constexpr uint32_t kTagOffset = 0xfffffffe; // a u64 offset into a bound buffer follows
constexpr uint32_t kTagBlob = 0xfffffffd; // the oldest unused blob of this stream

} // namespace mural::record
