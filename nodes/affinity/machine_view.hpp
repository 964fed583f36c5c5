// The properties of a machine that determine thread affinity, as plain data, and the selection of CPUs.
#pragma once

#include <hwloc.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "nodes/affinity/placement.hpp"

namespace mural {

struct DeviceView {
    DeviceKind kind = DeviceKind::Gpu;
    std::string name; // "PCI 0000:41:00.0", "eth0"
    // The device with the highest rank is selected. GPUs: 1 if it can render (not a management card's display). Network
    // interfaces: Mbit/s.
    int rank = 0;
    bool usable = true;      // false for interfaces that are down
    std::set<unsigned> cpus; // CPUs near it, by the operating system's numbers
};

struct MachineView {
    int numaNodes = 1;
    std::set<unsigned> allowedCpus;  // of the calling thread
    std::vector<DeviceView> devices; // in the order of their bus addresses
};

struct PlacementChoice {
    std::set<unsigned> cpus; // empty: keep the affinity
    std::string description;
};

PlacementChoice choosePlacement(const MachineView& machine, DeviceKind kind);

// Properties that hwloc does not report. Tests supply their own.
struct DeviceFacts {
    std::function<int(const std::string& interface)> linkMbitPerSec; // 0: down
    std::function<bool(const std::string& busId)> canRender;
};
DeviceFacts factsOfThisMachine();

// The topology must include I/O devices. Leaves allowedCpus empty.
MachineView viewOf(hwloc_topology_t topology, const DeviceFacts& facts);

} // namespace mural
