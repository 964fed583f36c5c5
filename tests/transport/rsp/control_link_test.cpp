#include "transport/rsp/control_link.hpp"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>

namespace mural::rsp {
namespace {

namespace asio = boost::asio;
using Tcp = asio::ip::tcp;

// A link to a peer that reads only when the test lets it.
class LinkTest : public ::testing::Test {
protected:
    void SetUp() override {
        Tcp::acceptor acceptor(context_, {asio::ip::address_v4::loopback(), 0});
        peer_.connect(acceptor.local_endpoint());
        Tcp::socket socket(context_);
        acceptor.accept(socket);
        link_ = std::make_shared<ControlLink>(std::move(socket), SecureChannel::accepting([](const std::string&) { return ChannelSecret{}; }));
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

TEST_F(LinkTest, WhatIsOfferedToAPeerThatDoesNotReadWaitsUpToABound) {
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
    link_->send(Ping{}); // what must not be lost goes in
    EXPECT_GT(link_->waitingBytes(), waited);

    while (link_->waitingBytes() != 0 || peer_.available() != 0) {
        exchange();
        if (const size_t bytes = peer_.available(); bytes != 0) take(bytes);
    }
    EXPECT_EQ(messages_.size(), taken + 1);
    EXPECT_TRUE(link_->offer(datagram, kBound));
}

} // namespace
} // namespace mural::rsp
