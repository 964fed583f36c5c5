// A daemon with a script in place of mural, and valid and invalid heads.
#include "nodes/daemon/node_daemon.hpp"

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <netinet/in.h>
#include <sys/eventfd.h>
#include <sys/stat.h>
#include <thread>

#include <gtest/gtest.h>

#include "nodes/daemon/channel_socket.hpp"
#include "transport/tcp/socket_address.hpp"
#include "transport/tcp/socket_wait.hpp"

namespace mural {
namespace {

constexpr int64_t kMs = 10'000;
const std::vector<std::string> kNode{"node", "--as", "node3", "--connect", "wall0:4711"};

// Prints its arguments and its process number, then each line of its input; the line "end" ends it.
constexpr const char* kScript = R"(#!/bin/sh
echo "$*"
echo "chat" >&2
echo $$ >"$(dirname "$0")/pid"
while read -r line; do
    [ "$line" = end ] && exit 7
    echo "heard $line"
done
exit 3
)";

class NodeDaemonTest : public testing::Test {
protected:
    NodeDaemonTest()
        : folder_(testing::TempDir() + "/mural_waiting_" + std::to_string(::getpid())), stop_(eventfd(0, EFD_CLOEXEC)) {
        std::filesystem::create_directories(folder_);
        std::ofstream(folder_ + "/mural") << kScript;
        ::chmod((folder_ + "/mural").c_str(), 0755);
        secret_[3] = std::byte{9};
        auto node = NodeDaemon::open({"127.0.0.1:0", secret_, folder_ + "/mural"});
        EXPECT_TRUE(node);
        node_ = std::move(*node);
        thread_ = std::thread([this] { EXPECT_TRUE(node_->serve(stop_.get())); });
    }
    ~NodeDaemonTest() override {
        stop();
        std::filesystem::remove_all(folder_);
    }
    void stop() {
        if (!thread_.joinable()) return;
        eventfd_write(stop_.get(), 1);
        thread_.join();
    }
    // Connects from 127.0.0.`host`.
    [[nodiscard]] FileDescriptor connect(int host) const {
        FileDescriptor fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
        auto from = numericAddress("127.0.0." + std::to_string(host), 0),
             to = numericAddress("127.0.0.1", node_->port());
        EXPECT_EQ(::bind(fd.get(), from->get(), from->sizeBytes), 0);
        (void)::connect(fd.get(), to->get(), to->sizeBytes);
        EXPECT_NE(waitForSocket(fd.get(), POLLOUT, Deadline::inMs(kMs)), 0);
        return fd;
    }
    [[nodiscard]] std::unique_ptr<ChannelSocket> head(int host, const ChannelSecret& secret,
                                                      const std::vector<std::string>& command) const {
        auto channel = std::make_unique<ChannelSocket>(connect(host), SecureChannel::connecting("head", secret));
        if (!channel->open(Deadline::inMs(kMs)) || !channel->send(commandMessage(command), Deadline::inMs(kMs)))
            return nullptr;
        return channel;
    }
    [[nodiscard]] std::unique_ptr<ChannelSocket> head(int host = 1) const { return head(host, secret_, kNode); }
    // Returns the texts of one kind until one contains `last`, or the channel ends.
    static std::string awaitMessage(ChannelSocket& channel, NodeMessageKind kind, const std::string& last) {
        std::string text;
        while (text.find(last) == std::string::npos) {
            auto m = channel.receive(Deadline::inMs(kMs));
            if (!m) return text + "|" + m.error().message;
            if (m->kind == kind) text += textOf(m->body);
        }
        return text;
    }
    [[nodiscard]] pid_t pid() const {
        pid_t number = 0;
        std::ifstream(folder_ + "/pid") >> number;
        return number;
    }
    static bool goneSoon(pid_t pid) {
        for (const Deadline soon = Deadline::inMs(kMs); !soon.passed(); poll(nullptr, 0, 10))
            if (::kill(pid, 0) != 0) return true;
        return false;
    }

