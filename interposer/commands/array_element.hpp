// glArrayElement from the program's memory.
#pragma once

#include <GL/gl.h>

namespace mural {

struct ThreadState;
struct Context;

// Sends element i of all enabled arrays as the commands that set them one by one, the vertex last: between
// glBegin and glEnd no array can be given to the nodes, and the memory may change from one element to the next.
void sendElement(ThreadState& t, Context& c, GLint i);

} // namespace mural
