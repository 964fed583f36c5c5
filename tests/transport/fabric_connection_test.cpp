// Properties of libfabric connections only; connection_test.cpp covers the common contract.
#include <gtest/gtest.h>
#include <thread>
#include <vector>

#include "tests/transport/linked_pair.hpp"
#include "transport/connect.hpp"
#include "transport/connection_description.hpp"

namespace mural::test {

namespace {

class FabricTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (const std::string why = whyNoLinks(LinkKind::Fabric); !why.empty()) GTEST_SKIP() << why;
    }
};

template <class T> void expectError(const Result<T>& result, const std::string& reason) {
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find(reason), std::string::npos) << result.error().message;
    EXPECT_EQ(result.error().message.find('\n'), std::string::npos) << result.error().message;
}

} // namespace

TEST_F(FabricTest, namesItsProvider) {
    auto listener = listenAt("fabric://127.0.0.1:0?provider=tcp");
    ASSERT_TRUE(listener) << listener.error().message;
    const auto text = (*listener)->describe();
    const auto description = parseConnectionDescription(text);
    ASSERT_TRUE(description) << text;
    EXPECT_EQ(description.value().host, "127.0.0.1");
    EXPECT_NE(description.value().port, 0);
    EXPECT_EQ(description.value().parameters.at("provider"), "tcp") << text;
}

TEST_F(FabricTest, rejectsInvalidDescriptionsWithAReason) {
    const Deadline deadline = Deadline::inMs(5000);
    expectError(listenAt("fabric://127.0.0.1:0?provider=carrierpigeon"), "no provider");
    expectError(listenAt("fabric://127.0.0.1:0?speed=1"), "unknown parameter \"speed\"");
    expectError(connectTo("fabric://:80", deadline), "needs a host and a port");
    expectError(connectTo("fabric://nobody.invalid:80", deadline),
                "fabric://nobody.invalid:80: cannot resolve the host");
    expectError(connectTo("fabric://127.0.0.1:1?provider=tcp", deadline), "cannot connect");
    EXPECT_FALSE(deadline.passed());
}

TEST_F(FabricTest, keepsItsDeadlines) {
    auto listener = listenAt("fabric://127.0.0.1:0");
    ASSERT_TRUE(listener) << listener.error().message;
    const int64_t beginNs = monotonicNowNs();
    expectError((*listener)->accept(Deadline::inMs(50)), "without a connection");
    expectError(connectTo((*listener)->describe(), Deadline::inMs(50)), "deadline passed");
    const int64_t tookNs = monotonicNowNs() - beginNs;
    EXPECT_GE(tookNs, 100 * kNsPerMs);
    EXPECT_LT(tookNs, 5 * kNsPerS);
}

// Both directions wait: one thread polls libfabric's descriptors, the other waits for that thread.
TEST_F(FabricTest, sleepsWhileItWaits) {
    LinkedPair link = makeLinkedPair(LinkKind::Fabric, 0);
    ASSERT_TRUE(link.a && link.b);
    const std::vector<std::byte> all(size_t{96} << 20);
    int64_t writerNs = 0;
    std::thread writer([&] {
        const int64_t beginNs = threadCpuNowNs();
        EXPECT_FALSE(link.a->write(all, Deadline::inMs(600))) << "nobody reads";
        writerNs = threadCpuNowNs() - beginNs;
    });
    std::byte one{};
    const int64_t beginNs = threadCpuNowNs();
    EXPECT_FALSE(link.a->read(std::span(&one, 1), Deadline::inMs(500)));
    const int64_t readerNs = threadCpuNowNs() - beginNs;
    writer.join();
    EXPECT_LT(readerNs, 100 * kNsPerMs) << "busy waiting";
    EXPECT_LT(writerNs, 100 * kNsPerMs) << "busy waiting";
}

// Credits are the limit, not additional buffers of libfabric or a socket: RDMA hardware has none.
TEST_F(FabricTest, blocksTheWriterAtTheWindowOfASlowReader) {
    constexpr size_t kMessageBytes = (size_t{64} << 10) - 8;
    constexpr size_t kWindow = 16;
    LinkedPair link = makeLinkedPair(LinkKind::Fabric, 0);
    ASSERT_TRUE(link.a && link.b);
    const std::vector<std::byte> piece(kMessageBytes);
    std::vector<std::byte> got(kMessageBytes);
    for (int round = 0; round < 3; ++round) {
        size_t written = 0;
        while (written < 100 && link.a->write(piece, Deadline::inMs(50))) ++written;
        EXPECT_LE(written, kWindow + 1) << "the window, and one that is gathered";
        EXPECT_GE(written, kWindow - 4) << "the reader may have one still, and owe three credits";
        EXPECT_TRUE(link.a->timedOut());
        std::thread flushing([&] { link.a->flush(); }); // the buffered message is sent when credits arrive
        for (size_t i = 0; i < written; ++i) ASSERT_TRUE(link.b->read(got, Deadline::inMs(5000))) << i;
        flushing.join();
    }
}

// All written data arrives, including data without credits when the writer closed, and with unread replies in flight.
TEST_F(FabricTest, losesNothingOnClose) {
    constexpr size_t kBytes = 1'000'000; // nearly the window
    for (int round = 0; round < 20; ++round) {
        LinkedPair link = makeLinkedPair(LinkKind::Fabric, 0);
        ASSERT_TRUE(link.a && link.b);
        std::vector<std::byte> sent(kBytes);
        ByteStream(static_cast<uint64_t>(round)).fill(sent);
        ASSERT_TRUE(link.b->write(sent, Deadline::inMs(5000))); // `a` never reads it
        ASSERT_TRUE(link.a->write(sent, Deadline::inMs(5000)));
        link.a.reset();
        std::vector<std::byte> got(kBytes);
        for (size_t at = 0; at < kBytes; at += 10'000) {
            const auto result = link.b->read(std::span(got).subspan(at, 10'000), Deadline::inMs(5000));
            ASSERT_TRUE(result) << result.error().message;
        }
        EXPECT_EQ(got, sent);
    }
}

} // namespace mural::test
