// Persistent UUID of this machine's node. Reveals nothing about the machine.
#pragma once

#include <string>

#include "common/base/result.hpp"
#include "transport/uuid.hpp"

namespace mural {

// Search paths, replaceable for tests.
struct NodeIdPlaces {
    std::string machineId = "/etc/machine-id";
    std::string state; // folder; empty: $XDG_STATE_HOME/mural, or ~/.local/state/mural
};

// Derived from the machine id with a keyed hash, as machine-id(5) requires. Without a machine id, created once and
// stored.
Result<Uuid> nodeId(const NodeIdPlaces& places = {});

} // namespace mural
