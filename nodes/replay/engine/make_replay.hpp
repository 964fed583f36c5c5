// The player of captured programs, without the many headers of Replay.
#pragma once

#include "nodes/player/stream_player.hpp"

namespace mural {

// A MakePlayer without errors.
Result<std::unique_ptr<StreamPlayer>> makeReplay(std::unique_ptr<gl::Platform> platform, const PlayerConfig& config,
                                                 PlayerOutputs outputs);

} // namespace mural
