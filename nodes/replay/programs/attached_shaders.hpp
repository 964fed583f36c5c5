// Queries the shaders attached to a program.
#pragma once

#include <algorithm>
#include <vector>

#include "gl_functions.hpp"

namespace mural {

// Returns at most 64 shaders, in the driver's order.
inline std::vector<GLuint> attachedShaders(const GlFunctions& gl, GLuint program) {
    constexpr GLsizei kMax = 64;
    std::vector<GLuint> attached(kMax);
    GLsizei count = 0;
    gl.glGetAttachedShaders(program, kMax, &count, attached.data());
    attached.resize(static_cast<size_t>(std::clamp(count, 0, kMax)));
    return attached;
}

} // namespace mural
