// The contract of all connections: one suite for every kind.
#include <atomic>
#include <gtest/gtest.h>
#include <thread>
#include <vector>

#include "tests/sanitized.hpp"
#include "tests/transport/linked_pair.hpp"

namespace mural::test {

namespace {

constexpr size_t kCapacityBytes = 4096;
// More than both kernel buffers of a TCP connection hold.
constexpr size_t kMoreThanFitsBytes = size_t{96} << 20;

Deadline soon() { return Deadline::inMs(30); }
Deadline late() { return Deadline::inMs(20000); }

class ConnectionTest : public ::testing::TestWithParam<LinkKind> {
protected:
    void SetUp() override {
        if (const std::string why = whyNoLinks(GetParam()); !why.empty()) GTEST_SKIP() << why;
    }
    void link(size_t capacityBytes = kCapacityBytes) {
        pair_ = makeLinkedPair(GetParam(), capacityBytes);
        ASSERT_TRUE(pair_.a && pair_.b);
    }
    Connection& a() { return *pair_.a; }
    Connection& b() { return *pair_.b; }
    LinkedPair pair_;
};

#define EXPECT_OK(expression)                                                                                          \
    do {                                                                                                               \
        const auto result_ = (expression);                                                                             \
        EXPECT_TRUE(result_.ok()) << result_.error().message;                                                          \
    } while (false)

std::vector<std::byte> bytesOf(std::string_view text) {
    const auto all = std::as_bytes(std::span(text));
    return {all.begin(), all.end()};
}

// Sends `total` bytes in pieces of up to `maximum` while another thread reads them in other pieces.
void streamThrough(Connection& from, Connection& to, uint64_t seed, size_t total, size_t maximum) {
    std::vector<std::byte> source(maximum);
    ByteStream(seed).fill(source);
    Checksum sent;
    std::thread writer([&] {
        std::mt19937_64 random(seed);
        for (size_t done = 0; done < total;) {
            const size_t n = std::min(randomSize(random, maximum), total - done);
            const auto piece = std::span(source).subspan(source.size() - n);
            sent.add(piece);
            const auto result = from.write(piece, late());
            ASSERT_TRUE(result) << result.error().message;
            done += n;
        }
        from.flush();
    });
    Checksum received;
    std::vector<std::byte> sink(maximum);
    std::mt19937_64 random(seed + 1);
    for (size_t done = 0; done < total;) {
        const auto piece = std::span(sink).first(std::min(randomSize(random, maximum), total - done));
        const auto result = to.read(piece, late());
        EXPECT_TRUE(result) << result.error().message;
        if (!result) break;
        received.add(piece);
        done += piece.size();
    }
    writer.join();
    EXPECT_EQ(sent.value(), received.value());
}

} // namespace

TEST_P(ConnectionTest, carriesBytesInBothDirections) {
    link();
    EXPECT_OK(a().write(bytesOf("hello"), late()));
    a().flush();
    EXPECT_OK(b().write(bytesOf("you"), late()));
    b().flush();
    std::vector<std::byte> five(5);
    std::vector<std::byte> three(3);
    EXPECT_OK(b().read(five, late()));
    EXPECT_OK(a().read(three, late()));
    EXPECT_EQ(five, bytesOf("hello"));
    EXPECT_EQ(three, bytesOf("you"));
    EXPECT_EQ(a().bytesWritten(), 5U);
    EXPECT_EQ(b().bytesRead(), 5U);
    EXPECT_EQ(a().bytesRead(), 3U);
    EXPECT_TRUE(a().alive() && b().alive());
    EXPECT_FALSE(a().timedOut() || b().timedOut());
    EXPECT_OK(a().write({}, soon()));
    EXPECT_OK(a().read({}, soon()));
}

TEST_P(ConnectionTest, preservesOrderOfRandomPieces) {
    link();
    streamThrough(a(), b(), testSeed(), size_t{8} << 20, 3 * kCapacityBytes);
}

TEST_P(ConnectionTest, streamsManySmallPieces) {
    link(size_t{1} << 20);
    streamThrough(b(), a(), testSeed(), size_t{mural::testing::rounds(32)} << 20, 200);
}

TEST_P(ConnectionTest, streamsLargePieces) {
    link(size_t{1} << 20);
    streamThrough(a(), b(), testSeed(), size_t{mural::testing::rounds(512)} << 20, size_t{4} << 20);
}

TEST_P(ConnectionTest, streamsInBothDirectionsConcurrently) {
    link();
    const uint64_t seed = testSeed();
    std::thread back([&] { streamThrough(b(), a(), seed, size_t{4} << 20, 10000); });
    streamThrough(a(), b(), seed + 7, size_t{4} << 20, 10000);
    back.join();
}

TEST_P(ConnectionTest, completesManySmallRoundTrips) {
    link();
    constexpr uint32_t kRounds = 2000;
    std::thread answerer([&] {
        uint32_t value = 0;
        for (uint32_t i = 0; i < kRounds; ++i) {
            ASSERT_TRUE(b().read(std::as_writable_bytes(std::span(&value, 1)), late()));
            ++value;
            ASSERT_TRUE(b().write(std::as_bytes(std::span(&value, 1)), late()));
            b().flush();
        }
    });
    uint32_t value = 0;
    for (uint32_t i = 0; i < kRounds; ++i) {
        ASSERT_TRUE(a().write(std::as_bytes(std::span(&value, 1)), late()));
        a().flush();
        ASSERT_TRUE(a().read(std::as_writable_bytes(std::span(&value, 1)), late()));
    }
    answerer.join();
    EXPECT_EQ(value, kRounds);
}

TEST_P(ConnectionTest, blocksTheWriterUntilTheReaderReads) {
    link();
    std::vector<std::byte> all(kMoreThanFitsBytes);
    std::atomic<bool> finished = false;
    std::thread writer([&] {
        const auto result = a().write(all, late());
        a().flush();
        finished = true;
        EXPECT_TRUE(result) << result.error().message;
    });
    std::vector<std::byte> half(kMoreThanFitsBytes / 2);
    EXPECT_OK(b().read(half, late()));
    EXPECT_FALSE(finished) << "there is no room for the other half";
    EXPECT_OK(b().read(half, late()));
    writer.join();
    EXPECT_EQ(b().bytesRead(), kMoreThanFitsBytes);
}

TEST_P(ConnectionTest, reportsPartialWritesAtTheDeadline) {
    link();
    const std::vector<std::byte> all(kMoreThanFitsBytes);
    const auto result = a().write(all, Deadline::inMs(100));
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("deadline passed within a message"), std::string::npos)
        << result.error().message;
    EXPECT_FALSE(a().timedOut()) << "that would mean: usable";
    EXPECT_FALSE(a().alive());
    EXPECT_FALSE(a().write(bytesOf("x"), soon()));
    std::vector<std::byte> into(kMoreThanFitsBytes);
    EXPECT_FALSE(b().read(into, late())) << "the other end learns of it";
    EXPECT_FALSE(b().timedOut());
}

