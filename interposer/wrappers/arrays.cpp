// Wrappers of vertex array state. The state is stored in the mirror (vertex_arrays.hpp), and sent only if it refers to
// buffers.
#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/encode/real_gl.hpp"
#include "streamcodec/sizes/vertex_types.hpp"

using namespace mural;
using namespace mural::client_arrays;

namespace {

// Common arguments that every driver accepts.
bool isUsual(const Context& c, GLint size, GLenum type, GLsizei stride) {
    const bool floats = type == GL_FLOAT && size >= 3 && size <= 4, bytes = type == GL_UNSIGNED_BYTE && size == 4;
    constexpr GLsizei kStride = 2048; // minimum of GL_MAX_VERTEX_ATTRIB_STRIDE
    return (floats || bytes) && stride >= 0 && stride <= kStride && !c.core &&
           (c.arrays.arrayBuffer() || c.arrays.currentName() == 0);
}

// Calls the program's own context. If it accepts the call, updates the mirror, and calls `send` if the pointer is an
// offset that the nodes need now.
template <class Local, class Send>
void point(uint32_t slot, GLint size, GLenum type, GLsizei stride, const void* pointer, uint32_t flags, Local&& local,
           Send&& send) {
    ThreadState& t = *tThread;
    if (!t.context) return local();
    const bool fewTypes = slot == kVertex || slot == kNormal || (slot >= kTexCoord0 && slot < kTexCoord0 + kTexCoords);
    const bool refusable = slot == kSecondaryColor || (fewTypes && type == GL_UNSIGNED_BYTE);
    if (!refusable && isUsual(*t.context, size, type, stride))
        local();
    else if (!raisesNothing(*t.context, local))
        return;
    if (!t.context->arrays.setPointer(slot, size, type, stride, flags, pointer)) send(t);
}

// For the named array. Returns false if the program's own context rejects the call.
template <class Local>
bool formatOf(GLuint array, GLuint index, GLint size, GLenum type, uint32_t flags, GLuint relative, Local&& local) {
    ThreadState& t = *tThread;
    if (!t.context) return local(), false;
    if (!raisesNothing(*t.context, local)) return false;
    const GLuint offset = t.context->isMesa ? 0 : relative; // Mesa ignores the offset for client memory
    if (index < kGenerics) t.context->arrays.setFormat(array, kGeneric0 + index, size, type, flags, offset);
    return true;
}
template <class Local>
bool format(GLuint index, GLint size, GLenum type, uint32_t flags, GLuint relative, Local&& local) {
    return formatOf(tThread->context ? tThread->context->arrays.currentName() : 0, index, size, type, flags, relative,
                    local);
}

template <class Encode, class Real>
void formatNamed(Encode encode, Real real, GLuint array, GLuint index, GLint size, GLenum type, uint32_t flags,
                 GLuint relative) {
    if (formatOf(array, index, size, type, flags, relative, [=] { real(array, index, size, type, relative); }))
        encode(*tThread, array, index, size, type, relative);
}

void enableSlot(ThreadState& t, uint32_t slot, bool on) {
    if (t.context && slot < kSlots) t.context->arrays.current().enable(slot, on);
}

// The command names the array, and the driver has already executed it: a rejected name does not exist.
void enableNamed(ThreadState& t, GLuint array, uint32_t slot, bool on) {
    if (!t.context || slot >= kSlots) return;
    VertexArrayMirror& mirror = t.context->arrays;
    if (mirror.knows(array) || gReal.glIsVertexArray(array)) mirror.enableIn(array, slot, on);
}
template <class Encode, class Real>
void switchNamed(Encode encode, Real real, GLuint array, GLuint which, uint32_t slot, bool on) {
    ThreadState& t = *tThread;
    if (!t.context) return real(array, which);
    if (!raisesNothing(*t.context, [&] { real(array, which); })) return; // EXT_direct_state_access has no array 0
    encode(t, array, which);
    enableNamed(t, array, slot, on);
}
// EXT_direct_state_access: GL_TEXTUREi selects the texture coordinate array of that unit.
uint32_t namedSlot(ThreadState& t, GLenum array) {
    if (array - GL_TEXTURE0 < kTexCoords) return kTexCoord0 + (array - GL_TEXTURE0);
    return t.context ? t.context->arrays.slotOf(array) : kSlots;
}

constexpr GLuint kUnitsOfAll = 2; // minimum of GL_MAX_TEXTURE_COORDS

// The command names the texture unit. Selects it for the call, then restores the program's.
template <class Call> void withUnit(GLenum unit, Call&& call) {
    GLint before = GL_TEXTURE0;
    gReal.glGetIntegerv(GL_CLIENT_ACTIVE_TEXTURE, &before);
    mural_glClientActiveTexture(unit);
    GLint now = GL_TEXTURE0;
    gReal.glGetIntegerv(GL_CLIENT_ACTIVE_TEXTURE, &now);
    if (static_cast<GLenum>(now) != unit) return; // no such unit
    call();
    mural_glClientActiveTexture(static_cast<GLenum>(before));
}

// Mesa accepts client arrays in glEnable and glDisable, with the effect of glEnableClientState.
bool isClientArray(GLenum cap) {
    return (cap >= GL_VERTEX_ARRAY && cap <= GL_EDGE_FLAG_ARRAY) || cap == GL_FOG_COORD_ARRAY ||
           cap == GL_SECONDARY_COLOR_ARRAY;
}
void switchClientArray(ThreadState& t, GLenum array, bool on) {
    const auto local = [=] { on ? gReal.glEnable(array) : gReal.glDisable(array); };
    if (!t.context || t.context->compilingList) return local(); // in a list, only the program's own context executes it
    if (!raisesNothing(*t.context, local)) return;
    enableSlot(t, t.context->arrays.slotOf(array), on);
    on ? encode_glEnableClientState(t, array) : encode_glDisableClientState(t, array);
}

} // namespace

