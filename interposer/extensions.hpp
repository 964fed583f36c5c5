// What programs are told that they may use: what the driver here, all nodes and Mural can do.
#pragma once

#include <GL/gl.h>

namespace mural {

struct Context;

// GL_EXTENSIONS and GL_VERSION as the program shall see them; null: the driver's own answer stands.
const char* adjustedString(Context& c, GLenum name);
const char* extensionAt(Context& c, GLuint index);
GLint extensionCount(Context& c); // below 0: the driver's own answer stands

// A GLX or EGL extension string without what exists on one machine only. The answer for each text is
// made once and kept: programs keep the pointer.
const char* filterWindowSystemExtensions(const char* text);

} // namespace mural