TEST_P(ConnectionTest, reportsPartialReadsAtTheDeadline) {
    link();
    EXPECT_OK(a().write(bytesOf("half"), late()));
    a().flush();
    std::vector<std::byte> whole(8);
    const auto result = b().read(whole, Deadline::inMs(100));
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("4 of 8"), std::string::npos) << result.error().message;
    EXPECT_FALSE(b().timedOut());
    EXPECT_FALSE(b().alive());
    EXPECT_FALSE(b().read(whole, soon()));
}

TEST_P(ConnectionTest, continuesAfterAReadThatTimedOutBeforeItsFirstByte) {
    link();
    std::vector<std::byte> four(4);
    for (int i = 0; i < 3; ++i) {
        const int64_t beginNs = monotonicNowNs();
        ASSERT_FALSE(b().read(four, soon()));
        EXPECT_GE(monotonicNowNs() - beginNs, 30 * kNsPerMs);
        EXPECT_TRUE(b().timedOut());
        EXPECT_TRUE(b().alive());
    }
    EXPECT_FALSE(a().timedOut());
    EXPECT_OK(a().write(bytesOf("late"), late()));
    a().flush();
    EXPECT_OK(b().read(four, late()));
    EXPECT_EQ(four, bytesOf("late"));
    EXPECT_FALSE(b().timedOut());
}

TEST_P(ConnectionTest, returnsAvailableDataAfterTheDeadline) {
    link();
    EXPECT_OK(a().write(bytesOf("abc"), late()));
    a().flush();
    std::vector<std::byte> one(1);
    EXPECT_OK(b().read(one, late())); // the rest has arrived with it
    std::vector<std::byte> two(2);
    EXPECT_OK(b().read(two, Deadline::inMs(0)));
    EXPECT_EQ(two, bytesOf("bc"));
}

