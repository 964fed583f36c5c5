// Classifies commands by their effect on a window's picture.
#pragma once

#include <cstdint>

#include "gl_functions.hpp"

namespace mural {

enum class WindowUse : uint8_t { None, Clears, Draws, FeedbackBegins, FeedbackEnds };

WindowUse useOf(uint16_t opcode);

constexpr GLbitfield kWindowBuffers = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;

} // namespace mural
