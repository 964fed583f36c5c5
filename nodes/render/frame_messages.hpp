// The parts of a node's messages about a frame that follow from the replay alone.
#pragma once

#include "nodes/replay/engine/replay_setup.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

[[nodiscard]] wire::PictureHeader pictureHeaderOf(const ReplayOutputs::Frame& frame);

// The times and the number of commands are 0.
[[nodiscard]] wire::FrameDoneMessage frameDoneMessageOf(const ReplayOutputs::Frame& frame);

} // namespace mural
