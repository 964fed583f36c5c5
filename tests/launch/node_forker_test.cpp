// Nodes that a process forks for the head: this executable is the head, the forking process and the nodes.
#include "nodes/launch/forking/node_forker.hpp"

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <sys/socket.h>
#include <unistd.h>

#include "nodes/launch/environment.hpp"
#include "nodes/launch/forking/fork_server.hpp"

namespace mural {
namespace {

constexpr int64_t kPatienceMs = 20'000;

// A node of these tests serves one-byte requests on the socket that it inherits. It replies to `p` with its parent's
// pid. It replies to `w` with the pid of a child that waits. `k` ends it by a signal, other bytes with status 7.
int serve(int connectFd) {
    char request = 0;
    while (read(connectFd, &request, 1) == 1) {
        pid_t reply = getppid();
        if (request == 'w') reply = fork();
        while (reply == 0) pause();
        if (request == 'k') raise(SIGKILL);
        if (request != 'p' && request != 'w') break;
        if (write(connectFd, &reply, sizeof reply) != sizeof reply) break;
    }
    return 7;
}

struct ForkedPeer {
    std::unique_ptr<RunningNode> node;
    FileDescriptor socket;

    void send(char request) { EXPECT_EQ(write(socket.get(), &request, 1), 1); }
    pid_t ask(char request) {
        send(request);
        pid_t reply = 0;
        EXPECT_EQ(read(socket.get(), &reply, sizeof reply), static_cast<ssize_t>(sizeof reply));
        return reply;
    }
    std::string end() { return node->waitEnded(Deadline::inMs(kPatienceMs)).value_or("runs"); }
};

std::shared_ptr<NodeForker> startForker() {
    auto forker = NodeForker::start(launch::ownBinary());
    EXPECT_TRUE(forker.ok()) << forker.error().message;
    return forker ? *forker : nullptr;
}

ForkedPeer forked(NodeForker& forker) {
    int ends[2] = {-1, -1};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
    const FileDescriptor theirs(ends[1]);
    auto node = forker.fork(theirs.get());
    EXPECT_TRUE(node.ok()) << node.error().message;
    return {node ? std::move(*node) : nullptr, FileDescriptor(ends[0])};
}

bool isGone(pid_t pid) {
    for (const Deadline deadline = Deadline::inMs(kPatienceMs); !deadline.passed(); usleep(5'000))
        if (kill(pid, 0) != 0) return true;
    return false;
}

std::string commandLineOf(pid_t pid) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/cmdline", std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(file)), {});
    for (char& c : text) c = c == '\0' ? ' ' : c;
    return text;
}

TEST(NodeForker, reportsHowEachNodeEnded) {
    const auto forker = startForker();
    ForkedPeer first = forked(*forker), second = forked(*forker);
    EXPECT_FALSE(first.node->ended());
    first.send('k');
    EXPECT_EQ(first.end(), "signal 9 (Killed)");
    EXPECT_FALSE(second.node->ended());
    second.send('x');
    EXPECT_EQ(second.end(), "exit status 7");
    EXPECT_EQ(first.end(), "signal 9 (Killed)");
}

TEST(NodeForker, showsItsNodesAsNodes) {
    const auto forker = startForker();
    ForkedPeer other = forked(*forker);
    const pid_t server = other.ask('p'); // the node is renamed before it serves
    EXPECT_NE(commandLineOf(other.node->pid()).find(" node --connect-fd "), std::string::npos)
        << commandLineOf(other.node->pid());
    EXPECT_NE(commandLineOf(server).find(" fork-nodes --control-fd "), std::string::npos) << commandLineOf(server);
}

TEST(NodeForker, killsANodeWithItsDescendants) {
    const auto forker = startForker();
    ForkedPeer peer = forked(*forker);
    const pid_t child = peer.ask('w');
    peer.node->kill();
    EXPECT_EQ(peer.end(), "signal 9 (Killed)");
    EXPECT_TRUE(isGone(child));
}

TEST(NodeForker, closesTheHeadsEndInNodes) {
    const auto forker = startForker();
    ForkedPeer first = forked(*forker), second = forked(*forker);
    first.socket = FileDescriptor(); // another node would keep the connection open
    EXPECT_EQ(first.end(), "exit status 7");
}

TEST(NodeForker, nodesEndWithTheProcessThatForkedThem) {
    const auto forker = startForker();
    ForkedPeer peer = forked(*forker);
    const pid_t node = peer.node->pid();
    ASSERT_EQ(kill(peer.ask('p'), SIGKILL), 0);
    EXPECT_EQ(peer.end(), "signal 9 (Killed), with the process that forked it");
    EXPECT_TRUE(isGone(node));
    int ends[2] = {-1, -1};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
    const FileDescriptor ours(ends[0]), theirs(ends[1]);
    const auto later = forker->fork(theirs.get());
    ASSERT_FALSE(later.ok());
    EXPECT_NE(later.error().message.find("has ended"), std::string::npos) << later.error().message;
}

TEST(NodeForker, endsWithItsLastNode) {
    auto forker = startForker();
    ForkedPeer peer = forked(*forker);
    const pid_t server = peer.ask('p');
    forker.reset();
    EXPECT_EQ(kill(server, 0), 0);
    peer.node.reset();
    EXPECT_TRUE(isGone(server));
}

TEST(NodeForker, refusesADescriptorThatIsNotOpen) { EXPECT_EQ(runForkServer(12345, serve), 1); }

TEST(NodeForker, failsWithoutTheCommand) {
    const auto forker = NodeForker::start("/bin/true");
    ASSERT_TRUE(forker.ok());
    int ends[2] = {-1, -1};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
    const FileDescriptor ours(ends[0]), theirs(ends[1]);
    EXPECT_FALSE((*forker)->fork(theirs.get()).ok());
}

} // namespace
} // namespace mural

int main(int argc, char** argv) {
    if (argc == 4 && std::string(argv[1]) == "fork-nodes")
        return mural::runForkServer(std::atoi(argv[3]), mural::serve);
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
