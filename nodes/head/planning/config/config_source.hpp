// A configuration, and the names and positions of its parts for messages. Pure.
#pragma once

#include <string>

#include "balancer/compound/frame_input.hpp"

namespace mural {

struct ConfigSource {
    const config::ResolvedConfig& config;
    std::string file; // its name in messages

    // Returns "FILE:LINE".
    [[nodiscard]] std::string lineOf(const config::SourcePosition& position) const;
    // Returns "FILE:LINE:COLUMN" of a compound.
    [[nodiscard]] std::string placeOf(compound::Index compound) const;
    // Returns the name of a channel, or "channel N" for the nameless channel N.
    [[nodiscard]] std::string channelName(compound::Index channel) const;
};

} // namespace mural
