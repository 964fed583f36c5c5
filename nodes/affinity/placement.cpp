#include "nodes/affinity/placement.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

#include "nodes/affinity/machine_view.hpp"

namespace mural {
namespace {

using Topology = std::unique_ptr<hwloc_topology, decltype(&hwloc_topology_destroy)>;
using Bitmap = std::unique_ptr<hwloc_bitmap_s, decltype(&hwloc_bitmap_free)>;

// hwloc plugins that query drivers. PCI already locates devices. The "gl" plugin connects to the X displays :0 to :9 of
// any user, and Xlib ends this process if one of them closes meanwhile.
constexpr std::array kDriverComponents{"gl", "opencl", "cuda", "nvml", "rsmi", "levelzero"};

Topology loadTopology() {
    hwloc_topology_t topology = nullptr;
    if (hwloc_topology_init(&topology) != 0) return {nullptr, hwloc_topology_destroy};
    Topology owned(topology, hwloc_topology_destroy);
    for (const char* name : kDriverComponents)
        hwloc_topology_set_components(topology, HWLOC_TOPOLOGY_COMPONENTS_FLAG_BLACKLIST, name);
    hwloc_topology_set_io_types_filter(topology, HWLOC_TYPE_FILTER_KEEP_IMPORTANT);
    if (hwloc_topology_load(topology) != 0) owned.reset();
    return owned;
}

std::set<unsigned> cpusOfThisThread(hwloc_topology_t topology) {
    std::set<unsigned> cpus;
    const Bitmap bitmap(hwloc_bitmap_alloc(), hwloc_bitmap_free);
    if (!bitmap || hwloc_get_cpubind(topology, bitmap.get(), HWLOC_CPUBIND_THREAD) != 0) return cpus;
    hwloc_bitmap_and(bitmap.get(), bitmap.get(), hwloc_topology_get_allowed_cpuset(topology));
    for (int cpu = hwloc_bitmap_first(bitmap.get()); cpu >= 0; cpu = hwloc_bitmap_next(bitmap.get(), cpu))
        cpus.insert(static_cast<unsigned>(cpu));
    return cpus;
}

bool bindThisThread(hwloc_topology_t topology, const std::set<unsigned>& cpus) {
    const Bitmap bitmap(hwloc_bitmap_alloc(), hwloc_bitmap_free);
    if (!bitmap) return false;
    for (const unsigned cpu : cpus) hwloc_bitmap_set(bitmap.get(), cpu);
    return hwloc_set_cpubind(topology, bitmap.get(), HWLOC_CPUBIND_THREAD) == 0;
}

} // namespace

Placement placeThread(DeviceKind kind) {
    const Topology topology = loadTopology();
    if (!topology) return {"not placed: hwloc cannot read this machine", false};
    MachineView machine = viewOf(topology.get(), factsOfThisMachine());
    machine.allowedCpus = cpusOfThisThread(topology.get());
    const PlacementChoice choice = choosePlacement(machine, kind);
    if (choice.cpus.empty()) return {choice.description, false};
    if (bindThisThread(topology.get(), choice.cpus)) return {choice.description, true};
    return {std::string("not placed: the kernel refuses the core set (") + std::strerror(errno) + ")", false};
}

} // namespace mural
