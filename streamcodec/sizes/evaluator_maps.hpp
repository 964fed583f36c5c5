// Control points of glMap1* and glMap2*: the number of values that GL reads, and packed copies.
#pragma once

#include <cstddef>
#include <cstdint>

#include <GL/gl.h>

namespace mural::sizes {

// Values per control point; 0: not a map.
uint32_t mapComponents(GLenum target);

// Floats or doubles from `points` to the last one that GL reads; strides count values. 0: GL raises an error and reads
// nothing (invalid target, order < 1, stride smaller than a point).
size_t map1Values(GLenum target, GLint stride, GLint order);
size_t map2Values(GLenum target, GLint ustride, GLint uorder, GLint vstride, GLint vorder);

// Copies without gaps: afterwards stride = mapComponents(target), and in two dimensions vstride =
// mapComponents(target), ustride = vorder·vstride. dst has (u)order·vorder points. Returns the number of values
// written, 0 if GL reads nothing.
size_t packMap1(float* dst, const float* points, GLenum target, GLint stride, GLint order);
size_t packMap1(double* dst, const double* points, GLenum target, GLint stride, GLint order);
size_t packMap2(float* dst, const float* points, GLenum target, GLint ustride, GLint uorder, GLint vstride,
                GLint vorder);
size_t packMap2(double* dst, const double* points, GLenum target, GLint ustride, GLint uorder, GLint vstride,
                GLint vorder);

} // namespace mural::sizes
