#include <gtest/gtest.h>
#include <sched.h>

#include <thread>

#include "nodes/placement/placement.hpp"

namespace mural {
namespace {

cpu_set_t coresOfThisThread() {
    cpu_set_t cores;
    CPU_ZERO(&cores);
    sched_getaffinity(0, sizeof cores, &cores);
    return cores;
}

// On this machine, whatever it is: a thread is moved exactly when that is said, never outwards, and
// no other thread moves with it.
TEST(PlaceThread, saysWhatItDoes) {
    const cpu_set_t before = coresOfThisThread();
    for (const DeviceKind kind : {DeviceKind::Gpu, DeviceKind::Network}) {
        std::thread([&] {
            const Placement placement = placeThread(kind);
            const cpu_set_t after = coresOfThisThread();
            cpu_set_t both;
            CPU_AND(&both, &before, &after);
            EXPECT_TRUE(CPU_EQUAL(&both, &after));
            EXPECT_EQ(placement.bound, CPU_EQUAL(&before, &after) == 0) << placement.description;
            EXPECT_EQ(placement.description.rfind(placement.bound ? "on cores " : "not placed: ", 0), 0u) << placement.description;
        }).join();
    }
    const cpu_set_t afterwards = coresOfThisThread();
    EXPECT_TRUE(CPU_EQUAL(&before, &afterwards));
}

} // namespace
} // namespace mural
