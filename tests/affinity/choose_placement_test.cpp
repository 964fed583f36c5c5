// The choice of cores near GPU and network interface.
#include <gtest/gtest.h>

#include "nodes/affinity/machine_view.hpp"

namespace mural {
namespace {

// Returns two NUMA nodes of four cores, a management card's display, a GPU, and three network interfaces.
MachineView twoSockets() {
    MachineView m;
    m.numaNodes = 2;
    m.allowedCpus = {0, 1, 2, 3, 4, 5, 6, 7};
    const std::set<unsigned> left = {0, 1, 2, 3};
    const std::set<unsigned> right = {4, 5, 6, 7};
    m.devices = {{DeviceKind::Gpu, "PCI 0000:02:00.0", 0, true, left},
                 {DeviceKind::Gpu, "PCI 0000:81:00.0", 1, true, right},
                 {DeviceKind::Network, "eth0", 1000, true, left},
                 {DeviceKind::Network, "eth1", 100000, true, right},
                 {DeviceKind::Network, "eth2", 0, false, left}};
    return m;
}

TEST(ChoosePlacement, takesTheGpuThatRenders) {
    const auto choice = choosePlacement(twoSockets(), DeviceKind::Gpu);
    EXPECT_EQ(choice.cpus, (std::set<unsigned>{4, 5, 6, 7}));
    EXPECT_EQ(choice.description, "on cores 4-7, near PCI 0000:81:00.0 (of 2)");
}

TEST(ChoosePlacement, takesTheFastestInterfaceThatIsUp) {
    MachineView m = twoSockets();
    EXPECT_EQ(choosePlacement(m, DeviceKind::Network).cpus, (std::set<unsigned>{4, 5, 6, 7}));
    m.devices[3].usable = false;
    EXPECT_EQ(choosePlacement(m, DeviceKind::Network).description, "on cores 0-3, near eth0");
}

TEST(ChoosePlacement, takesTheFirstOfEquals) {
    MachineView m = twoSockets();
    m.devices[0].rank = 1;
    EXPECT_EQ(choosePlacement(m, DeviceKind::Gpu).cpus, (std::set<unsigned>{0, 1, 2, 3}));
}

TEST(ChoosePlacement, staysWithinTheAllowedCores) {
    MachineView m = twoSockets();
    m.allowedCpus = {1, 4, 6, 7};
    const auto choice = choosePlacement(m, DeviceKind::Gpu);
    EXPECT_EQ(choice.cpus, (std::set<unsigned>{4, 6, 7}));
    EXPECT_EQ(choice.description, "on cores 4,6-7, near PCI 0000:81:00.0 (of 2)");
}

TEST(ChoosePlacement, keepsPlacementsThatCannotImprove) {
    MachineView m = twoSockets();
    m.allowedCpus = {0, 1};
    EXPECT_EQ(choosePlacement(m, DeviceKind::Gpu).description,
              "not placed: no core close to PCI 0000:81:00.0 (of 2) may be used");
    m.allowedCpus = {4, 5};
    const auto near = choosePlacement(m, DeviceKind::Gpu);
    EXPECT_TRUE(near.cpus.empty());
    EXPECT_EQ(near.description, "not placed: all cores that may be used are close to PCI 0000:81:00.0 (of 2)");
}

TEST(ChoosePlacement, reportsThatThereIsNothingToChoose) {
    MachineView m = twoSockets();
    m.devices.clear();
    EXPECT_EQ(choosePlacement(m, DeviceKind::Gpu).description, "not placed: no GPU found");
    EXPECT_EQ(choosePlacement(m, DeviceKind::Network).description, "not placed: no network interface that is up found");
    m = twoSockets();
    m.numaNodes = 1;
    EXPECT_EQ(choosePlacement(m, DeviceKind::Gpu).description, "not placed: one NUMA node");
    EXPECT_TRUE(choosePlacement(m, DeviceKind::Gpu).cpus.empty());
}

} // namespace
} // namespace mural
