// What of a machine matters to placement, as plain data; and the choice from it.
#pragma once

#include <hwloc.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "nodes/placement/placement.hpp"

namespace mural {

struct DeviceView {
    DeviceKind kind = DeviceKind::Gpu;
    std::string name;       // "PCI 0000:41:00.0", "eth0"
    // Of several the highest is taken. GPUs: 1 when it can render (not a management card's display);
    // network interfaces: Mbit/s.
    int rank = 0;
    bool usable = true;     // interfaces that are down are not
    std::set<unsigned> cpus; // near it, as the operating system counts them
};

struct MachineView {
    int numaNodes = 1;
    std::set<unsigned> allowedCpus; // of the calling thread
    std::vector<DeviceView> devices; // in the order of their bus addresses
};

struct PlacementChoice {
    std::set<unsigned> cpus; // empty: leave the thread where it is
    std::string description;
};

PlacementChoice choosePlacement(const MachineView& machine, DeviceKind kind);

// What hwloc does not know; the tests bring their own.
struct DeviceFacts {
    std::function<int(const std::string& interface)> linkMbitPerSec; // 0: down
    std::function<bool(const std::string& busId)> canRender;
};
DeviceFacts factsOfThisMachine();

// The topology must have been loaded with its I/O devices. allowedCpus stays empty.
MachineView viewOf(hwloc_topology_t topology, const DeviceFacts& facts);

} // namespace mural
