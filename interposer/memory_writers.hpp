// Programs whose fragment shaders write to memory (atomic counters, storage blocks, images). What they leave there
// must come from all fragments of a picture, on every node, and which those are depth and stencil decide: from the link
// of the first one on every node draws all, and gets what the others have drawn until then.
#pragma once

#include <GL/gl.h>
#include <cstddef>

namespace mural {

struct ThreadState;

// A program that has just been linked here: from the shaders that it has attached, from one of these texts, from a
// recipe (docs/wire-format.md).
void noteMemoryWriter(ThreadState& t, GLuint program);
void noteMemoryWriter(ThreadState& t, GLuint program, GLenum type, GLsizei count, const GLchar* const* strings);
void noteMemoryWriter(ThreadState& t, GLuint program, const std::byte* recipe, size_t sizeBytes);

} // namespace mural
