#include "nodes/placement/machine_view.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace mural {
namespace {

using Topology = std::unique_ptr<hwloc_topology, decltype(&hwloc_topology_destroy)>;

// Two packages of two cores. The second has a GPU (3D controller) and a network card, the first the
// display of its management card and a slower network card.
constexpr const char* kTwoPackages = R"(<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE topology SYSTEM "hwloc2.dtd">
<topology version="2.0">
 <object type="Machine" os_index="0" cpuset="0x0000000f" complete_cpuset="0x0000000f" allowed_cpuset="0x0000000f" nodeset="0x00000003" complete_nodeset="0x00000003" allowed_nodeset="0x00000003" gp_index="1">
  <object type="Package" os_index="0" cpuset="0x00000003" complete_cpuset="0x00000003" nodeset="0x00000001" complete_nodeset="0x00000001" gp_index="2">
   <object type="NUMANode" os_index="0" cpuset="0x00000003" complete_cpuset="0x00000003" nodeset="0x00000001" complete_nodeset="0x00000001" gp_index="3" local_memory="1073741824"/>
   <object type="PU" os_index="0" cpuset="0x00000001" complete_cpuset="0x00000001" nodeset="0x00000001" complete_nodeset="0x00000001" gp_index="4"/>
   <object type="PU" os_index="1" cpuset="0x00000002" complete_cpuset="0x00000002" nodeset="0x00000001" complete_nodeset="0x00000001" gp_index="5"/>
   <object type="Bridge" gp_index="6" bridge_type="0-1" depth="0" bridge_pci="0000:[00-02]">
    <object type="PCIDev" gp_index="7" pci_busid="0000:01:00.0" pci_type="0300 [1a03:2000] [0000:0000] 41" pci_link_speed="0.000000"/>
    <object type="PCIDev" gp_index="8" pci_busid="0000:02:00.0" pci_type="0200 [8086:1521] [8086:1521] 01" pci_link_speed="0.000000">
     <object type="OSDev" gp_index="9" name="eth0" osdev_type="2"/>
    </object>
   </object>
  </object>
  <object type="Package" os_index="1" cpuset="0x0000000c" complete_cpuset="0x0000000c" nodeset="0x00000002" complete_nodeset="0x00000002" gp_index="10">
   <object type="NUMANode" os_index="1" cpuset="0x0000000c" complete_cpuset="0x0000000c" nodeset="0x00000002" complete_nodeset="0x00000002" gp_index="11" local_memory="1073741824"/>
   <object type="PU" os_index="2" cpuset="0x00000004" complete_cpuset="0x00000004" nodeset="0x00000002" complete_nodeset="0x00000002" gp_index="12"/>
   <object type="PU" os_index="3" cpuset="0x00000008" complete_cpuset="0x00000008" nodeset="0x00000002" complete_nodeset="0x00000002" gp_index="13"/>
   <object type="Bridge" gp_index="14" bridge_type="0-1" depth="0" bridge_pci="0000:[80-82]">
    <object type="PCIDev" gp_index="15" pci_busid="0000:81:00.0" pci_type="0302 [10de:2330] [10de:16c1] a1" pci_link_speed="0.000000"/>
    <object type="PCIDev" gp_index="16" pci_busid="0000:82:00.0" pci_type="0200 [15b3:101d] [15b3:0016] 00" pci_link_speed="0.000000">
     <object type="OSDev" gp_index="17" name="ib0" osdev_type="2"/>
    </object>
   </object>
  </object>
 </object>
</topology>
)";

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
    const std::string xml = kTwoPackages;
    const Topology topology = load([&](hwloc_topology_t t) { return hwloc_topology_set_xmlbuffer(t, xml.c_str(), static_cast<int>(xml.size()) + 1); });
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

TEST(MachineView, interfacesThatAreDownAreNotUsable) {
    const std::string xml = kTwoPackages;
    const Topology topology = load([&](hwloc_topology_t t) { return hwloc_topology_set_xmlbuffer(t, xml.c_str(), static_cast<int>(xml.size()) + 1); });
    DeviceFacts facts = kFacts;
    facts.linkMbitPerSec = [](const std::string& name) { return name == "ib0" ? 0 : 1000; };
    MachineView machine = viewOf(topology.get(), facts);
    machine.allowedCpus = {0, 1, 2, 3};
    EXPECT_EQ(choosePlacement(machine, DeviceKind::Network).description, "on cores 0-1, near eth0");
}

TEST(MachineView, machinesWithoutDevices) {
    const Topology topology = load([](hwloc_topology_t t) { return hwloc_topology_set_synthetic(t, "numa:4 core:2 pu:2"); });
    const MachineView machine = viewOf(topology.get(), kFacts);
    EXPECT_EQ(machine.numaNodes, 4);
    EXPECT_TRUE(machine.devices.empty());
}

} // namespace
} // namespace mural
