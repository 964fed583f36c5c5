// The replay's configuration and placement, from the head's Setup message and this node's GL.
#pragma once

#include <string>

#include "nodes/player/player_setup.hpp"
#include "nodes/session/session_config.hpp"

namespace mural {

// `renderer`: name of this node's GL; software renderers draw and read differently.
[[nodiscard]] PlayerConfig playerConfigOf(const NodeSetup& setup, const std::string& renderer);

// Places the calling thread near the GPU, and returns the placement for a person. Not with software rendering, because
// the driver's threads then need all cores.
std::string placeReplay(const NodeSetup& setup, const std::string& renderer);

} // namespace mural
