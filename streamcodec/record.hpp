// The shape of a record: constants that encoder and decoder share. See docs/wire-format.md.
#pragma once

#include <cstdint>

namespace mural::record {

constexpr uint32_t kLongForm = 0xffff;     // in the length field: the length stands in the next word
constexpr uint32_t kInlineBytes = 16384;   // larger values travel ahead of their record, as blobs
constexpr uint32_t kBlobPieceBytes = 65536;

// First word of a value of variable size; everything below kTagBlob is a count of inline bytes.
constexpr uint32_t kTagNull = 0xffffffff;
constexpr uint32_t kTagOffset = 0xfffffffe; // u64 offset into a bound buffer follows
constexpr uint32_t kTagBlob = 0xfffffffd;   // the oldest blob of this stream that was not taken yet

} // namespace mural::record
