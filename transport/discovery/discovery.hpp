// Finds daemons on this network: by Mural's beacon (UDP multicast, IPv4 and IPv6), and by Avahi where it runs.
#pragma once

#include <functional>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "transport/discovery/node_table.hpp"

namespace mural {

struct DiscoveryOptions {
    bool beacon = true;
    bool avahi = true;
    std::string interface; // name or address; empty: all with multicast
};

struct Discovered {
    std::vector<FoundNode> nodes;
    // Error per method; empty: it worked, or was disabled.
    std::string beaconTrouble;
    std::string avahiTrouble;
};

// Searches until the deadline, or until `enough` (may be empty) returns true.
Discovered discoverNodes(const DiscoveryOptions& options, Deadline deadline,
                         const std::function<bool(const std::vector<FoundNode>&)>& enough = {});

} // namespace mural
