// The real node's main loop on a connection of the test.
#include "nodes/render/node.hpp"

#include <csignal>
#include <cstring>
#include <gtest/gtest.h>
#include <thread>
#include <vector>

#include "common/log/log.hpp"
#include "common/log/process_log.hpp"
#include "nodes/replay/engine/make_replay.hpp"
#include "nodes/session/session_config.hpp"
#include "nodes/session/stream_build.hpp"
#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/node_messages.hpp"
#include "streamcodec/wire/packet.hpp"
#include "transport/connection.hpp"

namespace mural {
namespace {

constexpr int64_t kAnswerMs = 20'000;

class NodeTest : public ::testing::Test {
protected:
    void SetUp() override {
        signal(SIGPIPE, SIG_DFL); // the default of a new process
        auto offer = offerSharedMemory(size_t{1} << 20);
        ASSERT_TRUE(offer.ok());
        head_ = std::move(offer->connection);
        node_ = std::thread([this, fd = offer->peerFd] {
            NodeOptions options;
            options.connectFd = fd;
            status_ = runNode(options, makeReplay);
        });
    }
    void TearDown() override {
        if (head_) head_->close();
        if (node_.joinable()) node_.join();
    }

    // Returns after the node has applied its setup and drawn nothing yet.
    void awaitReady() {
        wire::MessageHeader header{};
        while (head_->read(std::as_writable_bytes(std::span(&header, 1)), Deadline::inMs(kAnswerMs))) {
            std::vector<std::byte> bytes(header.sizeBytes);
            if (!bytes.empty()) {
                ASSERT_TRUE(head_->read(bytes, Deadline::inMs(kAnswerMs)));
            }
            if (header.type == static_cast<uint32_t>(wire::NodeMessage::Ready)) return;
        }
        FAIL() << "the node is not ready";
    }

    void sendSetup(const NodeSetup& setup) {
        const std::string json = toJson(setup);
        const auto command = static_cast<uint32_t>(wire::HeadCommand::Setup);
        const wire::PacketHeader header{static_cast<uint32_t>(json.size() + 4), wire::streamOf(0, 0)};
        ASSERT_TRUE(head_->write(std::as_bytes(std::span(&header, 1)), Deadline::inMs(kAnswerMs)));
        ASSERT_TRUE(head_->write(std::as_bytes(std::span(&command, 1)), Deadline::inMs(kAnswerMs)));
        ASSERT_TRUE(head_->write(std::as_bytes(std::span(json)), Deadline::inMs(kAnswerMs)));
        head_->flush();
    }
    // Returns the texts of messages of that kind until the node ends; fails on any other message.
    std::vector<std::string> texts(wire::NodeMessage type) {
        std::vector<std::string> all;
        wire::MessageHeader header{};
        while (head_->read(std::as_writable_bytes(std::span(&header, 1)), Deadline::inMs(kAnswerMs))) {
            std::string text(header.sizeBytes, ' ');
            if (!text.empty() && !head_->read(std::as_writable_bytes(std::span(text)), Deadline::inMs(kAnswerMs)))
                break;
            if (header.type == static_cast<uint32_t>(wire::NodeMessage::Goodbye) ||
                header.type == static_cast<uint32_t>(wire::NodeMessage::Alive) ||
                header.type == static_cast<uint32_t>(wire::NodeMessage::Ready))
                continue;
            EXPECT_EQ(header.type, static_cast<uint32_t>(type)) << text;
            all.push_back(text);
        }
        return all;
    }
    int status() {
        node_.join();
        return status_;
    }

    std::unique_ptr<Connection> head_;
    std::thread node_;
    int status_ = -1;
};

// Data written to a closed display connection would otherwise end the process with SIGPIPE.
TEST_F(NodeTest, survivesWritesToAClosedConnection) {
    head_->close();
    (void)status();
    struct sigaction now {};
    ASSERT_EQ(sigaction(SIGPIPE, nullptr, &now), 0);
    EXPECT_EQ(now.sa_handler, SIG_IGN);
}

class ForeignBuild : public NodeTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(ForeignBuild, isRejectedWithOneLine) {
    NodeSetup setup;
    setup.build = GetParam();
    ASSERT_NE(setup.build, streamBuild());
    sendSetup(setup);
    const auto lines = texts(wire::NodeMessage::Log);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("install the same version of mural on both machines"), std::string::npos) << lines[0];
    EXPECT_NE(lines[0].find(setup.build.empty() ? "unnamed" : setup.build), std::string::npos) << lines[0];
    EXPECT_EQ(lines[0].find('\n'), std::string::npos);
    EXPECT_EQ(status(), 1);
}

INSTANTIATE_TEST_SUITE_P(Builds, ForeignBuild,
                         ::testing::Values("", "1.0000000000000000", "4294967295.0000000000000000"));

// Records after the damaged batch are unreadable, because their references are missing.
TEST_F(NodeTest, endsWithOneLineAfterADamagedBatch) {
    NodeSetup setup;
    setup.build = streamBuild();
    setup.delta = true;
    setup.cacheBytes = 1 << 20;
    sendSetup(setup);
    const std::vector<std::byte> batch{std::byte{2 << 1 | 1}, std::byte{0xff}, std::byte{0xff}};
    (void)head_->write(batch, Deadline::inMs(kAnswerMs));
    head_->flush();
    const auto lines = texts(wire::NodeMessage::Log);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("a batch"), std::string::npos) << lines[0];
    EXPECT_NE(lines[0].find("install the same version of mural on all machines"), std::string::npos) << lines[0];
    EXPECT_EQ(status(), 1);
}

// Lines for the user go to the head while the node runs, and to its standard error otherwise. Diagnostics never go to
// the head.
TEST_F(NodeTest, sendsLogLinesForTheUserToTheHead) {
    const log::Levels before = log::currentLevels();
    NodeSetup setup;
    setup.build = streamBuild();
    setup.placeThreads = false;
    setup.glBackend = "osmesa";
    setup.log = "picture:error,exchange:debug";
    sendSetup(setup);
    awaitReady();
    EXPECT_TRUE(log::enabled(log::Topic::Exchange, log::Level::Debug));
    log::warning(log::Topic::Replay, "first of node ", 0);
    log::warning(log::Topic::Picture, "disabled");
    testing::internal::CaptureStderr();
    log::debug(log::Topic::Exchange, "a diagnostic");
    EXPECT_NE(testing::internal::GetCapturedStderr().find(" exchange debug: a diagnostic\n"), std::string::npos);
    log::info(log::Topic::Output, "second");
    const auto finish = static_cast<uint32_t>(wire::HeadCommand::Finish);
    const wire::PacketHeader header{4, wire::streamOf(0, 0)};
    ASSERT_TRUE(head_->write(std::as_bytes(std::span(&header, 1)), Deadline::inMs(kAnswerMs)));
    ASSERT_TRUE(head_->write(std::as_bytes(std::span(&finish, 1)), Deadline::inMs(kAnswerMs)));
    head_->flush();
    EXPECT_EQ(texts(wire::NodeMessage::Log), (std::vector<std::string>{"first of node 0", "second"}));
    EXPECT_EQ(status(), 0);
    testing::internal::CaptureStderr();
    log::info(log::Topic::Output, "the node has ended");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "mural: the node has ended\n");
    log::setLevels(before);
}

TEST_F(NodeTest, endsWithItsHead) {
    head_->close();
    EXPECT_EQ(status(), 1);
}

} // namespace
} // namespace mural
