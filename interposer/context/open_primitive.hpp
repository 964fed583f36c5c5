// Tracks whether a context is between glBegin and glEnd. Drivers then reject all calls except vertex commands. Rejected
// calls are not sent to the nodes, which would reject them as well, and do not change mirrored state.
#pragma once

#include "interposer/context/context.hpp"
#include "interposer/encode/real_gl.hpp"

namespace mural {

// Whether the program's own driver is between glBegin and glEnd. The query itself raises an error there, so call this
// only where the program's own call raises the same error. (Mesa answers glGet* during list compilation, even then.)
inline bool answersNothing() { return gReal.glGetString(GL_VENDOR) == nullptr; }

// For calls other than vertex commands. A rejected glBegin has started no primitive.
bool primitiveIsOpen(Context& c);
inline bool refusedInPrimitive(const ThreadState& t) {
    return t.context && t.context->openPrimitive != kNoPrimitive && primitiveIsOpen(*t.context);
}

} // namespace mural
