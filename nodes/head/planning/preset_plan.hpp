// The configuration that the options of a session without a file describe.
#pragma once

#include "balancer/config/presets.hpp"
#include "nodes/session/session_config.hpp"

namespace mural {

// Returns true if the options distribute the work while the session runs: --tile-queue, --chunk-queue, --balance. Such
// sessions run the configuration of presetOf().
[[nodiscard]] bool movesWork(const SessionConfig& config);

// Returns true if several nodes may share each part of the picture. A session may then have more nodes than tiles.
[[nodiscard]] inline bool sharesParts(const SessionConfig& config) {
    return config.tileWidth > 0 || (movesWork(config) && config.chunks == 0);
}

// Errors: a stereo mode that configurations do not have.
Result<config::Preset> presetOf(const SessionConfig& config);

} // namespace mural
