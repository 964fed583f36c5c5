#include "streamcodec/sizes/parameter_counts.hpp"

#include <cstring>

#include "streamcodec/sizes/gl_enums.hpp"

namespace mural::sizes {

uint32_t texParameterCount(GLenum pname) {
    switch (pname) {
    case GL_TEXTURE_BORDER_COLOR:
    case GL_TEXTURE_SWIZZLE_RGBA:
    case GL_TEXTURE_CROP_RECT_OES:
    case GL_POST_TEXTURE_FILTER_BIAS_SGIX:
    case GL_POST_TEXTURE_FILTER_SCALE_SGIX: return 4;
    case GL_TEXTURE_CLIPMAP_VIRTUAL_DEPTH_SGIX: return 3;
    case GL_TEXTURE_CLIPMAP_CENTER_SGIX:
    case GL_TEXTURE_CLIPMAP_OFFSET_SGIX: return 2;
    default: return 1;
    }
}

uint32_t texEnvCount(GLenum pname) {
    switch (pname) {
    case GL_TEXTURE_ENV_COLOR:
    case GL_TEXTURE_ENV_BIAS_SGIX:
    case GL_CULL_MODES_NV:
    case GL_OFFSET_TEXTURE_MATRIX_NV: return 4;
    case GL_CONST_EYE_NV: return 3;
    default: return 1;
    }
}

uint32_t texGenCount(GLenum pname) {
    switch (pname) {
    case GL_EYE_LINE_SGIS:
    case GL_OBJECT_LINE_SGIS: return 7; // a point and a direction
    case GL_OBJECT_PLANE:
    case GL_EYE_PLANE:
    case GL_OBJECT_POINT_SGIS:
    case GL_EYE_POINT_SGIS: return 4;
    default: return 1;
    }
}

uint32_t lightCount(GLenum pname) {
    switch (pname) {
    case GL_AMBIENT:
    case GL_DIFFUSE:
    case GL_SPECULAR:
    case GL_POSITION: return 4;
    case GL_SPOT_DIRECTION: return 3;
    default: return 1;
    }
}

uint32_t lightModelCount(GLenum pname) {
    switch (pname) {
    case GL_LIGHT_MODEL_AMBIENT:
    case GL_FRAGMENT_LIGHT_MODEL_AMBIENT_SGIX: return 4;
    default: return 1;
    }
}

uint32_t materialCount(GLenum pname) {
    switch (pname) {
    case GL_AMBIENT:
    case GL_DIFFUSE:
    case GL_SPECULAR:
    case GL_EMISSION:
    case GL_AMBIENT_AND_DIFFUSE: return 4;
    case GL_COLOR_INDEXES: return 3;
    default: return 1;
    }
}

uint32_t fogCount(GLenum pname) {
    switch (pname) {
    case GL_FOG_COLOR:
    case GL_FOG_OFFSET_VALUE_SGIX: // the distance of a reference point and the amount: x, y, z, q
        return 4;
    default: return 1;
    }
}

uint32_t pointParameterCount(GLenum pname) { return pname == GL_POINT_DISTANCE_ATTENUATION ? 3 : 1; }

uint32_t samplerParameterCount(GLenum pname) { return pname == GL_TEXTURE_BORDER_COLOR ? 4 : 1; }

uint32_t patchParameterCount(GLenum pname) {
    switch (pname) {
    case GL_PATCH_DEFAULT_OUTER_LEVEL: return 4;
    case GL_PATCH_DEFAULT_INNER_LEVEL: return 2;
    default: return 1;
    }
}

uint32_t convolutionParameterCount(GLenum pname) {
    switch (pname) {
    case GL_CONVOLUTION_FILTER_SCALE:
    case GL_CONVOLUTION_FILTER_BIAS:
    case GL_CONVOLUTION_BORDER_COLOR: return 4;
    default: return 1;
    }
}

uint32_t colorTableParameterCount(GLenum pname) {
    return pname == GL_COLOR_TABLE_SCALE || pname == GL_COLOR_TABLE_BIAS ? 4 : 1;
}

uint32_t combinerParameterCount(GLenum pname) {
    return pname == GL_CONSTANT_COLOR0_NV || pname == GL_CONSTANT_COLOR1_NV ? 4 : 1;
}

uint32_t spriteParameterCount(GLenum pname) {
    return pname == GL_SPRITE_AXIS_SGIX || pname == GL_SPRITE_TRANSLATION_SGIX ? 3 : 1;
}

uint32_t texBumpParameterCount(GLenum pname) { return pname == GL_BUMP_ROT_MATRIX_ATI ? 4 : 1; }

uint32_t singleParameterCount(GLenum /*pname*/) { return 1; }

uint32_t clearBufferCount(GLenum buffer) {
    switch (buffer) {
    case GL_COLOR: return 4;
    case GL_DEPTH:
    case GL_STENCIL: return 1;
    default: return 0;
    }
}

uint32_t variantCount(GLenum dataType) {
    switch (dataType) {
    case GL_SCALAR_EXT: return 1;
    case GL_VECTOR_EXT: return 4;
    case GL_MATRIX_EXT: return 16;
    default: return 0;
    }
}

size_t stringBytes(const char* text, GLsizei length) {
    if (text == nullptr) return 0;
    return length >= 0 ? static_cast<size_t>(length) : std::strlen(text) + 1;
}

size_t attribListCount(const GLint* list) {
    if (list == nullptr) return 0;
    size_t count = 0;
    while (list[count] != GL_NONE) ++count;
    return count + 1;
}

size_t callListsBytes(GLsizei n, GLenum type) {
    switch (type) {
    case GL_BYTE:
    case GL_UNSIGNED_BYTE:
    case GL_SHORT:
    case GL_UNSIGNED_SHORT:
    case GL_INT:
    case GL_UNSIGNED_INT:
    case GL_FLOAT:
    case GL_2_BYTES:
    case GL_3_BYTES:
    case GL_4_BYTES: return n > 0 ? static_cast<size_t>(n) * typeBytes(type) : 0;
    default: return 0;
    }
}

} // namespace mural::sizes
