// The part of a read that lies in the current read framebuffer.
#pragma once

#include <GL/gl.h>

namespace mural {

struct Context;

[[nodiscard]] bool readsWindow(const Context& c);

struct ReadArea {
    GLint x, y;
    GLsizei w, h;
};

// Clips the rectangle to the read framebuffer: GL leaves the memory of other pixels unchanged. Returns false if nothing
// is left. Requires a valid format and type.
[[nodiscard]] bool cutToReadFramebuffer(Context& c, GLenum format, GLenum type, ReadArea& area);

} // namespace mural
