#include "interposer/wrappers/client_draw.hpp"

#include "interposer/context/context.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/encode/real_gl.hpp"
#include "streamcodec/sizes/index_range.hpp"
#include "streamcodec/sizes/vertex_types.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

using namespace client_arrays;

namespace {

struct Source {
    uint32_t slot;
    const std::byte* begin; // first element that the draw reads
    uint32_t elementBytes;
    uint32_t stride;
    int32_t first; // negative: before the array, as drivers read it
    uint32_t count;
};

// The part of one array that the draw reads; count 0: none. Display lists store vertices and ignore divisors.
Source sourceOf(const VertexArray& va, uint32_t slot, const VertexRange& r, bool compiled) {
    const ArrayPointer& a = va.slots[slot];
    Source s{slot, nullptr, sizes::attributeBytes(a.size, a.type), 0, 0, 0};
    s.stride = a.stride > 0 ? static_cast<uint32_t>(a.stride) : s.elementBytes;
    if (a.divisor > 0 && !compiled) {
        s.first = static_cast<int32_t>(r.baseInstance);
        s.count = r.instances > 0 ? (r.instances - 1) / a.divisor + 1 : 0;
    } else if (r.last >= r.first && r.first >= INT32_MIN && r.first <= INT32_MAX) {
        s.first = static_cast<int32_t>(r.first);
        s.count = static_cast<uint32_t>(r.last - r.first + 1);
    }
    s.begin = static_cast<const std::byte*>(a.pointer) + a.relative + ptrdiff_t{s.first} * s.stride;
    return s;
}

// Interleaved arrays lie within one stride of each other and are copied once.
bool sharesSpan(const Source& s, const Source& with, const std::byte* spanBegin) {
    return s.stride == with.stride && s.count == with.count && s.first == with.first && s.begin >= spanBegin &&
           s.begin + s.elementBytes <= spanBegin + s.stride;
}

int collect(const VertexArray& va, const VertexRange& range, bool compiled, Source* out) {
    int n = 0;
    for (uint32_t slot = 0; slot < kSlots; ++slot) {
        if (!va.isClient(slot)) continue;
        const Source s = sourceOf(va, slot, range, compiled);
        if (s.count == 0 || s.elementBytes == 0) continue;
        int at = n++;
        for (; at > 0 && out[at - 1].begin > s.begin; --at) out[at] = out[at - 1]; // sorted by address
        out[at] = s;
    }
    return n;
}

} // namespace

void sendClientArrays(ThreadState& t, Context& c, const VertexRange& range) {
    const VertexArray& va = c.arrays.current();
    Source sources[kSlots];
    const int n = collect(va, range, c.compilingList, sources);
    if (n == 0) return;
    ArrayRecord records[kSlots];
    DataArg spans[kSlots];
    const Source* spanHead = nullptr;
    uint32_t spanCount = 0;
    for (int i = 0; i < n; ++i) {
        const Source& s = sources[i];
        const auto* begin = spanHead ? static_cast<const std::byte*>(spans[spanCount - 1].pointer) : nullptr;
        if (!spanHead || !sharesSpan(s, *spanHead, begin)) {
            spanHead = &s;
            begin = s.begin;
            spans[spanCount++] = DataArg::of(begin, 0);
        }
        const auto offset = static_cast<uint32_t>(s.begin - begin);
        const uint64_t end = offset + static_cast<uint64_t>(s.count - 1) * s.stride + s.elementBytes;
        DataArg& span = spans[spanCount - 1];
        if (end > span.sizeBytes) span.sizeBytes = end;
        const ArrayPointer& a = va.slots[s.slot];
        records[i] = {s.slot, a.size, a.type, a.flags, s.stride, spanCount - 1, offset, s.first, s.count};
    }
    records::clientArrays(t, records, static_cast<uint32_t>(n), spans, spanCount);
}

GLint elementBufferBinding() {
    GLint buffer = 0;
    gReal.glGetIntegerv(GL_ELEMENT_ARRAY_BUFFER_BINDING, &buffer);
    return buffer;
}

namespace {
// Copies a part of the bound element buffer. ES lacks glGetBufferSubData and maps the buffer instead.
const void* elementBufferContent(ThreadState& t, const Context& c, GLintptr offset, size_t bytes) {
    void* copy = secondScratch(t, bytes);
    if (!copy) return nullptr;
    if (c.api == wire::Api::Desktop) {
        gReal.glGetBufferSubData(GL_ELEMENT_ARRAY_BUFFER, offset, static_cast<GLsizeiptr>(bytes), copy);
        return copy;
    }
    if (!gReal.glMapBufferRange || !gReal.glUnmapBuffer) return nullptr;
    const void* mapped =
        gReal.glMapBufferRange(GL_ELEMENT_ARRAY_BUFFER, offset, static_cast<GLsizeiptr>(bytes), GL_MAP_READ_BIT);
    if (!mapped) return nullptr;
    std::memcpy(copy, mapped, bytes);
    gReal.glUnmapBuffer(GL_ELEMENT_ARRAY_BUFFER);
    return copy;
}
} // namespace

int64_t restartIndexOf(const Context& c) {
    if (c.api != wire::Api::Desktop || c.version < 31 || !gReal.glIsEnabled(GL_PRIMITIVE_RESTART)) return kNoRestart;
    GLint index = 0;
    gReal.glGetIntegerv(GL_PRIMITIVE_RESTART_INDEX, &index);
    return static_cast<uint32_t>(index);
}

VertexRange indexedRange(ThreadState& t, const Context& c, GLsizei count, GLenum type, const void* indices,
                         GLint baseVertex) {
    const uint32_t bytes = sizes::typeBytes(type);
    if (count <= 0 || bytes == 0 || bytes > 4) return {};
    const auto n = static_cast<size_t>(count);
    const void* data = indices;
    if (elementBufferBinding() != 0) {
        data = elementBufferContent(t, c, reinterpret_cast<GLintptr>(indices), n * bytes);
        if (!data) return {};
    }
    const int64_t chosen = restartIndexOf(c);
    bool restart = chosen >= 0;
    auto restartIndex = static_cast<uint32_t>(chosen);
    const bool fixedKnown = c.api == wire::Api::Desktop ? c.version >= 43 : c.version >= 30;
    if (fixedKnown && gReal.glIsEnabled(GL_PRIMITIVE_RESTART_FIXED_INDEX)) {
        restart = true;
        restartIndex = sizes::fixedRestartIndex(type);
    }
    if (!data) return {};
    const sizes::IndexRange range = sizes::scanIndices(data, type, n, restart, restartIndex);
    if (!range.any) return {};
    return {static_cast<int64_t>(range.min) + baseVertex, static_cast<int64_t>(range.max) + baseVertex, 1, 0};
}

} // namespace mural
