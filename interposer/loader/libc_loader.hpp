// The C library's own dlopen, dlsym and dlclose. Overlays and debuggers in LD_PRELOAD replace these names. A lookup
// through a replacement starts at the replacement's place in the load order, and may return our own function.
#pragma once

#include <dlfcn.h>

namespace mural::loader {

void* openLibrary(const char* name, int flags);
void closeLibrary(void* handle);
// handle: as for dlsym. RTLD_NEXT continues after the library that contains this function.
void* symbolIn(void* handle, const char* name);
// Returns the C library's function of this name, or null if there is none. Allocates nothing.
void* libcFunction(const char* name);
// Returns the function of this name in the next library in load order. Allocates nothing, so functions that allocators
// call during their start can use it.
void* nextFunction(const char* name);

// Keeps the object that contains the address loaded until the process ends. For objects whose addresses are stored.
void keepLoaded(const void* address);

} // namespace mural::loader
