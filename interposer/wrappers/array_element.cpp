#include "interposer/wrappers/array_element.hpp"

#include "encoders.hpp"
#include "interposer/context/context.hpp"
#include "interposer/encode/real_gl.hpp"
#include "streamcodec/sizes/vertex_types.hpp"

namespace mural {

using namespace client_arrays;

namespace {

// A copy of one element of one array, because client memory may be unaligned.
struct Element {
    alignas(8) std::byte bytes[32] = {};
    GLint size = 0; // components
    GLenum type = 0;
    uint32_t flags = 0;

    template <class T> const T* as() const { return reinterpret_cast<const T*>(bytes); }
};

GLfloat fromHalf(GLushort half) {
    const uint32_t sign = uint32_t{half} >> 15, exponent = half >> 10 & 31, mantissa = half & 1023;
    GLfloat value = static_cast<GLfloat>(mantissa) / 16777216.0f; // subnormal
    if (exponent > 0) {
        const uint32_t bits = (exponent == 31 ? 255u : exponent + 112) << 23 | mantissa << 13;
        std::memcpy(&value, &bits, 4);
    }
    return sign ? -value : value;
}

// Normalises signed values as immediate-mode commands do (GL 4.1, equation 2.2).
template <class T> GLfloat number(const Element& e, int k, bool normalized) {
    const T value = e.as<T>()[k];
    if (!normalized) return static_cast<GLfloat>(value);
    constexpr double range = sizeof(T) == 1 ? 255.0 : sizeof(T) == 2 ? 65535.0 : 4294967295.0;
    return static_cast<GLfloat>(static_cast<T>(-1) < 0 ? (2.0 * static_cast<double>(value) + 1.0) / range
                                                       : static_cast<double>(value) / range);
}

GLfloat component(const Element& e, int k) {
    const bool normalized = e.flags & kNormalized;
    switch (e.type) {
    case GL_BYTE: return number<GLbyte>(e, k, normalized);
    case GL_UNSIGNED_BYTE: return number<GLubyte>(e, k, normalized);
    case GL_SHORT: return number<GLshort>(e, k, normalized);
    case GL_UNSIGNED_SHORT: return number<GLushort>(e, k, normalized);
    case GL_INT: return number<GLint>(e, k, normalized);
    case GL_UNSIGNED_INT: return number<GLuint>(e, k, normalized);
    case GL_DOUBLE: return number<GLdouble>(e, k, false);
    case GL_HALF_FLOAT: return fromHalf(e.as<GLushort>()[k]);
    case GL_FIXED: return static_cast<GLfloat>(e.as<GLint>()[k]) / 65536.0f;
    default: return e.as<GLfloat>()[k];
    }
}

// Types without commands of their own are sent as floats.
bool becomesFloat(GLenum type) { return type == GL_HALF_FLOAT || type == GL_FIXED; }

void toFloats(Element& e) {
    Element converted;
    converted.size = e.size;
    converted.type = GL_FLOAT;
    for (int k = 0; k < e.size; ++k) {
        const GLfloat value = component(e, k);
        std::memcpy(converted.bytes + 4 * k, &value, 4);
    }
    e = converted;
}

// Swizzles BGRA to RGBA.
void fromBgra(Element& e) {
    e.size = 4;
    if (!sizes::isPackedVertexType(e.type)) {
        std::swap(e.bytes[0], e.bytes[2]); // bytes are the only BGRA type
        return;
    }
    uint32_t word = 0;
    std::memcpy(&word, e.bytes, 4);
    word = (word & 0xc00ffc00) | (word & 0x3ff) << 20 | (word >> 20 & 0x3ff);
    std::memcpy(e.bytes, &word, 4);
}

GLuint packed(const Element& e) { return *e.as<GLuint>(); }

#define MURAL_SEND(suffix, T, command)                                                                                 \
    case suffix:                                                                                                       \
        return encode_##command(t, e.as<T>())
#define MURAL_SEND_SIFD(name)                                                                                          \
    switch (e.type) {                                                                                                  \
        MURAL_SEND(GL_SHORT, GLshort, name##sv);                                                                       \
        MURAL_SEND(GL_INT, GLint, name##iv);                                                                           \
        MURAL_SEND(GL_FLOAT, GLfloat, name##fv);                                                                       \
        MURAL_SEND(GL_DOUBLE, GLdouble, name##dv);                                                                     \
    default: return;                                                                                                   \
    }
#define MURAL_SEND_COLOR(name)                                                                                         \
    switch (e.type) {                                                                                                  \
        MURAL_SEND(GL_BYTE, GLbyte, name##bv);                                                                         \
        MURAL_SEND(GL_UNSIGNED_BYTE, GLubyte, name##ubv);                                                              \
        MURAL_SEND(GL_SHORT, GLshort, name##sv);                                                                       \
        MURAL_SEND(GL_UNSIGNED_SHORT, GLushort, name##usv);                                                            \
        MURAL_SEND(GL_INT, GLint, name##iv);                                                                           \
        MURAL_SEND(GL_UNSIGNED_INT, GLuint, name##uiv);                                                                \
        MURAL_SEND(GL_FLOAT, GLfloat, name##fv);                                                                       \
        MURAL_SEND(GL_DOUBLE, GLdouble, name##dv);                                                                     \
    default: return;                                                                                                   \
    }

void sendVertex(ThreadState& t, const Element& e) {
    if (sizes::isPackedVertexType(e.type)) {
        const GLuint value = packed(e);
        return e.size == 2   ? encode_glVertexP2ui(t, e.type, value)
               : e.size == 3 ? encode_glVertexP3ui(t, e.type, value)
                             : encode_glVertexP4ui(t, e.type, value);
    }
    if (e.size == 2) MURAL_SEND_SIFD(glVertex2)
    if (e.size == 3) MURAL_SEND_SIFD(glVertex3)
    MURAL_SEND_SIFD(glVertex4)
}

void sendColor(ThreadState& t, const Element& e) {
    if (sizes::isPackedVertexType(e.type))
        return e.size == 3 ? encode_glColorP3ui(t, e.type, packed(e)) : encode_glColorP4ui(t, e.type, packed(e));
    if (e.size == 3) MURAL_SEND_COLOR(glColor3)
    MURAL_SEND_COLOR(glColor4)
}

void sendSecondaryColor(ThreadState& t, const Element& e) {
    if (sizes::isPackedVertexType(e.type)) return encode_glSecondaryColorP3ui(t, e.type, packed(e));
    MURAL_SEND_COLOR(glSecondaryColor3)
}

void sendNormal(ThreadState& t, const Element& e) {
    if (sizes::isPackedVertexType(e.type)) return encode_glNormalP3ui(t, e.type, packed(e));
    if (e.type == GL_BYTE) return encode_glNormal3bv(t, e.as<GLbyte>());
    MURAL_SEND_SIFD(glNormal3)
}

void sendTexCoord(ThreadState& t, GLenum unit, const Element& e) {
#define MURAL_SEND_UNIT(n)                                                                                             \
    switch (e.type) {                                                                                                  \
    case GL_SHORT: return encode_glMultiTexCoord##n##sv(t, unit, e.as<GLshort>());                                     \
    case GL_INT: return encode_glMultiTexCoord##n##iv(t, unit, e.as<GLint>());                                         \
    case GL_FLOAT: return encode_glMultiTexCoord##n##fv(t, unit, e.as<GLfloat>());                                     \
    case GL_DOUBLE: return encode_glMultiTexCoord##n##dv(t, unit, e.as<GLdouble>());                                   \
    default: return encode_glMultiTexCoordP##n##ui(t, unit, e.type, packed(e));                                        \
    }
    if (e.size == 1) MURAL_SEND_UNIT(1)
    if (e.size == 2) MURAL_SEND_UNIT(2)
    if (e.size == 3) MURAL_SEND_UNIT(3)
    MURAL_SEND_UNIT(4)
#undef MURAL_SEND_UNIT
}

void sendIndex(ThreadState& t, const Element& e) {
    if (e.type == GL_UNSIGNED_BYTE) return encode_glIndexubv(t, e.as<GLubyte>());
    MURAL_SEND_SIFD(glIndex)
}

void sendInteger(ThreadState& t, GLuint index, const Element& e) {
    GLint values[4] = {0, 0, 0, 1};
    for (int k = 0; k < e.size; ++k) {
        switch (e.type) {
        case GL_BYTE: values[k] = e.as<GLbyte>()[k]; break;
        case GL_UNSIGNED_BYTE: values[k] = e.as<GLubyte>()[k]; break;
        case GL_SHORT: values[k] = e.as<GLshort>()[k]; break;
        case GL_UNSIGNED_SHORT: values[k] = e.as<GLushort>()[k]; break;
        default: values[k] = e.as<GLint>()[k]; break;
        }
    }
    const bool isSigned = e.type == GL_BYTE || e.type == GL_SHORT || e.type == GL_INT;
    if (isSigned) return encode_glVertexAttribI4iv(t, index, values);
    encode_glVertexAttribI4uiv(t, index, reinterpret_cast<const GLuint*>(values));
}

void sendDoubles(ThreadState& t, GLuint index, const Element& e) {
    const auto* v = e.as<GLdouble>();
    switch (e.size) {
    case 1: return encode_glVertexAttribL1dv(t, index, v);
    case 2: return encode_glVertexAttribL2dv(t, index, v);
    case 3: return encode_glVertexAttribL3dv(t, index, v);
    default: return encode_glVertexAttribL4dv(t, index, v);
    }
}

void sendPacked(ThreadState& t, GLuint index, const Element& e) {
    const auto normalized = static_cast<GLboolean>(e.flags & kNormalized ? GL_TRUE : GL_FALSE);
    switch (e.size) {
    case 1: return encode_glVertexAttribP1ui(t, index, e.type, normalized, packed(e));
    case 2: return encode_glVertexAttribP2ui(t, index, e.type, normalized, packed(e));
    case 3: return encode_glVertexAttribP3ui(t, index, e.type, normalized, packed(e));
    default: return encode_glVertexAttribP4ui(t, index, e.type, normalized, packed(e));
    }
}

void sendGeneric(ThreadState& t, GLuint index, Element e) {
    if (e.flags & kInteger) return sendInteger(t, index, e);
    if (e.flags & kLong) return sendDoubles(t, index, e);
    if (sizes::isPackedVertexType(e.type)) return sendPacked(t, index, e);
    toFloats(e);
    const auto* v = e.as<GLfloat>();
    switch (e.size) {
    case 1: return encode_glVertexAttrib1fv(t, index, v);
    case 2: return encode_glVertexAttrib2fv(t, index, v);
    case 3: return encode_glVertexAttrib3fv(t, index, v);
    default: return encode_glVertexAttrib4fv(t, index, v);
    }
}

void sendSlot(ThreadState& t, uint32_t slot, Element& e) {
    if (e.size == GL_BGRA) fromBgra(e);
    if (slot < kGeneric0 && becomesFloat(e.type)) toFloats(e);
    switch (slot) {
    case kVertex: return sendVertex(t, e);
    case kNormal: return sendNormal(t, e);
    case kColor: return sendColor(t, e);
    case kSecondaryColor: return sendSecondaryColor(t, e);
    case kFogCoord:
        return e.type == GL_DOUBLE ? encode_glFogCoorddv(t, e.as<GLdouble>()) : encode_glFogCoordfv(t, e.as<GLfloat>());
    case kIndex: return sendIndex(t, e);
    case kEdgeFlag: return encode_glEdgeFlagv(t, e.as<GLboolean>());
    case kPointSize: return; // ES only
    default: break;
    }
    if (slot < kGeneric0)
        sendTexCoord(t, GL_TEXTURE0 + slot - kTexCoord0, e);
    else
        sendGeneric(t, slot - kGeneric0, e);
}

// The buffer of an array. 0: the driver gives no answer, because it draws itself and is between glBegin and glEnd.
GLint bufferOf(uint32_t slot) {
    static constexpr GLenum kBindings[] = {
        GL_VERTEX_ARRAY_BUFFER_BINDING,          GL_NORMAL_ARRAY_BUFFER_BINDING,         GL_COLOR_ARRAY_BUFFER_BINDING,
        GL_SECONDARY_COLOR_ARRAY_BUFFER_BINDING, GL_FOG_COORDINATE_ARRAY_BUFFER_BINDING, GL_INDEX_ARRAY_BUFFER_BINDING,
        GL_EDGE_FLAG_ARRAY_BUFFER_BINDING};
    GLint buffer = 0;
    if (slot >= kGeneric0) {
        gReal.glGetVertexAttribiv(slot - kGeneric0, GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING, &buffer);
    } else if (slot >= kTexCoord0) {
        GLint before = GL_TEXTURE0;
        gReal.glGetIntegerv(GL_CLIENT_ACTIVE_TEXTURE, &before);
        gReal.glClientActiveTexture(GL_TEXTURE0 + slot - kTexCoord0);
        gReal.glGetIntegerv(GL_TEXTURE_COORD_ARRAY_BUFFER_BINDING, &buffer);
        gReal.glClientActiveTexture(static_cast<GLenum>(before));
    } else if (slot < kPointSize) {
        gReal.glGetIntegerv(kBindings[slot], &buffer);
    }
    return buffer;
}

bool copyFromBuffer(const ThreadState& t, uint32_t slot, const std::byte* at, uint32_t bytes, std::byte* out) {
    const PrimitivePause pause(t);
    const GLint buffer = bufferOf(slot);
    if (buffer == 0) return false;
    GLint before = 0;
    gReal.glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &before);
    gReal.glBindBuffer(GL_ARRAY_BUFFER, static_cast<GLuint>(buffer));
    gReal.glGetBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(reinterpret_cast<uintptr_t>(at)), bytes, out);
    gReal.glBindBuffer(GL_ARRAY_BUFFER, static_cast<GLuint>(before));
    return true;
}

void sendArray(ThreadState& t, const VertexArray& va, uint32_t slot, GLint i) {
    const ArrayPointer& a = va.slots[slot];
    const uint32_t bytes = sizes::attributeBytes(a.size, a.type);
    Element e;
    if (bytes == 0 || bytes > sizeof e.bytes) return;
    e.size = a.size;
    e.type = a.type;
    e.flags = a.flags;
    const int64_t stride = a.stride > 0 ? a.stride : bytes;
    const auto* at = static_cast<const std::byte*>(a.pointer) + a.relative + stride * i;
    if (va.isClient(slot))
        std::memcpy(e.bytes, at, bytes);
    else if (!copyFromBuffer(t, slot, at, bytes, e.bytes))
        return;
    sendSlot(t, slot, e);
}

} // namespace

void sendElement(ThreadState& t, Context& c, GLint i) {
    if (static_cast<GLuint>(i) == c.restartElement) return encode_glPrimitiveRestartNV(t);
    const VertexArray& va = c.arrays.current();
    const auto enabled = [&](uint32_t slot) { return va.enabled[slot / 64] >> slot % 64 & 1; };
    for (uint32_t slot = kVertex + 1; slot < kSlots; ++slot) {
        if (enabled(slot) && slot != kGeneric0) sendArray(t, va, slot, i);
    }
    if (enabled(kGeneric0))
        sendArray(t, va, kGeneric0, i); // replaces the vertex
    else if (enabled(kVertex))
        sendArray(t, va, kVertex, i);
}

} // namespace mural
