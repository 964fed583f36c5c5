// GL commands through libepoxy, for the backends whose contexts it supports: EGL and GLX.
#pragma once

#include "nodes/gl/gl_platform.hpp"

namespace mural::gl {

// own: the result of the platform's loader. Returns libepoxy's function if it dispatches this command in contexts of
// all kinds, otherwise `own` (docs/decisions/0002-entry-points-of-the-nodes.md). libepoxy resolves the driver's
// function on the first call, and aborts if no context is current then.
Proc throughEpoxy(const char* name, Proc own);

} // namespace mural::gl
