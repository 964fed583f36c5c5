// The entry points of the vendor's driver, which executes the program's own context.
#pragma once

#include "gl_functions.hpp"

namespace mural {

extern GlFunctions gReal;

using Entry = void (*)();
using Loader = Entry (*)(const char* name);

// Stores the vendor's loader. Functions are loaded on first use.
void setRealLoader(Loader loader);
// The wrapper of `name`; null if the driver lacks the command or Mural does not support it. Loads the driver's entry
// point.
Entry wrapperFor(const char* name);
// Loads the functions that wrappers of other commands call: the option `loaded` of streamcodec/api/semantics.txt.
void loadOwnNeeds();

} // namespace mural
