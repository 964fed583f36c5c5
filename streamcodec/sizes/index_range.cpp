#include "streamcodec/sizes/index_range.hpp"

namespace mural::sizes {
namespace {

// Client indices have any alignment, and their memory any type.
template <class Value> struct __attribute__((packed, may_alias)) Stored { Value value; };

// Both loops are branch-free for vectorisation.
template <class Value> IndexRange scanAll(const Stored<Value>* indices, size_t count) {
    Value lowest = static_cast<Value>(-1);
    Value highest = 0;
    for (size_t i = 0; i < count; ++i) {
        const Value index = indices[i].value;
        lowest = index < lowest ? index : lowest;
        highest = index > highest ? index : highest;
    }
    return {lowest, highest, true};
}

template <class Value> IndexRange scanWithRestart(const Stored<Value>* indices, size_t count, Value restartIndex) {
    Value lowest = static_cast<Value>(-1);
    Value highest = 0;
    for (size_t i = 0; i < count; ++i) {
        const Value index = indices[i].value;
        const Value hit = static_cast<Value>(index == restartIndex ? -1 : 0); // all bits, or none
        const Value forLowest = static_cast<Value>(index | hit);
        const Value forHighest = static_cast<Value>(index & ~hit);
        lowest = forLowest < lowest ? forLowest : lowest;
        highest = forHighest > highest ? forHighest : highest;
    }
    return {lowest, highest, true};
}

template <class Value> IndexRange scan(const void* indices, size_t count, bool restart, uint32_t restartIndex) {
    const auto* stored = static_cast<const Stored<Value>*>(indices);
    if (!restart || restartIndex > static_cast<Value>(-1)) return scanAll(stored, count);
    const IndexRange range = scanWithRestart(stored, count, static_cast<Value>(restartIndex));
    return range.min <= range.max ? range : IndexRange{};
}

} // namespace

IndexRange scanIndices(const void* indices, GLenum type, size_t count, bool restart, uint32_t restartIndex) {
    if (count == 0) return {};
    switch (type) {
    case GL_UNSIGNED_BYTE: return scan<uint8_t>(indices, count, restart, restartIndex);
    case GL_UNSIGNED_SHORT: return scan<uint16_t>(indices, count, restart, restartIndex);
    case GL_UNSIGNED_INT: return scan<uint32_t>(indices, count, restart, restartIndex);
    default: return {};
    }
}

uint32_t fixedRestartIndex(GLenum type) {
    switch (type) {
    case GL_UNSIGNED_BYTE: return 0xff;
    case GL_UNSIGNED_SHORT: return 0xffff;
    case GL_UNSIGNED_INT: return 0xffffffff;
    default: return 0;
    }
}

} // namespace mural::sizes
