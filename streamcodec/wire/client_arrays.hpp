// Vertex arrays in client memory, sent before a draw (kOpClientArrays):
//   u32 arrayCount, u32 spanCount, ArrayRecord[arrayCount], spanCount values (bytes)
// Interleaved arrays share one span.
#pragma once

#include <cstdint>

namespace mural::client_arrays {

enum Slot : uint32_t {
    kVertex = 0,
    kNormal,
    kColor,
    kSecondaryColor,
    kFogCoord,
    kIndex,
    kEdgeFlag,
    kPointSize,
    kTexCoord0 = 8,
    kGeneric0 = 40,
};
constexpr uint32_t kTexCoords = 32;
constexpr uint32_t kGenerics = 32;
constexpr uint32_t kSlots = kGeneric0 + kGenerics;

// kSlots: no such attribute.
constexpr uint32_t genericSlot(uint32_t index) { return index < kGenerics ? kGeneric0 + index : kSlots; }
constexpr uint32_t coordinateSlot(uint32_t unit) { return unit < kTexCoords ? kTexCoord0 + unit : kSlots; }

enum Flags : uint32_t { kNormalized = 1, kInteger = 2, kLong = 4 };

struct ArrayRecord {
    uint32_t slot;
    int32_t size; // components, or GL_BGRA
    uint32_t type;
    uint32_t flags;
    uint32_t strideBytes; // never 0
    uint32_t span;
    uint32_t offsetBytes; // of this array's first element in the span
    int32_t firstElement; // index of that element; negative if a draw starts before the array
    uint32_t elementCount;
};

} // namespace mural::client_arrays
