// Binds threads to the NUMA node of the device that they feed, a GPU or a network card. Threads started later by a
// bound thread inherit the affinity.
#pragma once

#include <string>

namespace mural {

enum class DeviceKind { Gpu, Network };

struct Placement {
    std::string description; // one line for --explain
    bool bound = false;
};

// Binds the calling thread, within its current affinity. With a single NUMA node or without such a device it changes
// nothing, and the description gives the reason.
Placement placeThread(DeviceKind kind);

} // namespace mural
