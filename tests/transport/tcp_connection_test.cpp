// TCP connections: addresses, deadlines, errors.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "transport/connect.hpp"
#include "transport/connection_description.hpp"
#include "transport/tcp/tcp_address.hpp"

namespace mural {

namespace {

Deadline late() { return Deadline::inMs(20000); }

// Sends one byte in each direction.
void expectTalk(Listener& listener, const std::string& description) {
    auto a = connectTo(description, late());
    ASSERT_TRUE(a) << a.error().message;
    auto b = listener.accept(late());
    ASSERT_TRUE(b) << b.error().message;
    const std::byte out{9};
    std::byte in{};
    ASSERT_TRUE((*a)->write(std::span(&out, 1), late()));
    (*a)->flush();
    ASSERT_TRUE((*b)->read(std::span(&in, 1), late()));
    EXPECT_EQ(in, out);
}

bool hasIpv6() {
    const int fd = socket(AF_INET6, SOCK_STREAM, 0);
    if (fd >= 0) close(fd);
    return fd >= 0 && listenTcp("::1", 0).ok();
}

// A port without a listener: one that was free a moment ago.
uint16_t closedPort() {
    auto listener = listenTcp("127.0.0.1", 0);
    return parseConnectionDescription((*listener)->describe()).value().port;
}

} // namespace

TEST(TcpConnection, connectsOverIpv4) {
    auto listener = listenTcp("127.0.0.1", 0);
    ASSERT_TRUE(listener) << listener.error().message;
    EXPECT_TRUE((*listener)->describe().starts_with("tcp://127.0.0.1:"));
    expectTalk(**listener, (*listener)->describe());
}

TEST(TcpConnection, connectsOverIpv6) {
    if (!hasIpv6()) GTEST_SKIP() << "this machine has no IPv6 loopback";
    auto listener = listenTcp("::1", 0);
    ASSERT_TRUE(listener) << listener.error().message;
    EXPECT_TRUE((*listener)->describe().starts_with("tcp://[::1]:")) << (*listener)->describe();
    expectTalk(**listener, (*listener)->describe());
}

TEST(TcpConnection, connectsByName) {
    auto listener = listenTcp("localhost", 0);
    ASSERT_TRUE(listener) << listener.error().message;
    const uint16_t port = parseConnectionDescription((*listener)->describe()).value().port;
    expectTalk(**listener, tcpText("localhost", port));
}

TEST(TcpConnection, reportsAHostNameWhenListeningOnAllAddresses) {
    for (const char* everywhere : {"", "*"}) {
        auto listener = listenTcp(everywhere, 0);
        ASSERT_TRUE(listener) << listener.error().message;
        const auto description = parseConnectionDescription((*listener)->describe());
        ASSERT_TRUE(description) << description.error().message;
        EXPECT_NE(description.value().port, 0);
        char name[256] = "";
        gethostname(name, sizeof name - 1);
        EXPECT_EQ(description.value().host, name);
        expectTalk(**listener, tcpText("127.0.0.1", description.value().port));
        if (hasIpv6()) expectTalk(**listener, tcpText("::1", description.value().port));
    }
}

TEST(TcpConnection, explainsAFailedConnect) {
    const uint16_t port = closedPort();
    const auto refused = connectTcp("127.0.0.1", port, late());
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find(tcpText("127.0.0.1", port) + ": cannot connect"), std::string::npos)
        << refused.error().message;
    const auto unknown = connectTcp("no-such-host.invalid", 80, late());
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message.find("cannot resolve the host"), std::string::npos) << unknown.error().message;
}

// With a full backlog further connects hang, as with a silent host.
TEST(TcpConnection, keepsTheDeadlineOfConnect) {
    const int silent = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in any{};
    any.sin_family = AF_INET;
    any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ASSERT_EQ(bind(silent, reinterpret_cast<sockaddr*>(&any), sizeof any), 0);
    ASSERT_EQ(listen(silent, 0), 0);
    const uint16_t port = tcpPort(localTcpAddress(silent));
    std::vector<std::unique_ptr<Connection>> backlog;
    bool timedOut = false;
    for (int i = 0; i < 8 && !timedOut; ++i) {
        auto connection = connectTcp("127.0.0.1", port, Deadline::inMs(50));
        timedOut = !connection;
        if (connection) {
            backlog.push_back(std::move(*connection));
        } else {
            EXPECT_NE(connection.error().message.find("deadline passed"), std::string::npos)
                << connection.error().message;
        }
    }
    EXPECT_TRUE(timedOut);
    close(silent);
}

TEST(TcpConnection, keepsTheDeadlineOfAccept) {
    auto listener = listenTcp("127.0.0.1", 0);
    ASSERT_TRUE(listener);
    const auto nobody = (*listener)->accept(Deadline::inMs(30));
    ASSERT_FALSE(nobody);
    EXPECT_NE(nobody.error().message.find("without a connection"), std::string::npos);
    expectTalk(**listener, (*listener)->describe());
}

TEST(TcpConnection, failsToListenOnATakenPort) {
    auto listener = listenTcp("127.0.0.1", 0);
    ASSERT_TRUE(listener);
    const uint16_t port = parseConnectionDescription((*listener)->describe()).value().port;
    const auto second = listenTcp("127.0.0.1", port);
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("cannot listen"), std::string::npos) << second.error().message;
    EXPECT_FALSE(listenTcp("192.0.2.1", 0)) << "an address of nobody";
}

TEST(TcpConnection, buffersSmallWritesUntilFlush) {
    auto listener = listenTcp("127.0.0.1", 0);
    ASSERT_TRUE(listener);
    auto a = connectTo((*listener)->describe(), late());
    auto b = (*listener)->accept(late());
    ASSERT_TRUE(a && b);
    const std::byte out{1};
    std::byte in{};
    ASSERT_TRUE((*a)->write(std::span(&out, 1), late()));
    EXPECT_FALSE((*b)->read(std::span(&in, 1), Deadline::inMs(20)));
    EXPECT_TRUE((*b)->timedOut());
    (*a)->flush();
    EXPECT_TRUE((*b)->read(std::span(&in, 1), late()));
}

TEST(TcpConnection, survivesAForkedCopy) {
    auto listener = listenTcp("127.0.0.1", 0);
    ASSERT_TRUE(listener);
    auto a = connectTo((*listener)->describe(), late());
    auto b = (*listener)->accept(late());
    ASSERT_TRUE(a && b);
    const pid_t child = fork();
    if (child == 0) {
        a->reset();
        b->reset();
        _exit(0);
    }
    ASSERT_EQ(waitpid(child, nullptr, 0), child);
    EXPECT_TRUE((*a)->alive() && (*b)->alive());
    const std::byte out{1};
    std::byte in{};
    ASSERT_TRUE((*a)->write(std::span(&out, 1), late()));
    (*a)->flush();
    EXPECT_TRUE((*b)->read(std::span(&in, 1), late()));
}

} // namespace mural
