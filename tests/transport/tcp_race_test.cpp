// Parallel connection attempts to several addresses of a host.
#include "transport/tcp/tcp_race.hpp"

#include <gtest/gtest.h>

#include <array>
#include <sys/socket.h>

namespace mural {
namespace {

// A bound TCP port on the loopback interface. Without a listener it refuses connections.
struct Port {
    FileDescriptor socket;
    TcpAddress address;
};
Port portThat(bool listens, int backlog = 8) {
    auto any = resolveTcp("127.0.0.1", 0, TcpRole::Listen, Deadline::inMs(1000));
    EXPECT_TRUE(any) << any.error().message;
    Port port{FileDescriptor(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)), {}};
    EXPECT_EQ(bind(port.socket.get(), any->front().get(), any->front().sizeBytes), 0);
    if (listens) {
        EXPECT_EQ(listen(port.socket.get(), backlog), 0);
    }
    port.address = localTcpAddress(port.socket.get());
    return port;
}

TEST(TcpRace, usesTheAddressThatAnswers) {
    const Port deaf = portThat(false);
    const Port good = portThat(true);
    const std::array addresses{deaf.address, good.address};
    auto socket = connectRacing(addresses, Deadline::inMs(5000));
    ASSERT_TRUE(socket) << socket.error().message;
    EXPECT_TRUE(sameTcpAddress(peerTcpAddress(socket->get()), good.address));
}

TEST(TcpRace, failsAtOnceWhenAllRefuse) {
    const Port deaf = portThat(false);
    const std::array addresses{deaf.address, deaf.address};
    const int64_t began = monotonicNowNs();
    auto socket = connectRacing(addresses, Deadline::inMs(60'000));
    ASSERT_FALSE(socket);
    EXPECT_NE(socket.error().message.find("listens"), std::string::npos) << socket.error().message;
    EXPECT_LT(monotonicNowNs() - began, 30 * kNsPerS);
}

// A full backlog drops requests, as a bad network does.
TEST(TcpRace, isNotDelayedByALostRequest) {
    const Port full = portThat(true, 0);
    const Port good = portThat(true);
    const std::array one{full.address};
    std::vector<FileDescriptor> fill;
    while (true) {
        auto socket = connectRacing(one, Deadline::inMs(300));
        if (!socket) break;
        fill.push_back(std::move(*socket));
        ASSERT_LT(fill.size(), 64u);
    }
    const std::array addresses{full.address, good.address};
    auto socket = connectRacing(addresses, Deadline::inMs(20'000));
    ASSERT_TRUE(socket) << socket.error().message;
    EXPECT_TRUE(sameTcpAddress(peerTcpAddress(socket->get()), good.address));
    const auto none = connectRacing(one, Deadline::inMs(300));
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("deadline"), std::string::npos) << none.error().message;
}

TEST(TcpRace, failsWithoutAnAddress) { EXPECT_FALSE(connectRacing({}, Deadline::inMs(100))); }

} // namespace
} // namespace mural
