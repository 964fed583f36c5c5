// The loaded GL libraries that do not use GLVND, identified by their ELF headers.
#pragma once

#include <cstddef>

namespace mural {

// Path of a loaded GL library without GLVND; null: none. Valid until the program ends.
const char* loadedOwnGl();

// Stores the paths of up to three loaded libraries that export GL names past GLVND and past us, joined by " and ".
// Returns false if there are none.
bool librariesPastUs(char* into, size_t sizeBytes);

} // namespace mural
