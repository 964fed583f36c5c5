// Finding nodes that wait for heads, on this network: by a beacon of our own (UDP multicast, IPv4 and IPv6), and by Avahi
// where it runs.
#pragma once

#include <functional>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "transport/discovery/node_table.hpp"

namespace mural {

struct DiscoveryOptions {
    bool beacon = true;
    bool avahi = true;
    std::string interface; // name or address; empty: all that do multicast
};

struct Discovered {
    std::vector<FoundNode> nodes;
    // Why a means found nothing; empty: it worked, or was not wanted.
    std::string beaconTrouble;
    std::string avahiTrouble;
};

// Until the deadline, or `enough` (may be empty) says so.
Discovered discoverNodes(const DiscoveryOptions& options, Deadline deadline, const std::function<bool(const std::vector<FoundNode>&)>& enough = {});

} // namespace mural
