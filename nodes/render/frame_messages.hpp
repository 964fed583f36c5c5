// The parts of a node's messages about a frame that follow from the replay alone.
#pragma once

#include "nodes/player/player_setup.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

[[nodiscard]] wire::PictureHeader pictureHeaderOf(const PlayerOutputs::Frame& frame);

// The times and the number of commands are 0.
[[nodiscard]] wire::FrameDoneMessage frameDoneMessageOf(const PlayerOutputs::Frame& frame);

} // namespace mural
