// Which vendor libraries GLVND takes. `mural run` says so in the environment, where GLVND looks when the first display is
// used: a program may have cleared or changed its environment by then. GLVND is therefore answered by this library
// (getenv in glvnd_environment.cpp); the program itself sees its environment as it is.
#pragma once

namespace mural {

// The real vendor: what the program itself has set since, else what the user had set; null: neither.
const char* wantedGlxVendor();
// The same for EGL's vendor files, a list of paths between colons.
const char* wantedEglVendors();

} // namespace mural