extern "C" {

void mural_glEnable(GLenum cap) {
    ThreadState& t = *tThread;
    if (isClientArray(cap)) [[unlikely]]
        return switchClientArray(t, cap, true);
    encode_glEnable(t, cap);
    gReal.glEnable(cap);
}
void mural_glDisable(GLenum cap) {
    ThreadState& t = *tThread;
    if (isClientArray(cap)) [[unlikely]]
        return switchClientArray(t, cap, false);
    encode_glDisable(t, cap);
    gReal.glDisable(cap);
}

void mural_glVertexPointer(GLint size, GLenum type, GLsizei stride, const void* pointer) {
    point(
        kVertex, size, type, stride, pointer, 0, [=] { gReal.glVertexPointer(size, type, stride, pointer); },
        [=](ThreadState& t) { encode_glVertexPointer(t, size, type, stride, pointer); });
}
void mural_glNormalPointer(GLenum type, GLsizei stride, const void* pointer) {
    point(
        kNormal, 3, type, stride, pointer, 0, [=] { gReal.glNormalPointer(type, stride, pointer); },
        [=](ThreadState& t) { encode_glNormalPointer(t, type, stride, pointer); });
}
void mural_glColorPointer(GLint size, GLenum type, GLsizei stride, const void* pointer) {
    point(
        kColor, size, type, stride, pointer, 0, [=] { gReal.glColorPointer(size, type, stride, pointer); },
        [=](ThreadState& t) { encode_glColorPointer(t, size, type, stride, pointer); });
}
void mural_glSecondaryColorPointer(GLint size, GLenum type, GLsizei stride, const void* pointer) {
    point(
        kSecondaryColor, size, type, stride, pointer, 0,
        [=] { gReal.glSecondaryColorPointer(size, type, stride, pointer); },
        [=](ThreadState& t) { encode_glSecondaryColorPointer(t, size, type, stride, pointer); });
}
void mural_glTexCoordPointer(GLint size, GLenum type, GLsizei stride, const void* pointer) {
    const ThreadState& thread = *tThread;
    const uint32_t slot = thread.context ? thread.context->arrays.texCoordSlot() : kTexCoord0;
    point(
        slot, size, type, stride, pointer, 0, [=] { gReal.glTexCoordPointer(size, type, stride, pointer); },
        [=](ThreadState& t) { encode_glTexCoordPointer(t, size, type, stride, pointer); });
}
void mural_glFogCoordPointer(GLenum type, GLsizei stride, const void* pointer) {
    point(
        kFogCoord, 1, type, stride, pointer, 0, [=] { gReal.glFogCoordPointer(type, stride, pointer); },
        [=](ThreadState& t) { encode_glFogCoordPointer(t, type, stride, pointer); });
}
void mural_glIndexPointer(GLenum type, GLsizei stride, const void* pointer) {
    point(
        kIndex, 1, type, stride, pointer, 0, [=] { gReal.glIndexPointer(type, stride, pointer); },
        [=](ThreadState& t) { encode_glIndexPointer(t, type, stride, pointer); });
}
void mural_glEdgeFlagPointer(GLsizei stride, const void* pointer) {
    point(
        kEdgeFlag, 1, GL_UNSIGNED_BYTE, stride, pointer, 0, [=] { gReal.glEdgeFlagPointer(stride, pointer); },
        [=](ThreadState& t) { encode_glEdgeFlagPointer(t, stride, pointer); });
}
void mural_glPointSizePointerOES(GLenum type, GLsizei stride, const void* pointer) {
    point(
        kPointSize, 1, type, stride, pointer, 0, [=] { gReal.glPointSizePointerOES(type, stride, pointer); },
        [=](ThreadState& t) { encode_glPointSizePointerOES(t, type, stride, pointer); });
}
void mural_glVertexAttribPointer(GLuint index, GLint size, GLenum type, GLboolean normalized, GLsizei stride,
                                 const void* pointer) {
    if (index >= kGenerics) return gReal.glVertexAttribPointer(index, size, type, normalized, stride, pointer);
    point(
        kGeneric0 + index, size, type, stride, pointer, normalized ? uint32_t{kNormalized} : 0,
        [=] { gReal.glVertexAttribPointer(index, size, type, normalized, stride, pointer); },
        [=](ThreadState& t) { encode_glVertexAttribPointer(t, index, size, type, normalized, stride, pointer); });
}
void mural_glVertexAttribIPointer(GLuint index, GLint size, GLenum type, GLsizei stride, const void* pointer) {
    if (index >= kGenerics) return gReal.glVertexAttribIPointer(index, size, type, stride, pointer);
    point(
        kGeneric0 + index, size, type, stride, pointer, kInteger,
        [=] { gReal.glVertexAttribIPointer(index, size, type, stride, pointer); },
        [=](ThreadState& t) { encode_glVertexAttribIPointer(t, index, size, type, stride, pointer); });
}
void mural_glVertexAttribLPointer(GLuint index, GLint size, GLenum type, GLsizei stride, const void* pointer) {
    if (index >= kGenerics) return gReal.glVertexAttribLPointer(index, size, type, stride, pointer);
    point(
        kGeneric0 + index, size, type, stride, pointer, kLong,
        [=] { gReal.glVertexAttribLPointer(index, size, type, stride, pointer); },
        [=](ThreadState& t) { encode_glVertexAttribLPointer(t, index, size, type, stride, pointer); });
}

// EXT_vertex_array: the same with an unused count.
void mural_glVertexPointerEXT(GLint size, GLenum type, GLsizei stride, GLsizei, const void* pointer) {
    mural_glVertexPointer(size, type, stride, pointer);
}
void mural_glNormalPointerEXT(GLenum type, GLsizei stride, GLsizei, const void* pointer) {
    mural_glNormalPointer(type, stride, pointer);
}
void mural_glColorPointerEXT(GLint size, GLenum type, GLsizei stride, GLsizei, const void* pointer) {
    mural_glColorPointer(size, type, stride, pointer);
}
void mural_glTexCoordPointerEXT(GLint size, GLenum type, GLsizei stride, GLsizei, const void* pointer) {
    mural_glTexCoordPointer(size, type, stride, pointer);
}
void mural_glIndexPointerEXT(GLenum type, GLsizei stride, GLsizei, const void* pointer) {
    mural_glIndexPointer(type, stride, pointer);
}
void mural_glEdgeFlagPointerEXT(GLsizei stride, GLsizei, const GLboolean* pointer) {
    mural_glEdgeFlagPointer(stride, pointer);
}

// GL 4.6 compatibility, table 10.5 defines the command by its equivalents.
void mural_glInterleavedArrays(GLenum format, GLsizei stride, const void* pointer) {
    struct Row {
        GLenum format;
        GLint texCoord, color;
        GLenum colorType;
        bool normal;
        GLint vertex;
        GLsizei colorAt, normalAt, vertexAt, total;
    };
    constexpr GLsizei f = 4, c = 4;
    static constexpr Row kRows[] = {
        {GL_V2F, 0, 0, 0, false, 2, 0, 0, 0, 2 * f},
        {GL_V3F, 0, 0, 0, false, 3, 0, 0, 0, 3 * f},
        {GL_C4UB_V2F, 0, 4, GL_UNSIGNED_BYTE, false, 2, 0, 0, c, c + 2 * f},
        {GL_C4UB_V3F, 0, 4, GL_UNSIGNED_BYTE, false, 3, 0, 0, c, c + 3 * f},
        {GL_C3F_V3F, 0, 3, GL_FLOAT, false, 3, 0, 0, 3 * f, 6 * f},
        {GL_N3F_V3F, 0, 0, 0, true, 3, 0, 0, 3 * f, 6 * f},
        {GL_C4F_N3F_V3F, 0, 4, GL_FLOAT, true, 3, 0, 4 * f, 7 * f, 10 * f},
        {GL_T2F_V3F, 2, 0, 0, false, 3, 0, 0, 2 * f, 5 * f},
        {GL_T4F_V4F, 4, 0, 0, false, 4, 0, 0, 4 * f, 8 * f},
        {GL_T2F_C4UB_V3F, 2, 4, GL_UNSIGNED_BYTE, false, 3, 2 * f, 0, c + 2 * f, c + 5 * f},
        {GL_T2F_C3F_V3F, 2, 3, GL_FLOAT, false, 3, 2 * f, 0, 5 * f, 8 * f},
        {GL_T2F_N3F_V3F, 2, 0, 0, true, 3, 0, 2 * f, 5 * f, 8 * f},
        {GL_T2F_C4F_N3F_V3F, 2, 4, GL_FLOAT, true, 3, 2 * f, 6 * f, 9 * f, 12 * f},
        {GL_T4F_C4F_N3F_V4F, 4, 4, GL_FLOAT, true, 4, 4 * f, 8 * f, 11 * f, 15 * f},
    };
    const Row* row = nullptr;
    for (const Row& r : kRows) {
        if (r.format == format) row = &r;
    }
    if (!row || stride < 0) {
        gReal.glInterleavedArrays(format, stride, pointer); // raises the error
        return;
    }
    const GLsizei step = stride ? stride : row->total;
    const auto* p = static_cast<const std::byte*>(pointer);
    const auto part = [&](bool on, GLenum array) {
        on ? mural_glEnableClientState(array) : mural_glDisableClientState(array);
    };
    part(false, GL_EDGE_FLAG_ARRAY);
    part(false, GL_INDEX_ARRAY);
    part(false, GL_SECONDARY_COLOR_ARRAY);
    part(false, GL_FOG_COORD_ARRAY);
    part(row->texCoord, GL_TEXTURE_COORD_ARRAY);
    if (row->texCoord) mural_glTexCoordPointer(row->texCoord, GL_FLOAT, step, p);
    part(row->color, GL_COLOR_ARRAY);
    if (row->color) mural_glColorPointer(row->color, row->colorType, step, p + row->colorAt);
    part(row->normal, GL_NORMAL_ARRAY);
    if (row->normal) mural_glNormalPointer(GL_FLOAT, step, p + row->normalAt);
    part(true, GL_VERTEX_ARRAY);
    mural_glVertexPointer(row->vertex, GL_FLOAT, step, p + row->vertexAt);
}

void mural_glEnableClientState(GLenum array) {
    ThreadState& t = *tThread;
    if (t.context) enableSlot(t, t.context->arrays.slotOf(array), true);
    encode_glEnableClientState(t, array);
    gReal.glEnableClientState(array);
}
void mural_glDisableClientState(GLenum array) {
    ThreadState& t = *tThread;
    if (t.context) enableSlot(t, t.context->arrays.slotOf(array), false);
    encode_glDisableClientState(t, array);
    gReal.glDisableClientState(array);
}
void mural_glMultiTexCoordPointerEXT(GLenum texunit, GLint size, GLenum type, GLsizei stride, const void* pointer) {
    withUnit(texunit, [&] { mural_glTexCoordPointer(size, type, stride, pointer); });
}
// Other arrays have a single instance: an error.
void mural_glEnableClientStateiEXT(GLenum array, GLuint index) {
    if (array != GL_TEXTURE_COORD_ARRAY) return gReal.glEnableClientStateiEXT(array, index);
    withUnit(GL_TEXTURE0 + index, [&] { mural_glEnableClientState(array); });
}
void mural_glDisableClientStateiEXT(GLenum array, GLuint index) {
    if (array != GL_TEXTURE_COORD_ARRAY) return gReal.glDisableClientStateiEXT(array, index);
    withUnit(GL_TEXTURE0 + index, [&] { mural_glDisableClientState(array); });
}
void mural_glEnableClientStateIndexedEXT(GLenum array, GLuint index) { mural_glEnableClientStateiEXT(array, index); }
void mural_glDisableClientStateIndexedEXT(GLenum array, GLuint index) { mural_glDisableClientStateiEXT(array, index); }
void mural_glEnableVertexAttribArray(GLuint index) {
    ThreadState& t = *tThread;
    if (index < kGenerics) enableSlot(t, kGeneric0 + index, true);
    encode_glEnableVertexAttribArray(t, index);
    gReal.glEnableVertexAttribArray(index);
}
void mural_glDisableVertexAttribArray(GLuint index) {
    ThreadState& t = *tThread;
    if (index < kGenerics) enableSlot(t, kGeneric0 + index, false);
    encode_glDisableVertexAttribArray(t, index);
    gReal.glDisableVertexAttribArray(index);
}
void mural_glEnableVertexArrayAttrib(GLuint vaobj, GLuint index) {
    switchNamed(encode_glEnableVertexArrayAttrib, gReal.glEnableVertexArrayAttrib, vaobj, index, genericSlot(index),
                true);
}
void mural_glDisableVertexArrayAttrib(GLuint vaobj, GLuint index) {
    switchNamed(encode_glDisableVertexArrayAttrib, gReal.glDisableVertexArrayAttrib, vaobj, index, genericSlot(index),
                false);
}
void mural_glEnableVertexArrayAttribEXT(GLuint vaobj, GLuint index) {
    switchNamed(encode_glEnableVertexArrayAttribEXT, gReal.glEnableVertexArrayAttribEXT, vaobj, index,
                genericSlot(index), true);
}
void mural_glDisableVertexArrayAttribEXT(GLuint vaobj, GLuint index) {
    switchNamed(encode_glDisableVertexArrayAttribEXT, gReal.glDisableVertexArrayAttribEXT, vaobj, index,
                genericSlot(index), false);
}
void mural_glEnableVertexArrayEXT(GLuint vaobj, GLenum array) {
    switchNamed(encode_glEnableVertexArrayEXT, gReal.glEnableVertexArrayEXT, vaobj, array, namedSlot(*tThread, array),
                true);
}
void mural_glDisableVertexArrayEXT(GLuint vaobj, GLenum array) {
    switchNamed(encode_glDisableVertexArrayEXT, gReal.glDisableVertexArrayEXT, vaobj, array, namedSlot(*tThread, array),
                false);
}
void mural_glClientActiveTexture(GLenum texture) {
    ThreadState& t = *tThread;
    if (!t.context || (texture - GL_TEXTURE0 < kUnitsOfAll && !t.context->core))
        gReal.glClientActiveTexture(texture);
    else if (!raisesNothing(*t.context, [=] { gReal.glClientActiveTexture(texture); }))
        return;
    if (t.context) t.context->arrays.activeTexture(texture);
    encode_glClientActiveTexture(t, texture);
}
void mural_glPushClientAttrib(GLbitfield mask) {
    ThreadState& t = *tThread;
    if (t.context) t.context->arrays.push(mask);
    encode_glPushClientAttrib(t, mask);
    gReal.glPushClientAttrib(mask);
}
void mural_glPushClientAttribDefaultEXT(GLbitfield mask) {
    ThreadState& t = *tThread;
    if (t.context) {
        t.context->arrays.push(mask);
        t.context->arrays.reset(mask);
    }
    encode_glPushClientAttribDefaultEXT(t, mask);
    gReal.glPushClientAttribDefaultEXT(mask);
}
void mural_glClientAttribDefaultEXT(GLbitfield mask) {
    ThreadState& t = *tThread;
    if (t.context) t.context->arrays.reset(mask);
    encode_glClientAttribDefaultEXT(t, mask);
    gReal.glClientAttribDefaultEXT(mask);
}
void mural_glPopClientAttrib() {
    ThreadState& t = *tThread;
    if (t.context) t.context->arrays.pop();
    encode_glPopClientAttrib(t);
    gReal.glPopClientAttrib();
}
void mural_glBindVertexArray(GLuint array) {
    ThreadState& t = *tThread;
    if (!t.context || t.context->arrays.knows(array))
        gReal.glBindVertexArray(array);
    else if (!raisesNothing(*t.context, [=] { gReal.glBindVertexArray(array); }))
        return;
    if (t.context) t.context->arrays.bind(array);
    encode_glBindVertexArray(t, array);
}
void mural_glDeleteVertexArrays(GLsizei n, const GLuint* arrays) {
    ThreadState& t = *tThread;
    if (t.context && n > 0 && arrays) t.context->arrays.remove(n, arrays);
    encode_glDeleteVertexArrays(t, n, DataArg::of(arrays, n > 0 ? uint64_t(n) * 4 : 0));
    gReal.glDeleteVertexArrays(n, arrays);
}

// Formats also apply to client memory.
void mural_glVertexAttribFormat(GLuint index, GLint size, GLenum type, GLboolean normalized, GLuint relative) {
    if (format(index, size, type, normalized ? uint32_t{kNormalized} : 0, relative,
               [=] { gReal.glVertexAttribFormat(index, size, type, normalized, relative); }))
        encode_glVertexAttribFormat(*tThread, index, size, type, normalized, relative);
}
void mural_glVertexAttribIFormat(GLuint index, GLint size, GLenum type, GLuint relative) {
    if (format(index, size, type, kInteger, relative,
               [=] { gReal.glVertexAttribIFormat(index, size, type, relative); }))
        encode_glVertexAttribIFormat(*tThread, index, size, type, relative);
}
void mural_glVertexAttribLFormat(GLuint index, GLint size, GLenum type, GLuint relative) {
    if (format(index, size, type, kLong, relative, [=] { gReal.glVertexAttribLFormat(index, size, type, relative); }))
        encode_glVertexAttribLFormat(*tThread, index, size, type, relative);
}
void mural_glVertexArrayAttribFormat(GLuint vaobj, GLuint index, GLint size, GLenum type, GLboolean normalized,
                                     GLuint relative) {
    if (formatOf(vaobj, index, size, type, normalized ? uint32_t{kNormalized} : 0, relative,
                 [=] { gReal.glVertexArrayAttribFormat(vaobj, index, size, type, normalized, relative); }))
        encode_glVertexArrayAttribFormat(*tThread, vaobj, index, size, type, normalized, relative);
}
void mural_glVertexArrayAttribIFormat(GLuint vaobj, GLuint index, GLint size, GLenum type, GLuint relative) {
    formatNamed(encode_glVertexArrayAttribIFormat, gReal.glVertexArrayAttribIFormat, vaobj, index, size, type, kInteger,
                relative);
}
void mural_glVertexArrayAttribLFormat(GLuint vaobj, GLuint index, GLint size, GLenum type, GLuint relative) {
    formatNamed(encode_glVertexArrayAttribLFormat, gReal.glVertexArrayAttribLFormat, vaobj, index, size, type, kLong,
                relative);
}
void mural_glVertexArrayVertexAttribFormatEXT(GLuint vaobj, GLuint index, GLint size, GLenum type, GLboolean normalized,
                                              GLuint relative) {
    if (formatOf(vaobj, index, size, type, normalized ? uint32_t{kNormalized} : 0, relative,
                 [=] { gReal.glVertexArrayVertexAttribFormatEXT(vaobj, index, size, type, normalized, relative); }))
        encode_glVertexArrayVertexAttribFormatEXT(*tThread, vaobj, index, size, type, normalized, relative);
}
void mural_glVertexArrayVertexAttribIFormatEXT(GLuint vaobj, GLuint index, GLint size, GLenum type, GLuint relative) {
    formatNamed(encode_glVertexArrayVertexAttribIFormatEXT, gReal.glVertexArrayVertexAttribIFormatEXT, vaobj, index,
                size, type, kInteger, relative);
}
void mural_glVertexArrayVertexAttribLFormatEXT(GLuint vaobj, GLuint index, GLint size, GLenum type, GLuint relative) {
    formatNamed(encode_glVertexArrayVertexAttribLFormatEXT, gReal.glVertexArrayVertexAttribLFormatEXT, vaobj, index,
                size, type, kLong, relative);
}
void mural_glBindBuffer(GLenum target, GLuint buffer) {
    ThreadState& t = *tThread;
    if (target != GL_PIXEL_PACK_BUFFER) bufferUsed(t, buffer);
    if (t.context && target == GL_QUERY_BUFFER) { // OpenGL ES has none
        if (!raisesNothing(*t.context, [=] { gReal.glBindBuffer(target, buffer); })) return;
        t.context->queryBuffer = buffer;
        return encode_glBindBuffer(t, target, buffer);
    }
    if (t.context && target == GL_ARRAY_BUFFER) t.context->arrays.bindArrayBuffer(buffer);
    // memory of this process: the nodes use an ordinary buffer
    if (t.context && target == GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD) {
        t.context->pinnedBuffer = buffer;
        return gReal.glBindBuffer(target, buffer);
    }
    encode_glBindBuffer(t, target, buffer);
    gReal.glBindBuffer(target, buffer);
}

} // extern "C"
