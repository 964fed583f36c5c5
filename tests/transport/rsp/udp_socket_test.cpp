// Datagrams over this machine's own network: delivered in place, elsewhere, and merged by the kernel.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <thread>
#include <vector>

#include "transport/rsp/io/udp_socket.hpp"

namespace mural::rsp {
namespace {

constexpr size_t kPlace = 100;

UdpSocket open() {
    auto lo = findInterface("lo", AF_INET);
    EXPECT_TRUE(lo) << lo.error().message;
    auto socket = UdpSocket::openOwn(*lo, AF_INET, 1 << 20);
    EXPECT_TRUE(socket) << socket.error().message;
    return std::move(*socket);
}

std::vector<std::byte> numbered(size_t bytes, size_t from) {
    std::vector<std::byte> d(bytes);
    for (size_t i = 0; i < bytes; ++i) d[i] = static_cast<std::byte>((from + i) * 7 + i / 251);
    return d;
}

struct Ends {
    UdpSocket from = open();
    UdpSocket to = open();

    void send(std::vector<std::byte> datagrams, size_t segmentBytes) {
        const auto sent = from.send(to.localAddress(), datagrams, segmentBytes);
        EXPECT_TRUE(sent) << sent.error().message;
    }
};

// The received datagrams, and how many of them were in place.
struct Came {
    std::vector<std::vector<std::byte>> datagrams;
    size_t landed = 0;

    Came(UdpSocket& socket, const ReceiveBuffers& landing, size_t count) {
        pollfd one{socket.descriptor(), POLLIN, 0};
        while (datagrams.size() < count && poll(&one, 1, 10'000) == 1) {
            for (const UdpSocket::Datagram& d : socket.fetch(landing)) {
                landed += std::ranges::count(landing.buffers, d.bytes.data());
                datagrams.emplace_back(d.bytes.begin(), d.bytes.end());
            }
        }
    }
};

struct Places {
    std::vector<std::byte> bytes;
    std::vector<std::byte*> each;
    size_t bufferBytes;
    explicit Places(size_t count, size_t sizeBytes = kPlace) : bytes(count * sizeBytes), bufferBytes(sizeBytes) {
        for (size_t i = 0; i < count; ++i) each.push_back(bytes.data() + i * bufferBytes);
    }
    Places(const Places&) = delete; // `each` points into `bytes`
    Places& operator=(const Places&) = delete;
    [[nodiscard]] ReceiveBuffers landing() const { return {bufferBytes, each}; }
};

// Sends and receives enough single datagrams to show that none are merged.
void showThatNoneAreJoined(Ends& ends, const ReceiveBuffers& landing) {
    constexpr size_t kAtOnce = 32;
    for (size_t round = 0; round < 8; ++round) {
        for (size_t i = 0; i < kAtOnce; ++i) ends.send(numbered(kPlace, round + i), kPlace);
        const Came came(ends.to, landing, kAtOnce);
        ASSERT_EQ(came.datagrams.size(), kAtOnce);
        for (size_t i = 0; i < kAtOnce; ++i)
            ASSERT_EQ(came.datagrams[i], numbered(kPlace, round + i)) << round << ", " << i;
        ASSERT_EQ(came.landed, 0u) << "they might have come joined";
    }
}

TEST(UdpSocket, receivesInPlaceWithoutMerging) {
    Ends ends;
    Places buffers(4);
    showThatNoneAreJoined(ends, buffers.landing());
    // more than there are slots; the last ones use the socket's own buffer
    const std::vector<size_t> sizes{kPlace, 1, 32, 5, 1000, kPlace};
    for (const size_t size : sizes) ends.send(numbered(size, size), size);
    const Came came(ends.to, buffers.landing(), sizes.size());
    ASSERT_EQ(came.datagrams.size(), sizes.size());
    for (size_t i = 0; i < sizes.size(); ++i) EXPECT_EQ(came.datagrams[i], numbered(sizes[i], sizes[i])) << i;
    EXPECT_EQ(came.landed, 4u);
}

// As a group uses it: no sender addresses, all slots offered to each call, and no slot used by two calls.
TEST(UdpSocket, usesSeparateSlotsPerCall) {
    Ends ends;
    ends.to.omitSenders();
    const Places few(4);
    const std::array<Places, 4> calls{Places(kMaxAtOnce), Places(kMaxAtOnce), Places(kMaxAtOnce, 2 * kPlace),
                                      Places(kMaxAtOnce)};
    showThatNoneAreJoined(ends, few.landing());
    for (size_t call = 0; call < calls.size(); ++call) {
        const size_t size = calls[call].bufferBytes;
        for (size_t i = 0; i < kMaxAtOnce; ++i) ends.send(numbered(size, call + i), size);
        const Came came(ends.to, calls[call].landing(), kMaxAtOnce);
        ASSERT_EQ(came.datagrams.size(), kMaxAtOnce) << call;
        for (size_t i = 0; i < kMaxAtOnce; ++i)
            EXPECT_EQ(came.datagrams[i], numbered(size, call + i)) << call << ", " << i;
        EXPECT_EQ(came.landed, kMaxAtOnce) << call;
    }
    // The same with fewer slots and with none.
    ends.send(numbered(kPlace, 9), kPlace);
    const Came last(ends.to, few.landing(), 1);
    ASSERT_EQ(last.datagrams.size(), 1u);
    EXPECT_EQ(last.datagrams[0], numbered(kPlace, 9));
    EXPECT_EQ(last.landed, 1u);
}

TEST(UdpSocket, dropsDatagramsLongerThanTheirSlot) {
    Ends ends;
    Places buffers(32);
    showThatNoneAreJoined(ends, buffers.landing());
    for (const size_t size : {kPlace, kPlace + 1, kPlace - 1}) ends.send(numbered(size, size), size);
    const Came came(ends.to, buffers.landing(), 2);
    ASSERT_EQ(came.datagrams.size(), 2u);
    EXPECT_EQ(came.datagrams[0], numbered(kPlace, kPlace));
    EXPECT_EQ(came.datagrams[1], numbered(kPlace - 1, kPlace - 1));
}

TEST(UdpSocket, usesItsOwnBufferWithoutSlots) {
    Ends ends;
    showThatNoneAreJoined(ends, {});
    ends.send(numbered(500, 3), 500);
    const Came came(ends.to, {}, 1);
    ASSERT_EQ(came.datagrams.size(), 1u);
    EXPECT_EQ(came.datagrams[0], numbered(500, 3));
}

// Datagrams sent together cross this machine's own network as one. A socket that may receive merged datagrams has no
// slots, even if later datagrams are single.
TEST(UdpSocket, dividesMergedDatagrams) {
    for (const size_t segment : {kPlace, kPlace / 2, size_t{32}, size_t{700}}) {
        Ends ends;
        Places buffers(32);
        const auto all = numbered(10 * segment - 3, 1);
        for (int again = 0; again < 2; ++again) {
            ends.send(all, segment);
            const Came came(ends.to, buffers.landing(), 10);
            ASSERT_EQ(came.datagrams.size(), 10u) << segment;
            for (size_t i = 0; i < 10; ++i) {
                const auto expected = std::span(all).subspan(i * segment, std::min(segment, all.size() - i * segment));
                EXPECT_TRUE(std::ranges::equal(came.datagrams[i], expected)) << segment << ", " << i;
            }
            EXPECT_EQ(came.landed, 0u);
            if (again == 0) showThatNoneAreJoined(ends, buffers.landing());
        }
    }
}

TEST(UdpSocket, countsDroppedDatagrams) {
    Ends ends;
    const size_t room = ends.to.capacity(1000);
    for (size_t i = 0; i < 2 * room; ++i) ends.send(numbered(1000, i), 1000);
    size_t got = 0;
    do {
        got += ends.to.fetch().size();
    } while (ends.to.mayBeMore());
    EXPECT_GT(got, 0u);
    EXPECT_EQ(ends.to.dropped(), 2 * room - got);
}

// Sends datagrams of equal size and a shorter one by each method. A rejected method is not tried again.
class SentDatagrams : public ::testing::Test {
protected:
    static constexpr size_t kSegment = 232;
    Ends ends;

