// The head with nodes in separate processes: this program, started again as `… node …`.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iostream>

#include "nodes/session/session_secret.hpp"
#include "tests/head/support/session_harness.hpp"
#include "transport/secure/secure_connection.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural {
namespace {

std::string ownPath() { return std::filesystem::read_symlink("/proc/self/exe"); }

// Accepts the options of `mural node`: --connect-fd N, or --name NAME --connect HOST:PORT.
std::unique_ptr<Connection> connectAs(const std::vector<std::string>& arguments) {
    if (arguments[0] == "--connect-fd") {
        auto shared = openSharedMemory(std::stoi(arguments[1]));
        return shared ? std::move(*shared) : nullptr;
    }
    std::string line;
    std::getline(std::cin, line);
    auto secret = sessionSecretFromHex(line);
    auto where = splitHostPort(arguments[3]);
    auto tcp = connectTcp(where->host, where->port, Deadline::inMs(kTestPatienceMs));
    if (!secret || !tcp) return nullptr;
    auto secure = SecureConnection::connecting(std::move(*tcp), arguments[1], *secret, Deadline::inMs(kTestPatienceMs));
    return secure ? std::move(*secure) : nullptr;
}

bool swapFrames(FakeProgram& program, uint32_t from, uint32_t to) {
    for (uint32_t frame = from; frame <= to; ++frame)
        if (!program.publish(kFakeSwap, {frame, 1, 64, 48})) return false;
    return true;
}

// The number of unreaped child processes.
int childrenLeft() {
    int count = 0;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        std::ifstream children(task.path() / "children");
        for (pid_t pid = 0; children >> pid;) ++count;
    }
    return count;
}

// kill() returns before the process has stopped.
bool stopped(pid_t pid) {
    if (kill(pid, SIGSTOP) != 0) return false;
    const Deadline deadline = Deadline::inMs(kTestPatienceMs);
    while (!deadline.passed()) {
        std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
        std::string number, name, state;
        if (stat >> number >> name >> state && state == "T") return true;
        std::this_thread::yield();
    }
    return false;
}

int64_t descriptorsOpen() {
    const auto folder = std::filesystem::directory_iterator("/proc/self/fd");
    return std::distance(begin(folder), end(folder));
}

TEST(ProcessSession, combinesNodesOverSharedMemoryAndTcp) {
    const int64_t before = descriptorsOpen();
    {
        SessionHarness head(3);
        head.config.localNodes = 1;
        head.config.hosts = {"localhost", "127.0.0.1"};
        head.startProcesses(ownPath());
        const auto ready = head.waitFor("ready");
        EXPECT_EQ(ready["nodes"][0]["where"], "local");
        EXPECT_EQ(ready["nodes"][1]["where"], "localhost");
        FakeProgram program;
        ASSERT_TRUE(program.connect(head.config.session));
        ASSERT_TRUE(swapFrames(program, 1, 50));
        EXPECT_TRUE(program.waitFramesDone(50));
        ASSERT_TRUE(program.publish(kFakePixels, {1, 0, 0, 64, 48}));
        FakeProgram::Answer answer;
        ASSERT_TRUE(program.readAnswer(answer));
        EXPECT_EQ(answer.header.w, 64);
        const auto report = head.finish();
        EXPECT_EQ(report["frames"], 50);
        for (const auto& node : report["nodes"]) EXPECT_EQ(node["lost"], false);
    }
    EXPECT_EQ(childrenLeft(), 0);
    EXPECT_EQ(descriptorsOpen(), before);
}

TEST(ProcessSession, reportsTheSignalOfAKilledNode) {
    for (const bool tcp : {false, true}) {
        SessionHarness head(2);
        if (tcp) {
            head.config.localNodes = 1;
            head.config.hosts = {"localhost"};
        }
        head.startProcesses(ownPath());
        const auto ready = head.waitFor("ready");
        FakeProgram program;
        ASSERT_TRUE(program.connect(head.config.session));
        ASSERT_TRUE(swapFrames(program, 1, 3));
        ASSERT_TRUE(program.waitFramesDone(3));
        const pid_t victim = ready["nodes"][1]["pid"];
        ASSERT_EQ(kill(victim, SIGKILL), 0);
        ASSERT_TRUE(swapFrames(program, 4, 30));
        EXPECT_TRUE(program.waitFramesDone(30));
        const std::string message = head.waitForMessage("was lost");
        const std::string expected = std::string("node 1 (") + (tcp ? "localhost" : "local") + ", pid " +
                                     std::to_string(victim) + ") was lost: signal 9";
        EXPECT_EQ(message.rfind(expected, 0), 0u) << message;
        const auto report = head.finish();
        EXPECT_EQ(report["nodes"][1]["lost"], true);
        EXPECT_EQ(report["frames"], 30);
        EXPECT_EQ(childrenLeft(), 0);
    }
}

TEST(ProcessSession, endsStoppedNodesWithTheSession) {
    SessionHarness head(2);
    head.options.goodbyePatienceMs = 3000;
    head.startProcesses(ownPath());
    const auto ready = head.waitFor("ready");
    ASSERT_TRUE(stopped(ready["nodes"][0]["pid"]));
    const auto report = head.finish();
    EXPECT_EQ(report["nodes"][0]["lost"], true);
    EXPECT_EQ(report["nodes"][1]["lost"], false);
    EXPECT_EQ(childrenLeft(), 0);
}

} // namespace

int nodeMain(const std::vector<std::string>& arguments) {
    auto connection = connectAs(arguments);
    if (!connection) return 1;
    FakeNode node(std::move(connection), {});
    node.waitEnd();
    return 0;
}

} // namespace mural

int main(int argc, char** argv) {
    if (argc >= 4 && std::string(argv[1]) == "node") return mural::nodeMain({argv + 2, argv + argc});
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
