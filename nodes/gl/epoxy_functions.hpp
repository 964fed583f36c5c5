// GL commands through libepoxy, for the backends whose contexts it supports: EGL and GLX.
#pragma once

#include "nodes/gl/gl_platform.hpp"

namespace mural::gl {

// Returns libepoxy's function if it dispatches this command in contexts of all kinds, otherwise `own`. The rule is in
// docs/decisions/0002-entry-points-of-the-nodes.md. libepoxy resolves the driver's function on the first call. It
// aborts if no context is current then. own: the result of the platform's loader.
Proc throughEpoxy(const char* name, Proc own);

} // namespace mural::gl
