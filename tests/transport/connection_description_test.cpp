// Connections as text: parsing, errors, connecting.
#include "transport/connection_description.hpp"

#include <gtest/gtest.h>

#include "transport/connect.hpp"
#include "transport/rsp/group_description.hpp"

namespace mural {

using Kind = ConnectionDescription::Kind;

TEST(ConnectionDescription, parsesItsOwnOutput) {
    const ConnectionDescription all[] = {
        {},
        {.kind = Kind::SharedMemory, .host = {}},
        {.kind = Kind::SharedMemory, .host = {}, .descriptor = 17},
        {.kind = Kind::Tcp, .host = "wall-3.example.org", .port = 65535},
        {.kind = Kind::Tcp, .host = "192.168.0.1", .port = 1},
        {.kind = Kind::Tcp, .host = "fe80::1%eth0", .port = 4000},
        {.kind = Kind::Tcp, .host = "", .port = 0},
        {.kind = Kind::Rsp, .host = "239.255.77.85", .port = 4277},
        {.kind = Kind::Rsp,
         .host = "ff15::4d:1",
         .port = 4277,
         .parameters = {{"interface", "eth1"}, {"rate", "800mbit"}}},
        {.kind = Kind::Plugin, .host = "::1", .port = 4000, .parameters = {{"provider", "tcp"}}, .scheme = "fabric"},
    };
    for (const auto& each : all) {
        const auto back = parseConnectionDescription(toText(each));
        ASSERT_TRUE(back) << toText(each) << ": " << back.error().message;
        EXPECT_EQ(back.value(), each) << toText(each);
    }
}

TEST(ConnectionDescription, rejectsInvalidTextWithAReason) {
    const std::pair<const char*, const char*> all[] = {
        {"", "unknown kind"},
        {"Udp://a:1", "unknown kind"},
        {"://a:1", "unknown kind"},
        {"../x://a:1", "unknown kind"},
        {"udp://a", "port is missing"},
        {"udp://a:1?b", "name=value"},
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
        {"rsp:239.0.0.1:5000", "unknown kind"},
        {"rsp://239.0.0.1", "port is missing"},
        {"rsp://:5000", "address is missing"},
        {"rsp://239.0.0.1:5000?rate", "name=value"},
        {"rsp://239.0.0.1:5000?rate=1gbit&rate=2gbit", "twice"},
    };
    for (const auto& [text, reason] : all) {
        const auto result = parseConnectionDescription(text);
        ASSERT_FALSE(result) << text;
        EXPECT_NE(result.error().message.find(reason), std::string::npos) << result.error().message;
    }
}

TEST(ConnectionDescription, parsesGroupParameters) {
    const auto options = [](const char* text) { return rsp::groupOptionsOf(parseConnectionDescription(text).value()); };
    auto good = options("rsp://"
                        "239.0.0.1:5000?interface=eth1&rate=800mbit&seal=siphash&stalled=wait&stalled-ms=70&window=128&"
                        "multicast=off&parity=off");
    ASSERT_TRUE(good) << good.error().message;
    EXPECT_EQ(good->group, "239.0.0.1:5000");
    EXPECT_EQ(good->interface, "eth1");
    EXPECT_EQ(good->bytesPerS, 100e6);
    EXPECT_EQ(good->seal, rsp::Seal::Tag);
    EXPECT_EQ(good->stalled, rsp::StallPolicy::Wait);
    EXPECT_EQ(good->stalledMs, 70);
    EXPECT_EQ(good->windowDatagrams, 128u);
    EXPECT_FALSE(good->multicast);
    EXPECT_FALSE(good->parity);
    const std::pair<const char*, const char*> bad[] = {
        {"rsp://10.0.0.1:5000", "not a multicast address"},
        {"rsp://wall:5000", "wall"},
        {"rsp://239.0.0.1:5000?speed=1", "unknown parameter \"speed\"; use control, datagram"},
        {"rsp://239.0.0.1:5000?rate=fast", "rate: \"fast\""},
        {"rsp://239.0.0.1:5000?window=100", "power of two"},
        {"rsp://239.0.0.1:5000?silent-ms=-1", "silent-ms: \"-1\" must be"},
        {"rsp://239.0.0.1:5000?parity=yes", "on or off"},
        {"rsp://239.0.0.1:5000?secret=/nowhere/at/all", "/nowhere/at/all"},
    };
    for (const auto& [text, reason] : bad) {
        const auto result = options(text);
        ASSERT_FALSE(result) << text;
        EXPECT_NE(result.error().message.find(reason), std::string::npos) << result.error().message;
    }
}

TEST(ConnectionDescription, failsToConnectWithoutAPeer) {
    for (const char* text :
         {"pipe:", "shm:", "tcp://:80", "tcp://localhost:0", "nonsense", "rsp://239.0.0.1:5000", "nobodyhas://a:1"}) {
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
