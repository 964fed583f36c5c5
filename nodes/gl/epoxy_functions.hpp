// The commands of OpenGL by libepoxy, for the backends whose contexts it knows: EGL and GLX.
#pragma once

#include "nodes/gl/gl_platform.hpp"

namespace mural::gl {

// own: what the platform's loader has for the name. Gives libepoxy's function where it has one that stands for
// this very command in contexts of all kinds, else `own` (docs/decisions/0002-entry-points-of-the-nodes.md).
// libepoxy looks for the driver's function when its own is first called, and then ends the process if no
// context is current.
Proc throughEpoxy(const char* name, Proc own);

} // namespace mural::gl
