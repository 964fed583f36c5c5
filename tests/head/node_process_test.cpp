// Real processes: their environment, input and end.
#include "nodes/launch/launchers/node_process.hpp"

#include <cstdlib>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "nodes/head/membership/node_launcher.hpp"
#include "nodes/launch/launchers/command_launcher.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural {
namespace {

constexpr int64_t kEndPatienceMs = 20'000;

std::optional<std::string> endOf(NodeProcess& process) { return process.waitEnded(Deadline::inMs(kEndPatienceMs)); }

std::unique_ptr<NodeProcess> shell(const std::string& script, const std::string& input = "") {
    auto started = NodeProcess::start({{"sh", "-c", script}, input, -1});
    EXPECT_TRUE(started.ok());
    return started ? std::move(*started) : nullptr;
}

Result<std::vector<LaunchedNode>> launched(const SessionPlan& plan, const std::string& executable,
                                           std::shared_ptr<Launcher> launcher, bool isCancelled = false) {
    LaunchOptions options;
    options.executable = executable;
    options.launcher = std::move(launcher);
    options.patienceMs = kEndPatienceMs;
    StartProgress progress(monotonicNowNs());
    return launchNodes(plan, options, progress, [isCancelled] { return isCancelled; });
}

TEST(NodeProcess, reportsHowItEnded) {
    EXPECT_EQ(endOf(*shell("exit 3")), "exit status 3");
    auto killed = shell("kill -9 $$");
    EXPECT_EQ(endOf(*killed)->rfind("signal 9", 0), 0u);
    auto missing = NodeProcess::start({{"/no/such/program"}, "", -1});
    ASSERT_FALSE(missing.ok());
    EXPECT_NE(missing.error().message.find("/no/such/program"), std::string::npos);
}

TEST(NodeProcess, readsItsInputWithoutTheCaptureEnvironment) {
    setenv("MURAL_SESSION", "x", 1);
    setenv("__GLX_VENDOR_LIBRARY_NAME", "mural", 1);
    auto process = shell("read line; test \"$line\" = secret && test -z \"$MURAL_SESSION$LD_PRELOAD"
                         "$__GLX_VENDOR_LIBRARY_NAME$__EGL_VENDOR_LIBRARY_FILENAMES\"",
                         "secret\n");
    unsetenv("MURAL_SESSION");
    unsetenv("__GLX_VENDOR_LIBRARY_NAME");
    EXPECT_EQ(endOf(*process), "exit status 0");
}

TEST(NodeProcess, killsItsDescendants) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const FileDescriptor reader(ends[0]);
    FileDescriptor writer(ends[1]);
    auto started =
        NodeProcess::start({{"sh", "-c", "sleep 1000 & echo x >&" + std::to_string(ends[1]) + "; wait"}, "", ends[1]});
    ASSERT_TRUE(started.ok());
    writer = FileDescriptor();
    char byte = 0;
    ASSERT_EQ(read(reader.get(), &byte, 1), 1); // both run
    const pid_t pid = (*started)->pid();
    started->reset();
    EXPECT_EQ(kill(pid, 0), -1) << "left behind";
    // The pipe ends after the last process that holds it.
    pollfd end{reader.get(), POLLIN, 0};
    ASSERT_EQ(poll(&end, 1, static_cast<int>(kEndPatienceMs)), 1);
    while (read(reader.get(), &byte, 1) > 0) {}
}

TEST(NodeLauncher, reportsANodeThatEndsAtOnceInOneLine) {
    SessionConfig config;
    config.hosts = {"localhost"};
    const SessionPlan plan = planSession(config, "here");
    const auto nodes = launched(plan, "/bin/false", nullptr);
    ASSERT_FALSE(nodes.ok());
    EXPECT_NE(nodes.error().message.find("node 0 (localhost) did not start: exit status 1"), std::string::npos)
        << nodes.error().message;
}

TEST(NodeLauncher, usesTheLaunchCommandForAnotherHost) {
    SessionConfig config;
    config.hosts = {"elsewhere.invalid"};
    const SessionPlan plan = planSession(config, "here");
    NodeBinary binary;
    binary.program = "/opt/my mural";
    const auto launcher = std::make_shared<CommandLauncher>(
        std::vector<std::string>{"sh", "-c", "echo \"host $0, arguments $*\" >&2; exit 7"}, binary);
    const auto nodes = launched(plan, "/bin/false", launcher);
    ASSERT_FALSE(nodes.ok());
    for (const char* part : {"(elsewhere.invalid) did not start: exit status 7 of \"sh -c ", "host elsewhere.invalid, ",
                             "'/opt/my mural' node --as node0 --connect "})
        EXPECT_NE(nodes.error().message.find(part), std::string::npos) << nodes.error().message;
}

TEST(NodeLauncher, stopsWhenTheSessionIsCancelled) {
    SessionConfig config;
    config.hosts = {"localhost"};
    const SessionPlan plan = planSession(config, "here");
    auto sleeper = launched(plan, "/bin/cat", nullptr, true);
    ASSERT_FALSE(sleeper.ok());
}

} // namespace
} // namespace mural
