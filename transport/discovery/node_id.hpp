// The UUID of this machine's node: the same after each start, and telling nothing about the machine.
#pragma once

#include <string>

#include "common/result.hpp"
#include "transport/uuid.hpp"

namespace mural {

// Where it is looked for, for tests.
struct NodeIdPlaces {
    std::string machineId = "/etc/machine-id";
    std::string state; // folder; empty: $XDG_STATE_HOME/mural, or ~/.local/state/mural
};

// From the machine's id by a keyed hash, as machine-id(5) asks for; where there is none, made once and kept.
Result<Uuid> nodeId(const NodeIdPlaces& places = {});

} // namespace mural
