// glArrayElement with client memory.
#pragma once

#include <GL/gl.h>

namespace mural {

struct ThreadState;
struct Context;

// Sends element i of all enabled arrays as immediate-mode commands, the vertex last. Between glBegin and glEnd arrays
// cannot be sent, and the memory may change between elements.
void sendElement(ThreadState& t, Context& c, GLint i);

} // namespace mural
