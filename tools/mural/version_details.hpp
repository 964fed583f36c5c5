// `mural version --verbose`: properties of this build and the files that it finds, for reports of errors.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace mural::cli {

// Returns name and text of each property, in the order of the output.
std::vector<std::pair<std::string, std::string>> versionDetails();

} // namespace mural::cli
