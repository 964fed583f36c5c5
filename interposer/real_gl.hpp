// The entry points of the vendor's driver, which the app's own context runs on.
#pragma once

#include "gl_functions.hpp"

namespace mural {

extern GlFunctions gReal;

using Entry = void (*)();
using Loader = Entry (*)(const char* name);

// Remembers the vendor's loader; functions are looked up when they are first asked for.
void setRealLoader(Loader loader);
// The wrapper that a program gets for `name`; null when the driver has no such command or Mural does
// not carry it. Loads the driver's entry point.
Entry wrapperFor(const char* name);
// Loads everything that the interposer itself calls.
void loadOwnNeeds();

} // namespace mural
