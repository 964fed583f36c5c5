// Between glBegin and glEnd drivers refuse all calls but those that make vertices. Nodes are not told of them: theirs would
// refuse them, too, and what Mural knows of the state by itself stays true.
#pragma once

#include "interposer/context.hpp"
#include "interposer/real_gl.hpp"

namespace mural {

// Whether the program's own driver is between glBegin and glEnd: it answers nothing there and takes the question for an
// error, so this is asked only where such an error has been or will be raised by the program's own call. (Mesa answers
// glGet* while a display list is compiled, even then.)
inline bool answersNothing() { return gReal.glGetString(GL_VENDOR) == nullptr; }

// For a call that makes no vertex. A glBegin that the driver has refused has begun nothing.
bool primitiveIsOpen(Context& c);
inline bool refusedInPrimitive(const ThreadState& t) {
    return t.context && t.context->openPrimitive != kNoPrimitive && primitiveIsOpen(*t.context);
}

} // namespace mural
