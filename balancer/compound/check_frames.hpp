// The checks of frames and queues within each tree of compounds.
#pragma once

#include "balancer/compound/check_config.hpp"

namespace mural::compound {

void checkFrames(const ResolvedConfig& config, config::Diagnostics& diagnostics);

} // namespace mural::compound
