#include "streamcodec/sizes/vertex_types.hpp"

#include "streamcodec/sizes/gl_enums.hpp"

namespace mural::sizes {

bool isPackedVertexType(GLenum type) {
    switch (type) {
    case GL_INT_2_10_10_10_REV:
    case GL_UNSIGNED_INT_2_10_10_10_REV:
    case GL_UNSIGNED_INT_10F_11F_11F_REV:
    case GL_INT_10_10_10_2_OES:
    case GL_UNSIGNED_INT_10_10_10_2_OES: return true;
    default: return false;
    }
}

uint32_t typeBytes(GLenum type) {
    switch (type) {
    case GL_BYTE:
    case GL_UNSIGNED_BYTE: return 1;
    case GL_SHORT:
    case GL_UNSIGNED_SHORT:
    case GL_HALF_FLOAT:
    case GL_HALF_FLOAT_OES:
    case GL_2_BYTES: return 2;
    case GL_3_BYTES: return 3;
    case GL_INT:
    case GL_UNSIGNED_INT:
    case GL_FLOAT:
    case GL_FIXED:
    case GL_4_BYTES: return 4;
    case GL_DOUBLE:
    case GL_INT64_NV: // = ARB
    case GL_UNSIGNED_INT64_ARB: return 8;
    default: return isPackedVertexType(type) ? 4 : 0;
    }
}

uint32_t attributeBytes(GLint size, GLenum type) {
    const bool bgra = size == GL_BGRA;
    if (!bgra && (size < 1 || size > 4)) return 0;
    if (isPackedVertexType(type)) return 4;
    return (bgra ? 4u : static_cast<uint32_t>(size)) * typeBytes(type);
}

size_t indirectBytes(bool withElements, GLsizei drawCount, GLsizei stride) {
    if (drawCount <= 0 || stride < 0) return 0;
    const size_t command = withElements ? kDrawElementsCommandBytes : kDrawArraysCommandBytes;
    const size_t step = stride > 0 ? static_cast<size_t>(stride) : command;
    return (static_cast<size_t>(drawCount) - 1) * step + command;
}

} // namespace mural::sizes
