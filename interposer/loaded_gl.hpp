// The GL libraries of this process that do not lead to GLVND, by what their ELF headers say.
#pragma once

#include <cstddef>

namespace mural {

// Path of a loaded GL library that GLVND does not lead to; null: none. Valid until the program ends.
const char* loadedOwnGl();

// Paths of up to three loaded libraries that export GL's names past GLVND and past us, with " and "
// between; false: there are none.
bool librariesPastUs(char* into, size_t sizeBytes);

} // namespace mural
