// Selects GLVND's vendor libraries. `mural run` sets them in the environment, and GLVND reads it with the first
// display. A program may have cleared or changed its environment by then. This library's own getenv therefore answers
// GLVND. The program itself sees its environment unchanged.
#pragma once

namespace mural {

// Returns the real vendor: the program's own later setting, otherwise the user's. Null: neither exists.
const char* wantedGlxVendor();
// The same for EGL's vendor files: a list of paths separated by colons.
const char* wantedEglVendors();

} // namespace mural
