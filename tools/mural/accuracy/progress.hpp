// Reports the progress of `mural bench accuracy`.
#pragma once

#include <string>

namespace mural::cli {

// Prints one line. Silent after an interruption.
void reportProgress(const std::string& what);

} // namespace mural::cli
