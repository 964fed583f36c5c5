// The table of discovered nodes.
#include "transport/discovery/node_table.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

Announcement node(uint8_t number, const std::string& name, AnnouncementKind kind = AnnouncementKind::Here) {
    Announcement a{kind, 4278, {}, name, "0.1.0"};
    a.uuid[0] = std::byte{number};
    return a;
}

TEST(NodeTable, listsANodeOnce) {
    NodeTable table;
    table.onBeacon(node(1, "wall1"), "10.0.0.1", 0);
    table.onBeacon(node(1, "wall1"), "10.0.0.1", 1);
    table.onBeacon(node(1, "wall1"), "fe80::1%eth0", 1);
    table.foundByAvahi(node(1, "wall1"), "10.0.0.1");
    table.onBeacon(node(2, "lab"), "10.0.0.2", 1);
    table.onBeacon(node(3, "nobody", AnnouncementKind::Search), "10.0.0.3", 1);
    const auto nodes = table.nodes();
    ASSERT_EQ(nodes.size(), 2u);
    EXPECT_EQ(nodes[0].name, "lab");
    EXPECT_EQ(nodes[1].addresses, (std::vector<std::string>{"10.0.0.1", "fe80::1%eth0"}));
    EXPECT_TRUE(nodes[1].byBeacon && nodes[1].byAvahi);
}

TEST(NodeTable, removesSilentAndLeavingNodes) {
    NodeTable table;
    table.onBeacon(node(1, "silent"), "10.0.0.1", 0);
    table.onBeacon(node(2, "gone"), "10.0.0.2", 0);
    table.onBeacon(node(3, "both"), "10.0.0.3", 0);
    table.foundByAvahi(node(3, "both"), "10.0.0.3");
    table.onBeacon(node(2, "gone", AnnouncementKind::Gone), "10.0.0.2", 1);
    EXPECT_EQ(table.nodes().size(), 2u);
    table.expire(NodeTable::kSilentNs);
    EXPECT_EQ(table.nodes().size(), 2u);
    table.expire(NodeTable::kSilentNs + 1);
    ASSERT_EQ(table.nodes().size(), 1u);
    EXPECT_EQ(table.nodes()[0].name, "both");
    EXPECT_FALSE(table.nodes()[0].byBeacon);
    table.lostByAvahi(node(3, "both").uuid);
    EXPECT_TRUE(table.nodes().empty());
}

TEST(NodeTable, updatesTheAddressOfARestartedNode) {
    NodeTable table;
    table.onBeacon(node(1, "wall1"), "10.0.0.1", 0);
    Announcement again = node(1, "wall1");
    again.port = 9999;
    table.onBeacon(again, "10.0.0.7", 1);
    EXPECT_EQ(table.nodes()[0].port, 9999);
    EXPECT_EQ(table.nodes()[0].addresses, std::vector<std::string>{"10.0.0.7"});
}

TEST(NodeTable, limitsTheNumberOfNodes) {
    NodeTable table;
    for (unsigned i = 0; i < 5000; ++i) {
        Announcement a = node(0, "x");
        a.uuid[1] = static_cast<std::byte>(i);
        a.uuid[2] = static_cast<std::byte>(i >> 8);
        table.onBeacon(a, "10.0.0.1", 0);
    }
    EXPECT_EQ(table.nodes().size(), NodeTable::kMaxNodes);
    for (unsigned i = 0; i < 100; ++i) table.onBeacon(node(0, "x"), "10.0.1." + std::to_string(i), 0);
    EXPECT_EQ(table.nodes()[0].addresses.size(), NodeTable::kMaxAddresses);
}

} // namespace
} // namespace mural
