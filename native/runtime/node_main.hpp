// The process of a render node that runs the program's own binary.
#pragma once

#include <optional>

#include <mural/mural.hpp>

namespace mural::native {

// Runs a render node if the arguments begin with --mural-node, and returns the exit status of the process. Otherwise
// returns nothing.
std::optional<int> runNodeIfRequested(int argc, char** argv, const Program& program);

} // namespace mural::native
