// Devices of a machine and the cores near them, from hwloc.
#include "nodes/affinity/machine_view.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "two_packages.hpp"

namespace mural {
namespace {

using Topology = std::unique_ptr<hwloc_topology, decltype(&hwloc_topology_destroy)>;

Topology load(const std::function<int(hwloc_topology_t)>& source) {
    hwloc_topology_t topology = nullptr;
    hwloc_topology_init(&topology);
    Topology owned(topology, hwloc_topology_destroy);
    hwloc_topology_set_io_types_filter(topology, HWLOC_TYPE_FILTER_KEEP_IMPORTANT);
    EXPECT_EQ(source(topology), 0);
    EXPECT_EQ(hwloc_topology_load(topology), 0);
    return owned;
}

const DeviceFacts kFacts{[](const std::string& name) { return name == "ib0" ? 200000 : 1000; },
                         [](const std::string& busId) { return busId == "0000:81:00.0"; }};

TEST(MachineView, findsDevicesAndTheCoresNearThem) {
    const std::string xml = twoPackagesXml(2);
    const Topology topology = load([&](hwloc_topology_t t) {
        return hwloc_topology_set_xmlbuffer(t, xml.c_str(), static_cast<int>(xml.size()) + 1);
    });
    MachineView machine = viewOf(topology.get(), kFacts);
    EXPECT_EQ(machine.numaNodes, 2);
    ASSERT_EQ(machine.devices.size(), 4u);
    EXPECT_EQ(machine.devices[0].name, "PCI 0000:01:00.0");
    EXPECT_EQ(machine.devices[0].cpus, (std::set<unsigned>{0, 1}));
    EXPECT_EQ(machine.devices[0].rank, 0);

    machine.allowedCpus = {0, 1, 2, 3};
    EXPECT_EQ(choosePlacement(machine, DeviceKind::Gpu).description, "on cores 2-3, near PCI 0000:81:00.0 (of 2)");
    EXPECT_EQ(choosePlacement(machine, DeviceKind::Network).description, "on cores 2-3, near ib0 (of 2)");
}

TEST(MachineView, marksInterfacesThatAreDownAsUnusable) {
    const std::string xml = twoPackagesXml(2);
    const Topology topology = load([&](hwloc_topology_t t) {
        return hwloc_topology_set_xmlbuffer(t, xml.c_str(), static_cast<int>(xml.size()) + 1);
    });
    DeviceFacts facts = kFacts;
    facts.linkMbitPerSec = [](const std::string& name) { return name == "ib0" ? 0 : 1000; };
    MachineView machine = viewOf(topology.get(), facts);
    machine.allowedCpus = {0, 1, 2, 3};
    EXPECT_EQ(choosePlacement(machine, DeviceKind::Network).description, "on cores 0-1, near eth0");
}

TEST(MachineView, supportsMachinesWithoutDevices) {
    const Topology topology =
        load([](hwloc_topology_t t) { return hwloc_topology_set_synthetic(t, "numa:4 core:2 pu:2"); });
    const MachineView machine = viewOf(topology.get(), kFacts);
    EXPECT_EQ(machine.numaNodes, 4);
    EXPECT_TRUE(machine.devices.empty());
}

} // namespace
} // namespace mural
