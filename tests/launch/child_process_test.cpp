// Child processes: environment, descriptors, signals, exit status.
#include "nodes/launch/child_process.hpp"

#include <csignal>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

namespace mural::launch {
namespace {

SpawnRequest shell(const std::string& script) {
    SpawnRequest request;
    request.file = "/bin/sh";
    request.arguments = {"sh", "-c", script};
    request.environment = {"PATH=/usr/bin:/bin"};
    return request;
}

std::string contentOf(int fd) {
    std::string text(4096, '\0');
    text.resize(static_cast<size_t>(std::max<ssize_t>(0, pread(fd, text.data(), text.size(), 0))));
    return text;
}

ChildProcess ended(const SpawnRequest& request) {
    auto child = ChildProcess::start(request);
    EXPECT_TRUE(child.ok()) << (child.ok() ? "" : child.error().message);
    EXPECT_TRUE(child.value().waitUntil(Deadline::inMs(10'000)));
    return child.value();
}

TEST(ChildProcess, reportsItsEndLikeAShell) {
    EXPECT_EQ(ended(shell("exit 7")).exitStatus(), 7);
    const ChildProcess killed = ended(shell("kill -9 $$"));
    EXPECT_EQ(killed.exitStatus(), 137);
    EXPECT_EQ(killed.describeEnd(), "signal 9 (Killed)");
}

TEST(ChildProcess, explainsAFailedExec) {
    SpawnRequest request = shell("");
    request.file = "/nonexistent/program";
    const auto child = ChildProcess::start(request);
    ASSERT_FALSE(child.ok());
    EXPECT_EQ(child.error().message, "/nonexistent/program cannot be executed: No such file or directory");
}

TEST(ChildProcess, hasExactlyTheGivenEnvironmentAndDescriptors) {
    const int output = memfd_create("output", MFD_CLOEXEC);
    const int inherited = memfd_create("kept", MFD_CLOEXEC);
    const int other = memfd_create("other", MFD_CLOEXEC);
    SpawnRequest request = shell("env; [ -e /proc/self/fd/" + std::to_string(inherited) +
                                 " ] && echo kept; [ -e /proc/self/fd/" + std::to_string(other) + " ] && echo other");
    request.environment = {"PATH=/usr/bin:/bin", "ONLY=this"};
    request.inheritedFds = {inherited};
    request.outputFd = output;
    ended(request);
    const std::string text = contentOf(output);
    EXPECT_NE(text.find("ONLY=this\n"), std::string::npos);
    EXPECT_EQ(text.find("HOME="), std::string::npos);
    EXPECT_NE(text.find("kept\n"), std::string::npos);
    EXPECT_EQ(text.find("other\n"), std::string::npos);
    for (const int fd : {output, inherited, other}) close(fd);
}

TEST(ChildProcess, inheritsTheOriginalSignals) {
    rememberSignals();
    sigset_t block;
    sigemptyset(&block);
    sigaddset(&block, SIGTERM);
    sigprocmask(SIG_BLOCK, &block, nullptr);
    const int status = ended(shell("kill -TERM $$; exit 0")).exitStatus();
    sigprocmask(SIG_UNBLOCK, &block, nullptr);
    EXPECT_EQ(status, 128 + SIGTERM);
}

TEST(ChildProcess, isKilledWhenItIgnoresItsEnd) {
    const int output = memfd_create("output", MFD_CLOEXEC);
    SpawnRequest request = shell("trap '' TERM; echo deaf; while :; do sleep 0.05; done");
    request.outputFd = output;
    auto child = ChildProcess::start(request);
    ASSERT_TRUE(child.ok());
    const Deadline deadline = Deadline::inMs(10'000);
    while (contentOf(output).empty() && !deadline.passed()) {}
    child.value().end(Deadline::inMs(100));
    EXPECT_FALSE(child.value().running());
    EXPECT_EQ(child.value().exitStatus(), 128 + SIGKILL);
    close(output);
}

} // namespace
} // namespace mural::launch
