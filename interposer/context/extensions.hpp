// The capabilities that programs see: the intersection of the driver here, all nodes, and Mural.
#pragma once

#include <GL/gl.h>

namespace mural {

struct Context;

// GL_EXTENSIONS and GL_VERSION for the program; null: use the driver's own.
const char* adjustedString(Context& c, GLenum name);
const char* extensionAt(Context& c, GLuint index);
GLint extensionCount(Context& c); // negative: use the driver's own

// A GLX or EGL extension string without machine-local extensions. Each result is permanent, because programs keep the
// pointer.
const char* filterWindowSystemExtensions(const char* text);

} // namespace mural
