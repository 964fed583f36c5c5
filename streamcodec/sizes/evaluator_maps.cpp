#include "streamcodec/sizes/evaluator_maps.hpp"

#include <cstring>

#include "streamcodec/sizes/gl_enums.hpp"

namespace mural::sizes {
namespace {

// `uorder` rows of `vorder` points; a curve is one row. Strides count values. components 0: GL reads nothing.
struct Points {
    size_t components = 0;
    size_t ustride = 0;
    size_t uorder = 0;
    size_t vstride = 0;
    size_t vorder = 0;
};

bool isStride(GLint stride, uint32_t components) {
    return components > 0 && stride > 0 && static_cast<uint32_t>(stride) >= components;
}

bool within(GLenum target, GLenum first, GLenum last) { return target >= first && target <= last; }

bool isCurve(GLenum target) {
    return within(target, GL_MAP1_COLOR_4, GL_MAP1_VERTEX_4) ||
           within(target, GL_MAP1_VERTEX_ATTRIB0_4_NV, GL_MAP1_VERTEX_ATTRIB15_4_NV);
}

Points curve(GLenum target, GLint stride, GLint order) {
    const uint32_t components = mapComponents(target);
    if (!isCurve(target) || order < 1 || !isStride(stride, components)) return {};
    return {components, 0, 1, static_cast<size_t>(stride), static_cast<size_t>(order)};
}

Points surface(GLenum target, GLint ustride, GLint uorder, GLint vstride, GLint vorder) {
    const uint32_t components = mapComponents(target);
    if (isCurve(target) || uorder < 1 || vorder < 1 || !isStride(ustride, components) || !isStride(vstride, components))
        return {};
    return {components, static_cast<size_t>(ustride), static_cast<size_t>(uorder), static_cast<size_t>(vstride),
            static_cast<size_t>(vorder)};
}

size_t values(const Points& points) {
    if (points.components == 0) return 0;
    return (points.uorder - 1) * points.ustride + (points.vorder - 1) * points.vstride + points.components;
}

template <class Value> size_t pack(Value* dst, const Value* src, const Points& points) {
    if (points.components == 0) return 0;
    for (size_t u = 0; u < points.uorder; ++u) {
        for (size_t v = 0; v < points.vorder; ++v, dst += points.components)
            std::memcpy(dst, src + u * points.ustride + v * points.vstride, points.components * sizeof(Value));
    }
    return points.uorder * points.vorder * points.components;
}

} // namespace

uint32_t mapComponents(GLenum target) {
    if (target >= GL_MAP1_VERTEX_ATTRIB0_4_NV && target <= GL_MAP1_VERTEX_ATTRIB15_4_NV) return 4;
    if (target >= GL_MAP2_VERTEX_ATTRIB0_4_NV && target <= GL_MAP2_VERTEX_ATTRIB15_4_NV) return 4;
    switch (target) {
    case GL_MAP1_INDEX:
    case GL_MAP1_TEXTURE_COORD_1:
    case GL_MAP2_INDEX:
    case GL_MAP2_TEXTURE_COORD_1: return 1;
    case GL_MAP1_TEXTURE_COORD_2:
    case GL_MAP2_TEXTURE_COORD_2: return 2;
    case GL_MAP1_NORMAL:
    case GL_MAP1_TEXTURE_COORD_3:
    case GL_MAP1_VERTEX_3:
    case GL_MAP2_NORMAL:
    case GL_MAP2_TEXTURE_COORD_3:
    case GL_MAP2_VERTEX_3: return 3;
    case GL_MAP1_COLOR_4:
    case GL_MAP1_TEXTURE_COORD_4:
    case GL_MAP1_VERTEX_4:
    case GL_MAP2_COLOR_4:
    case GL_MAP2_TEXTURE_COORD_4:
    case GL_MAP2_VERTEX_4: return 4;
    default: return 0;
    }
}

size_t map1Values(GLenum target, GLint stride, GLint order) { return values(curve(target, stride, order)); }

size_t map2Values(GLenum target, GLint ustride, GLint uorder, GLint vstride, GLint vorder) {
    return values(surface(target, ustride, uorder, vstride, vorder));
}

size_t packMap1(float* dst, const float* points, GLenum target, GLint stride, GLint order) {
    return pack(dst, points, curve(target, stride, order));
}

size_t packMap1(double* dst, const double* points, GLenum target, GLint stride, GLint order) {
    return pack(dst, points, curve(target, stride, order));
}

size_t packMap2(float* dst, const float* points, GLenum target, GLint ustride, GLint uorder, GLint vstride,
                GLint vorder) {
    return pack(dst, points, surface(target, ustride, uorder, vstride, vorder));
}

size_t packMap2(double* dst, const double* points, GLenum target, GLint ustride, GLint uorder, GLint vstride,
                GLint vorder) {
    return pack(dst, points, surface(target, ustride, uorder, vstride, vorder));
}

} // namespace mural::sizes
