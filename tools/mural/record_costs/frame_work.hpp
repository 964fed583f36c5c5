// Reads the work of nodes per frame from a file of `mural run --frame-times`.
#pragma once

#include <istream>
#include <string>

#include "balancer/simulation/measured_costs.hpp"
#include "common/base/result.hpp"

namespace mural::cli {

// Returns the frames from `firstFrame` on of the window with the most pixels drawn, which all `nodes` nodes have drawn.
// Errors name the line.
Result<simulation::WorkByFrame> readFrameWork(std::istream& in, size_t nodes, uint32_t firstFrame);

} // namespace mural::cli
