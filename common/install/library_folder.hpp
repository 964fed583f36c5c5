// The folder of Mural's own libraries, plug-ins and helper programs. Other programs never search it.
#pragma once

#include <string>

namespace mural {

// Returns the folder relative to a binary of Mural: PREFIX/LIBDIR/mural of an installation (LIBDIR: such as
// lib/x86_64-linux-gnu), otherwise lib of the build tree. It may be missing.
std::string libraryFolder(const std::string& binary);

} // namespace mural