    std::string folder_;
    ChannelSecret secret_{};
    FileDescriptor stop_;
    std::unique_ptr<NodeDaemon> node_;
    std::thread thread_;
};

TEST_F(NodeDaemonTest, runsCommandsAndReportsTheirEnd) {
    const auto channel = head();
    ASSERT_TRUE(channel);
    EXPECT_EQ(awaitMessage(*channel, NodeMessageKind::Output, "\n"), "node --as node3 --connect wall0:4711\n");
    ASSERT_TRUE(channel->send(textMessage(NodeMessageKind::Input, "hello\n"), Deadline::inMs(kMs)));
    EXPECT_EQ(awaitMessage(*channel, NodeMessageKind::Output, "\n"), "heard hello\n");
    ASSERT_TRUE(channel->send(textMessage(NodeMessageKind::Input, "end\n"), Deadline::inMs(kMs)));
    EXPECT_EQ(awaitMessage(*channel, NodeMessageKind::Ended, "7").substr(1), "exit status 7");
}

// The command and its input arrive in one piece; no byte may be lost.
TEST_F(NodeDaemonTest, passesOnInputThatArrivesWithTheCommand) {
    FileDescriptor fd = connect(1);
    SecureChannel secure = SecureChannel::connecting("head", secret_);
    const auto write = [&] {
        const auto bytes = secure.takeOutput();
        EXPECT_EQ(::send(fd.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
    };
    write();
    std::vector<std::vector<std::byte>> none;
    while (!secure.open()) {
        std::array<std::byte, 1024> piece;
        ASSERT_NE(waitForSocket(fd.get(), POLLIN, Deadline::inMs(kMs)), 0);
        const ssize_t n = ::recv(fd.get(), piece.data(), piece.size(), 0);
        ASSERT_GT(n, 0);
        ASSERT_TRUE(secure.input(std::span(piece).first(static_cast<size_t>(n)), none));
        write();
    }
    for (const NodeMessage& m : {commandMessage(kNode), textMessage(NodeMessageKind::Input, "early\n"),
                                 NodeMessage{NodeMessageKind::InputEnd, {}}})
        ASSERT_TRUE(secure.send(encode(m)));
    write();
    ChannelSocket channel(std::move(fd), std::move(secure));
    EXPECT_NE(awaitMessage(channel, NodeMessageKind::Output, "early").find("heard early"), std::string::npos);
    EXPECT_EQ(awaitMessage(channel, NodeMessageKind::Ended, "3").substr(1), "exit status 3");
}

TEST_F(NodeDaemonTest, sendsNothingToHeadsWithoutTheSecret) {
    ChannelSecret other = secret_;
    other[3] = std::byte{8};
    EXPECT_FALSE(head(1, other, kNode));
    EXPECT_FALSE(std::filesystem::exists(folder_ + "/pid"));
    EXPECT_TRUE(head()) << "and others are served";
}

TEST_F(NodeDaemonTest, runsOnlyNodes) {
    const auto channel = head(1, secret_, {"run", "--", "sh"});
    ASSERT_TRUE(channel);
    EXPECT_NE(awaitMessage(*channel, NodeMessageKind::Refused, "only").find("only render nodes"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder_ + "/pid"));
}

TEST_F(NodeDaemonTest, acceptsOneHeadAtATimeWithAllItsNodes) {
    auto first = head(1);
    ASSERT_TRUE(first);
    awaitMessage(*first, NodeMessageKind::Output, "\n");
    const auto second = head(1);
    ASSERT_TRUE(second);
    EXPECT_EQ(awaitMessage(*second, NodeMessageKind::Output, "\n"), "node --as node3 --connect wall0:4711\n");
    const auto stranger = head(2);
    ASSERT_TRUE(stranger);
    EXPECT_NE(awaitMessage(*stranger, NodeMessageKind::Refused, "another").find("another head"), std::string::npos);
    ASSERT_TRUE(first->send({NodeMessageKind::InputEnd, {}}, Deadline::inMs(kMs)));
    ASSERT_TRUE(second->send({NodeMessageKind::InputEnd, {}}, Deadline::inMs(kMs)));
    awaitMessage(*first, NodeMessageKind::Ended, "3");
    awaitMessage(*second, NodeMessageKind::Ended, "3");
    // The message about the end is sent a moment before the slot is free.
    std::string output;
    for (const Deadline soon = Deadline::inMs(kMs); !soon.passed() && output.empty();) {
        const auto next = head(2);
        ASSERT_TRUE(next);
        auto m = next->receive(Deadline::inMs(kMs));
        if (m && m->kind != NodeMessageKind::Refused) output = "served";
    }
    EXPECT_EQ(output, "served");
}

TEST_F(NodeDaemonTest, endsProcessesWithTheirHead) {
    auto channel = head();
    ASSERT_TRUE(channel);
    awaitMessage(*channel, NodeMessageKind::Output, "\n");
    for (const Deadline soon = Deadline::inMs(kMs); pid() == 0 && !soon.passed();) poll(nullptr, 0, 10);
    const pid_t started = pid();
    ASSERT_GT(started, 0);
    channel.reset();
    EXPECT_TRUE(goneSoon(started));
}

TEST_F(NodeDaemonTest, endsProcessesWithTheNode) {
    const auto channel = head();
    ASSERT_TRUE(channel);
    awaitMessage(*channel, NodeMessageKind::Output, "\n");
    for (const Deadline soon = Deadline::inMs(kMs); pid() == 0 && !soon.passed();) poll(nullptr, 0, 10);
    const pid_t started = pid();
    stop();
    EXPECT_TRUE(goneSoon(started));
}

} // namespace
} // namespace mural
