// Threads near the device that they feed: on the cores of the NUMA node that the GPU, or the network
// card, is attached to. Threads that a placed thread starts later stay there too.
#pragma once

#include <string>

namespace mural {

enum class DeviceKind { Gpu, Network };

struct Placement {
    std::string description; // one line for --explain
    bool bound = false;
};

// Binds the calling thread, never beyond what it may use already. Where there is nothing to choose
// (one NUMA node, no such device) nothing changes, and the description says so.
Placement placeThread(DeviceKind kind);

} // namespace mural
