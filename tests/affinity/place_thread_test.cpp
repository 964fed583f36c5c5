// Binding of a thread to the cores near a device.
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "display_listener.hpp"
#include "nodes/affinity/placement.hpp"
#include "two_packages.hpp"

namespace mural {
namespace {

cpu_set_t coresOfThisThread() {
    cpu_set_t cores;
    CPU_ZERO(&cores);
    sched_getaffinity(0, sizeof cores, &cores);
    return cores;
}

// Runs on any machine: the thread moves exactly when the result says so, never outside its allowed cores, and no other
// thread moves.
TEST(PlaceThread, reportsItsChanges) {
    const cpu_set_t before = coresOfThisThread();
    for (const DeviceKind kind : {DeviceKind::Gpu, DeviceKind::Network}) {
        std::thread([&] {
            const Placement placement = placeThread(kind);
            const cpu_set_t after = coresOfThisThread();
            cpu_set_t both;
            CPU_AND(&both, &before, &after);
            EXPECT_TRUE(CPU_EQUAL(&both, &after));
            EXPECT_EQ(placement.bound, CPU_EQUAL(&before, &after) == 0) << placement.description;
            EXPECT_EQ(placement.description.rfind(placement.bound ? "on cores " : "not placed: ", 0), 0u)
                << placement.description;
        }).join();
    }
    const cpu_set_t afterwards = coresOfThisThread();
    EXPECT_TRUE(CPU_EQUAL(&before, &afterwards));
}

// Displays belong to other users, and Xlib ends the process when its display ends.
TEST(PlaceThread, connectsToNoDisplay) {
    const DisplayListener display;
    if (!display.listens()) GTEST_SKIP() << "the displays :0 to :9 are all in use here";
    for (const DeviceKind kind : {DeviceKind::Gpu, DeviceKind::Network}) std::thread([&] { placeThread(kind); }).join();
    EXPECT_EQ(display.callers(), 0);
}

// hwloc reads a topology in which core 0 and core 1 are two NUMA nodes. The GPUs cannot be distinguished by their bus,
// so the first is chosen, on core 0.
TEST(PlaceThread, bindsToTheCoresNearTheDevice) {
    const cpu_set_t before = coresOfThisThread();
    if (!CPU_ISSET(0, &before) || !CPU_ISSET(1, &before)) GTEST_SKIP() << "cores 0 and 1 may not be used here";
    const std::string path = testing::TempDir() + "mural_placement_" + std::to_string(getpid()) + ".xml";
    std::ofstream(path) << twoPackagesXml(1);
    setenv("HWLOC_XMLFILE", path.c_str(), 1);
    setenv("HWLOC_THISSYSTEM", "1", 1);
    std::thread([] {
        const Placement placement = placeThread(DeviceKind::Gpu);
        EXPECT_TRUE(placement.bound);
        EXPECT_EQ(placement.description, "on cores 0, near PCI 0000:01:00.0 (of 2)");
        const cpu_set_t after = coresOfThisThread();
        EXPECT_EQ(CPU_COUNT(&after), 1);
        EXPECT_TRUE(CPU_ISSET(0, &after));
    }).join();
    unsetenv("HWLOC_XMLFILE");
    unsetenv("HWLOC_THISSYSTEM");
    std::remove(path.c_str());
}

} // namespace
} // namespace mural
