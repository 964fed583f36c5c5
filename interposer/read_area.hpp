// What a read takes of the framebuffer that the program's context reads from.
#pragma once

#include <GL/gl.h>

namespace mural {

struct Context;

[[nodiscard]] bool readsWindow(const Context& c);

struct ReadArea {
    GLint x, y;
    GLsizei w, h;
};

// Cuts the rectangle to the read framebuffer: the GL leaves memory for the rest untouched. False: nothing is left.
// Format and type are right for it.
[[nodiscard]] bool cutToReadFramebuffer(Context& c, GLenum format, GLenum type, ReadArea& area);

} // namespace mural
