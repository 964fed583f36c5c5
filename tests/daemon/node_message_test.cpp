// Encoding of the messages between a head and a daemon (mural node --wait).
#include "nodes/daemon/node_message.hpp"

#include <gtest/gtest.h>

#include "nodes/daemon/remote_command.hpp"

namespace mural {
namespace {

using Arguments = std::vector<std::string>;

TEST(NodeMessage, decodesItsOwnEncoding) {
    const Arguments arguments{"node", "", "--connect", "wall0:4711"};
    const auto message = decodeNodeMessage(encode(orderMessage(arguments)));
    ASSERT_TRUE(message);
    EXPECT_EQ(orderArguments(*message), arguments);
}

TEST(NodeMessage, rejectsLengthsOutOfBounds) {
    EXPECT_FALSE(decodeNodeMessage({}));
    const std::vector<std::byte> unknown{std::byte{7}};
    EXPECT_FALSE(decodeNodeMessage(unknown));
    EXPECT_FALSE(decodeNodeMessage(std::vector<std::byte>(kMaxNodeMessageBytes + 2)));
    EXPECT_FALSE(orderArguments(orderMessage({})));
    EXPECT_FALSE(orderArguments(orderMessage(Arguments(kMaxOrderArguments + 1, "x"))));
    EXPECT_FALSE(orderArguments(orderMessage({std::string(kMaxOrderBytes, 'x')})));
    NodeMessage cut = orderMessage({"node"});
    cut.body.pop_back();
    EXPECT_FALSE(orderArguments(cut));
    EXPECT_FALSE(orderArguments(textMessage(NodeMessageKind::Input, std::string("node\0", 5))));
}

TEST(NodeMessage, permitsOnlyNodesInOrders) {
    EXPECT_TRUE(isAllowedCommand({"node", "--as", "node3", "--connect", "wall0:4711"}));
    EXPECT_TRUE(isAllowedCommand({"network-member"}));
    for (const Arguments& a : {Arguments{"run", "--", "sh"},
                               {"node"},
                               {"node", "--wait"},
                               {"node", "--connect", "wall0:4711"},
                               {"node", "--as", "x", "--connect", "--wait"},
                               {"node", "--as", "--wait", "--connect", "a:1"},
                               {"node", "--connect-fd", "3"},
                               {"node", "--as", "x", "--connect", "a:1", "x"},
                               {"network-member", "x"},
                               {"doctor"},
                               {}})
        EXPECT_FALSE(isAllowedCommand(a)) << (a.empty() ? "nothing" : a.front());
}

} // namespace
} // namespace mural
