// Programs with fragment shaders that write to memory (atomic counters, storage blocks, images). The result depends on
// all fragments of a picture, selected by depth and stencil. From the first link of such a program, every node draws
// the whole window, and receives what the others have drawn before.
#pragma once

#include <GL/gl.h>
#include <cstddef>

namespace mural {

struct ThreadState;

// Call after a program was linked: from its attached shaders, from one of these texts, or from a recipe
// (docs/reference/wire-format.md).
void recordMemoryWriter(ThreadState& t, GLuint program);
void recordMemoryWriter(ThreadState& t, GLuint program, GLenum type, GLsizei count, const GLchar* const* strings);
void recordMemoryWriter(ThreadState& t, GLuint program, const std::byte* recipe, size_t sizeBytes);

} // namespace mural
