// Conversion of float parameters to integers, as GL does.
#pragma once

#include <GL/gl.h>
#include <cstdint>

namespace mural {

// The nearest int; 0 for NaN.
inline GLint toInt(GLfloat value) {
    if (!(value > -2147483648.0f)) return value <= -2147483648.0f ? INT32_MIN : 0;
    return value < 2147483648.0f ? static_cast<GLint>(value) : INT32_MAX;
}

} // namespace mural
