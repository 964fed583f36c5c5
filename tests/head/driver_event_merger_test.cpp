// A driver event that all nodes report reaches the program once.
#include "nodes/head/results/driver_event_merger.hpp"
#include "streamcodec/wire/replies.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

wire::DriverEvent message(uint32_t client, uint32_t id) {
    return {client, 1, static_cast<uint32_t>(wire::DriverEventKind::DebugMessage), 2, 3, id, 4, 0};
}

TEST(DriverEventMerger, reportsAMessageOfAllNodesOnce) {
    DriverEventMerger merger;
    EXPECT_TRUE(merger.isNew(0, message(1, 10), "slow"));
    EXPECT_FALSE(merger.isNew(1, message(1, 20), "slow")); // ids differ between nodes
    EXPECT_FALSE(merger.isNew(2, message(1, 30), "slow"));
    EXPECT_TRUE(merger.isNew(1, message(1, 20), "slow")); // a second time, from any node
    EXPECT_FALSE(merger.isNew(0, message(1, 10), "slow"));
}

TEST(DriverEventMerger, distinguishesMessages) {
    DriverEventMerger merger;
    EXPECT_TRUE(merger.isNew(0, message(1, 1), "slow"));
    EXPECT_TRUE(merger.isNew(1, message(1, 1), "slower"));
    EXPECT_TRUE(merger.isNew(1, message(2, 1), "slow")); // another program
    merger.programGone(1);
    EXPECT_TRUE(merger.isNew(1, message(1, 1), "slow")); // its number belongs to another program now
    EXPECT_FALSE(merger.isNew(0, message(2, 1), "slow"));
}

} // namespace
} // namespace mural
