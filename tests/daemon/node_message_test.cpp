// Encoding of the messages between a head and a daemon (mural node --wait).
#include "nodes/daemon/node_message.hpp"

#include <gtest/gtest.h>

#include "nodes/daemon/remote_command.hpp"

namespace mural {
namespace {

using Arguments = std::vector<std::string>;

TEST(NodeMessage, decodesItsOwnEncoding) {
    const Arguments arguments{"node", "", "--connect", "wall0:4711"};
    const auto message = decodeNodeMessage(encode(commandMessage(arguments)));
    ASSERT_TRUE(message);
    EXPECT_EQ(commandArguments(*message), arguments);
}

TEST(NodeMessage, rejectsLengthsOutOfBounds) {
    EXPECT_FALSE(decodeNodeMessage({}));
    const std::vector<std::byte> unknown{std::byte{7}};
    EXPECT_FALSE(decodeNodeMessage(unknown));
    EXPECT_FALSE(decodeNodeMessage(std::vector<std::byte>(kMaxNodeMessageBytes + 2)));
    EXPECT_FALSE(commandArguments(commandMessage({})));
    EXPECT_FALSE(commandArguments(commandMessage(Arguments(kMaxCommandArguments + 1, "x"))));
    EXPECT_FALSE(commandArguments(commandMessage({std::string(kMaxCommandBytes, 'x')})));
    NodeMessage cut = commandMessage({"node"});
    cut.body.pop_back();
    EXPECT_FALSE(commandArguments(cut));
    EXPECT_FALSE(commandArguments(textMessage(NodeMessageKind::Input, std::string("node\0", 5))));
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
