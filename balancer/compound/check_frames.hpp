// Checks of frames and queues within each compound tree.
#pragma once

#include "balancer/compound/check_config.hpp"

namespace mural::compound {

void checkFrames(const ResolvedConfig& config, config::Diagnostics& diagnostics);

} // namespace mural::compound
