// Sizes of vertex attributes, indices and indirect draw commands.
#pragma once

#include <cstddef>
#include <cstdint>

#include <GL/gl.h>

namespace mural::sizes {

// Bytes of one component of an attribute, of an index or of a glCallLists name; for packed types (GL_*_2_10_10_10_REV
// …) of the whole attribute. 0: not a type.
uint32_t typeBytes(GLenum type);

// True for types that pack a whole attribute into 4 bytes.
bool isPackedVertexType(GLenum type);

// size: 1…4 or GL_BGRA. 0: not a type or size.
uint32_t attributeBytes(GLint size, GLenum type);

// The structures that gl(Multi)Draw{Arrays,Elements}Indirect read. stride 0: commands are contiguous.
constexpr size_t kDrawArraysCommandBytes = 16;
constexpr size_t kDrawElementsCommandBytes = 20;
size_t indirectBytes(bool withElements, GLsizei drawCount, GLsizei stride);

} // namespace mural::sizes
