// The C library's own dlopen, dlsym and dlclose. Overlays and debuggers in LD_PRELOAD replace these names; a lookup through
// such a replacement starts at the replacement's place in the order, and may lead back to ourselves.
#pragma once

#include <dlfcn.h>

namespace mural::loader {

void* openLibrary(const char* name, int flags);
void closeLibrary(void* handle);
// handle: as for dlsym. RTLD_NEXT continues behind the library that this function is linked into.
void* symbolIn(void* handle, const char* name);
// The C library's function of this name; null: it has none. Allocates nothing.
void* libcFunction(const char* name);
// The next function of this name behind this library in the order in which objects were loaded. Allocates nothing, and so
// serves functions that allocators call while they start.
void* nextFunction(const char* name);

// Keeps the object that the address belongs to loaded until the process ends: for objects whose addresses are stored.
void keepLoaded(const void* address);

} // namespace mural::loader
