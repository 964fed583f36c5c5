// Locations of a linked program by name: the nodes' driver may number uniforms in another way.
#pragma once

#include <GL/gl.h>

namespace mural {

struct ThreadState;

// Binds every active attribute to the location that it has here; takes effect when the nodes link.
void bindAttributes(ThreadState& t, GLuint program);
// kOpProgramLayout: u32 count, then (i32 location, u32 length, name…) per uniform, padded to 4 bytes.
void sendLayout(ThreadState& t, GLuint program);

} // namespace mural
