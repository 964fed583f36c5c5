// Control connections of a group: limits and order of queued messages.
#include "transport/rsp/io/control_link.hpp"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>

namespace mural::rsp {
namespace {

namespace asio = boost::asio;
using Tcp = asio::ip::tcp;

// A link to a peer that reads only on request.
class LinkTest : public ::testing::Test {
protected:
    void SetUp() override {
        Tcp::acceptor acceptor(context_, {asio::ip::address_v4::loopback(), 0});
        peer_.connect(acceptor.local_endpoint());
        Tcp::socket socket(context_);
        acceptor.accept(socket);
        link_ = std::make_shared<ControlLink>(
            std::move(socket), SecureChannel::accepting([](const std::string&) { return ChannelSecret{}; }));
        bool open = false;
        link_->start({[&] { open = true; }, [](const ControlMessage&) {}, [](const std::string&) {}});
        while (!open) {
            exchange();
            if (const size_t bytes = peer_.available(); bytes != 0) take(bytes);
        }
        exchange();
    }
    void TearDown() override {
        peer_.close();
        context_.run_for(std::chrono::seconds(5));
    }
    void exchange() {
        asio::write(peer_, asio::buffer(channel_.takeOutput()));
        context_.restart();
        context_.run_for(std::chrono::milliseconds(1));
    }
    void take(size_t bytes) {
        std::vector<std::byte> in(bytes);
        asio::read(peer_, asio::buffer(in));
        ASSERT_TRUE(channel_.input(in, messages_).ok());
    }

    asio::io_context context_;
    Tcp::socket peer_{context_};
    SecureChannel channel_ = SecureChannel::connecting("member", ChannelSecret{});
    std::shared_ptr<ControlLink> link_;
    std::vector<std::vector<std::byte>> messages_;
};

TEST_F(LinkTest, limitsQueuedDataForAPeerThatDoesNotRead) {
    constexpr size_t kBound = 1'000'000;
    const Tunnel datagram{1, std::vector<std::byte>(60'000)};
    size_t taken = 0;
    while (link_->offer(datagram, kBound)) {
        taken++;
        exchange();
        ASSERT_LT(taken, 1000U);
    }
    EXPECT_GT(link_->waitingBytes(), kBound);
    EXPECT_LT(link_->waitingBytes(), kBound + 2 * datagram.datagram.size());
    EXPECT_FALSE(link_->offer(datagram, kBound));
    const size_t waited = link_->waitingBytes();
    link_->send(Ping{}); // control messages are always queued
    EXPECT_GT(link_->waitingBytes(), waited);

    while (link_->waitingBytes() != 0 || peer_.available() != 0) {
        exchange();
        if (const size_t bytes = peer_.available(); bytes != 0) take(bytes);
    }
    EXPECT_EQ(messages_.size(), taken + 1);
    EXPECT_TRUE(link_->offer(datagram, kBound));
}

// A member with megabytes of queued data that reads slowly still receives a goodbye or a ping.
TEST_F(LinkTest, sendsControlMessagesBeforeQueuedData) {
    constexpr size_t kBound = 24'000'000;
    const Tunnel datagram{1, std::vector<std::byte>(1'400)};
    while (link_->offer(datagram, kBound)) {}
    exchange();
    const size_t offered = link_->waitingBytes();
    ASSERT_GT(offered, kBound / 2);
    link_->send(Ping{});
    link_->hangUp();
    exchange();
    EXPECT_LT(link_->waitingBytes(), offered / 10);
    size_t came = 0;
    while (!channel_.finished() && came < kBound) {
        exchange();
        const size_t bytes = std::min<size_t>(peer_.available(), 10'000);
        if (bytes != 0) take(bytes);
        came += bytes;
    }
    EXPECT_TRUE(channel_.finished());
    EXPECT_LT(came, kBound / 4);
    ASSERT_FALSE(messages_.empty());
    EXPECT_TRUE(std::holds_alternative<Ping>(*decode(messages_.back())));
    peer_.close();
    exchange();
    EXPECT_TRUE(link_->ended());
}

TEST_F(LinkTest, dropsQueuedDataOnRequest) {
    const Tunnel datagram{1, std::vector<std::byte>(60'000)};
    while (link_->offer(datagram, 8'000'000)) {}
    exchange();
    const size_t offered = link_->waitingBytes();
    link_->dropOffered();
    EXPECT_LT(link_->waitingBytes(), offered / 10);
    EXPECT_TRUE(link_->offer(Tunnel{2, std::vector<std::byte>(100)}, 8'000'000));
    while (link_->waitingBytes() != 0 || peer_.available() != 0) {
        exchange();
        if (const size_t bytes = peer_.available(); bytes != 0) take(bytes);
    }
    ASSERT_FALSE(messages_.empty());
    const auto last = decode(messages_.back());
    ASSERT_TRUE(std::holds_alternative<Tunnel>(*last));
    EXPECT_EQ(std::get<Tunnel>(*last).to, 2);
}

} // namespace
} // namespace mural::rsp