// Single bytes cannot be divided, so each write is either complete or has no effect.
TEST_P(ConnectionTest, continuesAfterAWriteThatTimedOutBeforeItsFirstByte) {
    link();
    size_t written = 0;
    for (bool full = false; !full;) {
        const Deadline deadline = soon();
        for (int i = 0; i < 10000 && !full; ++i) {
            const auto value = static_cast<std::byte>(written);
            full = !a().write(std::span(&value, 1), deadline);
            if (!full) ++written;
        }
    }
    EXPECT_TRUE(a().timedOut());
    EXPECT_TRUE(a().alive());
    EXPECT_EQ(a().bytesWritten(), written);

    std::vector<std::byte> all(written + 1);
    std::thread reader([&] { EXPECT_OK(b().read(all, late())); });
    const auto value = static_cast<std::byte>(written);
    EXPECT_OK(a().write(std::span(&value, 1), late()));
    EXPECT_FALSE(a().timedOut());
    a().flush();
    reader.join();
    size_t wrong = 0;
    for (size_t i = 0; i < all.size(); ++i) wrong += all[i] != static_cast<std::byte>(i) ? 1 : 0;
    EXPECT_EQ(wrong, 0U) << "of " << all.size();
}

TEST_P(ConnectionTest, deliversDataWrittenBeforeClose) {
    link();
    EXPECT_OK(a().write(bytesOf("bye"), late()));
    a().close();
    std::vector<std::byte> three(3);
    EXPECT_OK(b().read(three, late()));
    EXPECT_EQ(three, bytesOf("bye"));
    EXPECT_FALSE(b().read(three, late()));
    EXPECT_FALSE(b().timedOut());
    EXPECT_FALSE(b().alive());
    EXPECT_FALSE(a().read(three, late()));
    EXPECT_FALSE(a().write(three, late()));
}

// The writer writes and closes while the reader polls, repeatedly, to cover every interleaving.
TEST_P(ConnectionTest, deliversTheLastByteBeforeAConcurrentClose) {
    const int rounds = GetParam() == LinkKind::Rsp ? 20 : 500; // a group takes 0.2 s to form
    for (int i = 0; i < rounds; ++i) {
        link();
        std::atomic<bool> go = false;
        std::thread writer([&] {
            while (!go) {}
            const std::byte last{1};
            (void)a().write(std::span(&last, 1), late());
            a().close();
        });
        std::byte into{};
        go = true;
        const auto result = b().read(std::span(&into, 1), late());
        writer.join();
        ASSERT_TRUE(result) << "round " << i << ": " << result.error().message;
    }
}

TEST_P(ConnectionTest, closesWhenAnEndIsDestroyed) {
    link();
    pair_.a.reset();
    std::vector<std::byte> one(1);
    EXPECT_FALSE(b().read(one, late()));
    EXPECT_FALSE(b().timedOut());
    const std::vector<std::byte> all(kMoreThanFitsBytes);
    EXPECT_FALSE(b().write(all, late())) << "and no SIGPIPE";
    EXPECT_FALSE(b().write(all, late()));
    EXPECT_FALSE(b().timedOut());
}

// Runs `blocked` on a thread until it sleeps, then closes `closing`. The thread must return an error.
template <class Blocked> void expectCloseWakes(Blocked blocked, Connection& closing) {
    std::atomic<pid_t> id = 0;
    std::atomic<bool> failed = false;
    int64_t endNs = 0;
    std::thread thread([&] {
        id = currentThread();
        failed = !blocked();
        endNs = monotonicNowNs();
    });
    while (id == 0) std::this_thread::yield();
    EXPECT_TRUE(waitUntilAsleep(id, late()));
    const int64_t beginNs = monotonicNowNs();
    closing.close();
    thread.join();
    EXPECT_TRUE(failed);
    EXPECT_LT(endNs - beginNs, 5 * kNsPerS);
}

TEST_P(ConnectionTest, wakesABlockedReaderWhenEitherEndCloses) {
    for (const bool ownEnd : {false, true}) {
        link();
        std::vector<std::byte> one(1);
        expectCloseWakes([&] { return b().read(one, late()).ok(); }, ownEnd ? b() : a());
        EXPECT_FALSE(b().timedOut());
    }
}

TEST_P(ConnectionTest, wakesABlockedWriterWhenEitherEndCloses) {
    const std::vector<std::byte> all(kMoreThanFitsBytes);
    for (const bool ownEnd : {false, true}) {
        link();
        expectCloseWakes([&] { return a().write(all, late()).ok(); }, ownEnd ? a() : b());
        EXPECT_FALSE(a().timedOut());
    }
}

INSTANTIATE_TEST_SUITE_P(AllKinds, ConnectionTest, ::testing::ValuesIn(kAllLinkKinds),
                         [](const auto& param) { return linkName(param.param); });

} // namespace mural::test