    void sendAll(size_t lastBytes) {
        const auto all = numbered(9 * kSegment + lastBytes, 1);
        ends.send(all, kSegment);
        const Came came(ends.to, {}, 10);
        ASSERT_EQ(came.datagrams.size(), 10u);
        for (size_t i = 0; i < 10; ++i)
            EXPECT_TRUE(std::ranges::equal(came.datagrams[i],
                                           std::span(all).subspan(i * kSegment, i == 9 ? lastBytes : kSegment)))
                << i;
    }
    void joinedOnesAreRefused() { // the kernel rejects segmentation without a checksum
        const int on = 1;
        ASSERT_EQ(setsockopt(ends.from.descriptor(), SOL_SOCKET, SO_NO_CHECK, &on, sizeof on), 0);
    }
};

TEST_F(SentDatagrams, arriveFromOneSegmentedDatagram) {
    sendAll(kSegment);
    sendAll(3);
    EXPECT_STREQ(ends.from.sendingBy(), "UDP_SEGMENT");
}

TEST_F(SentDatagrams, arriveFromSeveralMessagesPerCall) {
    joinedOnesAreRefused();
    sendAll(kSegment);
    EXPECT_STREQ(ends.from.sendingBy(), "sendmmsg");
    sendAll(3);
}

// Simulates a kernel without that call for this thread.
TEST_F(SentDatagrams, arriveOneByOne) {
    joinedOnesAreRefused();
    std::thread([&] {
        std::array<sock_filter, 4> program{{
            {BPF_LD | BPF_W | BPF_ABS, 0, 0, offsetof(seccomp_data, nr)},
            {BPF_JMP | BPF_JEQ | BPF_K, 0, 1, SYS_sendmmsg},
            {BPF_RET | BPF_K, 0, 0, SECCOMP_RET_ERRNO | ENOSYS},
            {BPF_RET | BPF_K, 0, 0, SECCOMP_RET_ALLOW},
        }};
        const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
        ASSERT_EQ(prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), 0);
        ASSERT_EQ(prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter), 0);
        sendAll(kSegment);
    }).join();
    EXPECT_STREQ(ends.from.sendingBy(), "sendto");
    sendAll(3);
}

} // namespace
} // namespace mural::rsp
