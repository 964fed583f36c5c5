// A killed peer process is detected promptly, and never before its last bytes are read.
#include <atomic>
#include <csignal>
#include <functional>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include "tests/transport/linked_pair.hpp"
#include "transport/connect.hpp"

namespace mural::test {

namespace {

using Role = std::function<void(Connection&)>;

Deadline late() { return Deadline::inMs(20000); }

[[noreturn]] void waitToBeKilled() {
    while (true) pause();
}

// A process that runs `role` at the other end. The destructor kills and reaps it.
class PeerProcess {
public:
    PeerProcess(LinkKind kind, size_t capacityBytes, const Role& role) {
        if (kind == LinkKind::SharedMemory) {
            startSharedMemory(capacityBytes, role);
        } else {
            startListening(kind == LinkKind::Tcp ? "tcp://127.0.0.1:0" : "fabric://127.0.0.1:0", role);
        }
    }
    PeerProcess(const PeerProcess&) = delete;
    PeerProcess& operator=(const PeerProcess&) = delete;
    ~PeerProcess() { kill(); }

    void kill() {
        if (pid_ <= 0) return;
        ::kill(pid_, SIGKILL);
        await();
    }
    void await() {
        waitpid(pid_, nullptr, 0);
        pid_ = 0;
    }
    Connection& connection() { return *connection_; }
    [[nodiscard]] bool linked() const { return connection_ != nullptr; }

private:
    void startSharedMemory(size_t capacityBytes, const Role& role) {
        auto offer = offerSharedMemory(capacityBytes);
        if (!offer) return;
        pid_ = fork();
        if (pid_ == 0) {
            offer->connection.reset(); // the child's copy of this end
            auto end = openSharedMemory(offer->peerFd);
            if (!end) _exit(1);
            role(**end);
            _exit(0);
        }
        ::close(offer->peerFd);
        connection_ = std::move(offer->connection);
    }

    void startListening(const char* at, const Role& role) {
        auto listener = listenAt(at);
        if (!listener) return;
        pid_ = fork();
        if (pid_ == 0) {
            auto end = connectTo((*listener)->describe(), late());
            if (!end) _exit(1);
            role(**end);
            _exit(0);
        }
        auto end = (*listener)->accept(late());
        if (end) connection_ = std::move(*end);
    }

    pid_t pid_ = 0;
    std::unique_ptr<Connection> connection_;
};

class PeerDeathTest : public testing::TestWithParam<LinkKind> {
protected:
    void SetUp() override {
        if (const std::string why = whyNoLinks(GetParam()); !why.empty()) GTEST_SKIP() << why;
    }
};

// Calls `blocked` on a thread, kills the peer while that sleeps, and returns the time until it returned.
template <class Blocked> int64_t killWhileBlockedNs(PeerProcess& peer, Blocked blocked) {
    std::atomic<pid_t> id = 0;
    int64_t endNs = 0;
    std::thread thread([&] {
        id = currentThread();
        EXPECT_FALSE(blocked());
        endNs = monotonicNowNs();
    });
    while (id == 0) std::this_thread::yield();
    EXPECT_TRUE(waitUntilAsleep(id, late()));
    const int64_t beginNs = monotonicNowNs();
    peer.kill();
    thread.join();
    return endNs - beginNs;
}

// 50 ms is the guarantee; a busy machine may add to it. Without detection the deadline of 20 s would apply.
constexpr int64_t kNoticedNs = 5 * kNsPerS;

} // namespace

TEST_P(PeerDeathTest, endsAWaitingRead) {
    PeerProcess peer(GetParam(), 4096, [](Connection&) { waitToBeKilled(); });
    ASSERT_TRUE(peer.linked());
    std::vector<std::byte> one(1);
    const int64_t tookNs = killWhileBlockedNs(peer, [&] { return peer.connection().read(one, late()).ok(); });
    EXPECT_LT(tookNs, kNoticedNs);
    EXPECT_FALSE(peer.connection().timedOut());
    EXPECT_FALSE(peer.connection().alive());
    RecordProperty("noticedAfterUs", static_cast<int>(tookNs / 1000));
}

TEST_P(PeerDeathTest, endsAWaitingWrite) {
    PeerProcess peer(GetParam(), 4096, [](Connection&) { waitToBeKilled(); });
    ASSERT_TRUE(peer.linked());
    const std::vector<std::byte> all(size_t{96} << 20);
    const int64_t tookNs = killWhileBlockedNs(peer, [&] { return peer.connection().write(all, late()).ok(); });
    EXPECT_LT(tookNs, kNoticedNs);
    EXPECT_FALSE(peer.connection().write(all, late())) << "and no SIGPIPE";
    EXPECT_FALSE(peer.connection().timedOut());
}

TEST_P(PeerDeathTest, isReportedAfterThePeersLastBytes) {
    constexpr size_t kBytes = 100000;
    PeerProcess peer(GetParam(), size_t{1} << 20, [](Connection& end) {
        std::vector<std::byte> last(kBytes);
        ByteStream(5).fill(last);
        if (!end.write(last, late())) _exit(1);
        end.flush();
        raise(SIGKILL);
    });
    ASSERT_TRUE(peer.linked());
    peer.await();
    EXPECT_FALSE(peer.connection().alive());
    std::vector<std::byte> right(kBytes);
    ByteStream(5).fill(right);
    std::vector<std::byte> last(kBytes);
    const auto result = peer.connection().read(last, late());
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(last, right);
    EXPECT_FALSE(peer.connection().read(last, late()));
    EXPECT_FALSE(peer.connection().timedOut());
}

TEST_P(PeerDeathTest, isDetectedWithShortDeadlines) {
    PeerProcess peer(GetParam(), 4096, [](Connection&) { waitToBeKilled(); });
    ASSERT_TRUE(peer.linked());
    std::vector<std::byte> one(1);
    EXPECT_FALSE(peer.connection().read(one, Deadline::inMs(1)));
    EXPECT_TRUE(peer.connection().timedOut());
    peer.kill();
    EXPECT_FALSE(peer.connection().read(one, Deadline::inMs(0)));
    EXPECT_FALSE(peer.connection().timedOut());
}

TEST_P(PeerDeathTest, endsAPartialMessage) {
    PeerProcess peer(GetParam(), 4096, [](Connection& end) {
        const std::vector<std::byte> some(100);
        if (!end.write(some, late())) _exit(1);
        end.flush();
        raise(SIGKILL);
    });
    ASSERT_TRUE(peer.linked());
    std::vector<std::byte> more(101);
    const auto result = peer.connection().read(more, late());
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("100 of 101"), std::string::npos) << result.error().message;
}

INSTANTIATE_TEST_SUITE_P(BetweenProcesses, PeerDeathTest,
                         testing::Values(LinkKind::SharedMemory, LinkKind::Tcp, LinkKind::Fabric),
                         [](const auto& param) { return linkName(param.param); });

} // namespace mural::test
