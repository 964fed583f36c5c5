// What is wrong with a configuration that reads well: frames that nobody makes or that wait for each other, queues that
// nobody fills, parts that are never shown. Found when it is loaded, not when it stands still.
#pragma once

#include "balancer/compound/display_sizes.hpp"
#include "balancer/config/diagnostics.hpp"

namespace mural::compound {

void checkConfig(const ResolvedConfig& config, config::Diagnostics& diagnostics);

} // namespace mural::compound
