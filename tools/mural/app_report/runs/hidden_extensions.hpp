// Extensions of this machine's GL that programs on Mural do not see.
#pragma once

#include <string>
#include <vector>

namespace mural::cli {

// Sorted. Empty: there are none, or the GL cannot be queried.
std::vector<std::string> hiddenExtensions();

} // namespace mural::cli
