// Semantic checks of a configuration: frames without a producer, deadlocks between frames, queues without work, and
// parts that are never shown. The checks run at load time, so a faulty session never starts.
#pragma once

#include "balancer/compound/display_sizes.hpp"
#include "balancer/config/diagnostics.hpp"

namespace mural::compound {

void checkConfig(const ResolvedConfig& config, config::Diagnostics& diagnostics);

} // namespace mural::compound
