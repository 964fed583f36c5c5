// The choice of GLVND's vendor libraries. `mural run` sets it in the environment, and GLVND reads it with the first display:
// a program may have cleared or changed its environment by then. This library's own getenv therefore answers GLVND; the
// program itself sees its environment as it is.
#pragma once

namespace mural {

// The real vendor: what the program itself has set since, else what the user had set; null: neither.
const char* wantedGlxVendor();
// The same for EGL's vendor files, a list of paths between colons.
const char* wantedEglVendors();

} // namespace mural
