#include "nodes/affinity/machine_view.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace mural {
namespace {

constexpr unsigned kPciDisplayClass = 0x03;

std::set<unsigned> toSet(hwloc_const_bitmap_t bitmap) {
    std::set<unsigned> cpus;
    if (bitmap == nullptr || hwloc_bitmap_weight(bitmap) < 0) return cpus;
    for (int cpu = hwloc_bitmap_first(bitmap); cpu >= 0; cpu = hwloc_bitmap_next(bitmap, cpu))
        cpus.insert(static_cast<unsigned>(cpu));
    return cpus;
}

std::string busIdOf(const hwloc_obj_attr_u::hwloc_pcidev_attr_s& pci) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%04x:%02x:%02x.%01x", static_cast<unsigned>(pci.domain),
                  static_cast<unsigned>(pci.bus), static_cast<unsigned>(pci.dev), static_cast<unsigned>(pci.func));
    return text.data();
}

std::set<unsigned> cpusCloseTo(hwloc_topology_t topology, hwloc_obj_t device) {
    const hwloc_obj_t object = hwloc_get_non_io_ancestor_obj(topology, device);
    return object == nullptr ? std::set<unsigned>() : toSet(object->cpuset);
}

int linkMbitPerSec(const std::string& interface) {
    const std::filesystem::path folder = std::filesystem::path("/sys/class/net") / interface;
    std::string state;
    std::ifstream(folder / "operstate") >> state;
    if (state != "up") return 0;
    int speed = 0;
    std::ifstream(folder / "speed") >> speed;
    return speed > 0 ? speed : 1; // the interface is up; drivers of virtual cards report no speed
}

bool canRender(const std::string& busId) {
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator("/sys/bus/pci/devices/" + busId + "/drm", none))
        if (entry.path().filename().string().starts_with("renderD")) return true;
    return false;
}

} // namespace

DeviceFacts factsOfThisMachine() { return {linkMbitPerSec, canRender}; }

MachineView viewOf(hwloc_topology_t topology, const DeviceFacts& facts) {
    MachineView machine;
    machine.numaNodes = hwloc_get_nbobjs_by_type(topology, HWLOC_OBJ_NUMANODE);
    for (hwloc_obj_t o = nullptr; (o = hwloc_get_next_pcidev(topology, o)) != nullptr;) {
        if (o->attr->pcidev.class_id >> 8 != kPciDisplayClass) continue;
        const std::string busId = busIdOf(o->attr->pcidev);
        machine.devices.push_back(
            {DeviceKind::Gpu, "PCI " + busId, facts.canRender(busId) ? 1 : 0, true, cpusCloseTo(topology, o)});
    }
    for (hwloc_obj_t o = nullptr; (o = hwloc_get_next_osdev(topology, o)) != nullptr;) {
        if (o->attr->osdev.type != HWLOC_OBJ_OSDEV_NETWORK || o->name == nullptr) continue;
        const int speed = facts.linkMbitPerSec(o->name);
        machine.devices.push_back({DeviceKind::Network, o->name, speed, speed > 0, cpusCloseTo(topology, o)});
    }
    return machine;
}

} // namespace mural
