// Connections over shared memory and in-process pipes.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "transport/connection.hpp"
#include "transport/connect.hpp"

namespace mural {

TEST(SharedMemoryConnection, acceptsOnlyPowersOfTwo) {
    for (const size_t bytes : {size_t{0}, size_t{63}, size_t{32}, size_t{4097}, size_t{1} << 31}) {
        const auto offer = offerSharedMemory(bytes);
        ASSERT_FALSE(offer) << bytes;
        EXPECT_NE(offer.error().message.find("power of two"), std::string::npos);
    }
    auto offer = offerSharedMemory(64);
    ASSERT_TRUE(offer) << offer.error().message;
    close(offer->peerFd);
}

TEST(SharedMemoryConnection, offersAnInheritableDescriptor) {
    auto offer = offerSharedMemory(4096);
    ASSERT_TRUE(offer);
    EXPECT_EQ(fcntl(offer->peerFd, F_GETFD) & FD_CLOEXEC, 0);
    auto end = connectTo("shm:" + std::to_string(offer->peerFd), Deadline::inMs(0));
    ASSERT_TRUE(end) << end.error().message;
    EXPECT_NE(fcntl(offer->peerFd, F_GETFD) & FD_CLOEXEC, 0) << "but grandchildren do not";
}

TEST(SharedMemoryConnection, rejectsInvalidDescriptors) {
    EXPECT_FALSE(openSharedMemory(-1));
    EXPECT_FALSE(openSharedMemory(open("/dev/null", O_RDONLY)));
    int ends[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    EXPECT_FALSE(openSharedMemory(ends[0])) << "silent, and must not wait";
    close(ends[1]);
}

TEST(SharedMemoryConnection, canBeOpenedOnlyOnce) {
    auto offer = offerSharedMemory(4096);
    ASSERT_TRUE(offer);
    const int again = dup(offer->peerFd);
    ASSERT_TRUE(openSharedMemory(offer->peerFd));
    EXPECT_FALSE(openSharedMemory(again));
}

TEST(SharedMemoryConnection, detectsAPeerThatNeverOpened) {
    auto offer = offerSharedMemory(4096);
    ASSERT_TRUE(offer);
    EXPECT_TRUE(offer->connection->alive());
    close(offer->peerFd);
    EXPECT_FALSE(offer->connection->alive());
    std::byte one{};
    EXPECT_FALSE(offer->connection->read(std::span(&one, 1), Deadline::inMs(20000)));
    EXPECT_FALSE(offer->connection->timedOut());
}

// A forked program has copies of both ends; the end of the child must not close the parent's connection.
TEST(SharedMemoryConnection, survivesAForkedCopy) {
    auto offer = offerSharedMemory(4096);
    ASSERT_TRUE(offer);
    auto peer = openSharedMemory(offer->peerFd);
    ASSERT_TRUE(peer);
    const pid_t child = fork();
    if (child == 0) {
        offer->connection.reset();
        peer->reset();
        _exit(0);
    }
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
    EXPECT_TRUE(offer->connection->alive());
    const std::byte out{42};
    std::byte in{};
    EXPECT_TRUE(offer->connection->write(std::span(&out, 1), Deadline::inMs(20000)));
    offer->connection->flush();
    EXPECT_TRUE((*peer)->read(std::span(&in, 1), Deadline::inMs(20000)));
    EXPECT_EQ(in, out);
}

TEST(PipeConnection, roundsItsCapacityUp) {
    auto pair = makePipe(100);
    ASSERT_TRUE(pair);
    const std::vector<std::byte> bytes(128);
    EXPECT_TRUE(pair->a->write(bytes, Deadline::inMs(0)));
    EXPECT_FALSE(pair->a->write(std::span(bytes).first(1), Deadline::inMs(0)));
    EXPECT_TRUE(pair->a->timedOut());
}

} // namespace mural
