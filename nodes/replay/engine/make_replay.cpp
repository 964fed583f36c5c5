#include "nodes/replay/engine/make_replay.hpp"

#include <utility>

#include "nodes/replay/engine/replay.hpp"

namespace mural {

Result<std::unique_ptr<StreamPlayer>> makeReplay(std::unique_ptr<gl::Platform> platform, const PlayerConfig& config,
                                                 PlayerOutputs outputs) {
    return std::unique_ptr<StreamPlayer>(std::make_unique<Replay>(std::move(platform), config, std::move(outputs)));
}

} // namespace mural
