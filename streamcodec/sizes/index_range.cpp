#include "streamcodec/sizes/index_range.hpp"

namespace mural::sizes {
namespace {

// Client indices have any alignment, and the memory has any type.
using Byte = uint8_t;
using Short __attribute__((aligned(1), may_alias)) = uint16_t;
using Int __attribute__((aligned(1), may_alias)) = uint32_t;

// Both loops have no branch: the compiler makes vector code of them. Value is the plain type.
template <class Value, class Stored> IndexRange scanAll(const Stored* indices, size_t count) {
    Value lowest = static_cast<Value>(-1);
    Value highest = 0;
    for (size_t i = 0; i < count; ++i) {
        const Value index = indices[i];
        lowest = index < lowest ? index : lowest;
        highest = index > highest ? index : highest;
    }
    return {lowest, highest, true};
}

template <class Value, class Stored>
IndexRange scanWithRestart(const Stored* indices, size_t count, Value restartIndex) {
    Value lowest = static_cast<Value>(-1);
    Value highest = 0;
    for (size_t i = 0; i < count; ++i) {
        const Value index = indices[i];
        const Value forLowest = index == restartIndex ? static_cast<Value>(-1) : index;
        const Value forHighest = index == restartIndex ? Value{0} : index;
        lowest = forLowest < lowest ? forLowest : lowest;
        highest = forHighest > highest ? forHighest : highest;
    }
    return {lowest, highest, true};
}

template <class Value, class Stored>
IndexRange scan(const void* indices, size_t count, bool restart, uint32_t restartIndex) {
    const auto* stored = static_cast<const Stored*>(indices);
    if (!restart || restartIndex > static_cast<Value>(-1))
        return scanAll<Value>(stored, count);
    const IndexRange range =
        scanWithRestart<Value>(stored, count, static_cast<Value>(restartIndex));
    return range.min <= range.max ? range : IndexRange{};
}

} // namespace

IndexRange
scanIndices(const void* indices, GLenum type, size_t count, bool restart, uint32_t restartIndex) {
    if (count == 0)
        return {};
    switch (type) {
    case GL_UNSIGNED_BYTE:
        return scan<uint8_t, Byte>(indices, count, restart, restartIndex);
    case GL_UNSIGNED_SHORT:
        return scan<uint16_t, Short>(indices, count, restart, restartIndex);
    case GL_UNSIGNED_INT:
        return scan<uint32_t, Int>(indices, count, restart, restartIndex);
    default:
        return {};
    }
}

uint32_t fixedRestartIndex(GLenum type) {
    switch (type) {
    case GL_UNSIGNED_BYTE:
        return 0xff;
    case GL_UNSIGNED_SHORT:
        return 0xffff;
    case GL_UNSIGNED_INT:
        return 0xffffffff;
    default:
        return 0;
    }
}

} // namespace mural::sizes
