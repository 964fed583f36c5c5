// Replaces libc's dlsym. Programs that open a GL library and look up its functions by name (SDL, GLFW, Qt) bypass
// exported names. For names of GL, this dlsym returns the functions of the preloaded entry.
#pragma once

namespace mural {

// Returns the function for a GL name whose lookup returned `found`. Implemented in preload_entry.cpp.
void* replaceFound(const char* name, void* found);

} // namespace mural
