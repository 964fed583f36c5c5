#include "transport/connection_description.hpp"

#include <gtest/gtest.h>

namespace mural {

using Kind = ConnectionDescription::Kind;

TEST(ConnectionDescription, readsWhatItWrites) {
    const ConnectionDescription all[] = {
        {},
        {.kind = Kind::SharedMemory, .host = {}},
        {.kind = Kind::SharedMemory, .host = {}, .descriptor = 17},
        {.kind = Kind::Tcp, .host = "wall-3.example.org", .port = 65535},
        {.kind = Kind::Tcp, .host = "192.168.0.1", .port = 1},
        {.kind = Kind::Tcp, .host = "fe80::1%eth0", .port = 4000},
        {.kind = Kind::Tcp, .host = "", .port = 0},
    };
    for (const auto& each : all) {
        const auto back = parseConnectionDescription(toText(each));
        ASSERT_TRUE(back) << toText(each) << ": " << back.error().message;
        EXPECT_EQ(back.value(), each) << toText(each);
    }
}

TEST(ConnectionDescription, refusesWithTheReason) {
    const std::pair<const char*, const char*> all[] = {
        {"", "unknown kind"},
        {"udp://a:1", "unknown kind"},
        {"tcp:/host:1", "unknown kind"},
        {"pipe:x", "unknown kind"},
        {"tcp://host", "port is missing"},
        {"tcp://host:", "0 to 65535"},
        {"tcp://host:65536", "0 to 65535"},
        {"tcp://host:-1", "0 to 65535"},
        {"tcp://host:12x", "0 to 65535"},
        {"tcp://::1:80", "brackets"},
        {"tcp://[]:80", "brackets"},
        {"tcp://[::1:80", "brackets"},
        {"tcp://user@host:80", "character"},
        {"shm:x", "descriptor"},
        {"shm:-1", "descriptor"},
        {"rsp://239.0.0.1:5000", "not in this build"},
    };
    for (const auto& [text, reason] : all) {
        const auto result = parseConnectionDescription(text);
        ASSERT_FALSE(result) << text;
        EXPECT_NE(result.error().message.find(reason), std::string::npos) << result.error().message;
    }
}

TEST(ConnectionDescription, connectsOnlyToWhatHasAnOtherEnd) {
    for (const char* text : {"pipe:", "shm:", "tcp://:80", "tcp://localhost:0", "nonsense"}) {
        EXPECT_FALSE(connectTo(text, Deadline::inMs(100))) << text;
    }
    EXPECT_FALSE(listenAt("shm:"));
}

TEST(ConnectionDescription, listensAndConnectsByText) {
    auto listener = listenAt("tcp://localhost:0");
    ASSERT_TRUE(listener) << listener.error().message;
    auto connection = connectTo((*listener)->describe(), Deadline::inMs(5000));
    ASSERT_TRUE(connection) << connection.error().message;
    EXPECT_EQ((*connection)->describe(), (*listener)->describe());
}

} // namespace mural
