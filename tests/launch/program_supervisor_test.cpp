// Supervision of a program and its children: signals and exit status.
#include "nodes/launch/program_supervisor.hpp"

#include <csignal>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

namespace mural::launch {
namespace {

class Supervisor : public ::testing::Test {
protected:
    void SetUp() override {
        auto created = ProgramSupervisor::create();
        ASSERT_TRUE(created.ok());
        supervisor_ = std::move(created.value());
    }
    void TearDown() override {
        supervisor_->end(0);
        waitFor([&] { return !supervisor_->anyoneLeft(); });
        EXPECT_FALSE(supervisor_->anyoneLeft());
        close(output_);
    }
    void start(const std::string& script) {
        SpawnRequest request;
        request.file = "/bin/sh";
        request.arguments = {"sh", "-c", script};
        request.environment = {"PATH=/usr/bin:/bin"};
        request.outputFd = output_;
        ASSERT_TRUE(supervisor_->start(request).ok());
    }
    template <class Done> bool waitFor(Done done) {
        const Deadline deadline = Deadline::inMs(10'000);
        while (!done() && !deadline.passed()) {
            pollfd waiting{supervisor_->signalFd(), POLLIN, 0};
            poll(&waiting, 1, 10);
            supervisor_->tick();
        }
        return done();
    }
    std::string output() {
        std::string text(4096, '\0');
        text.resize(static_cast<size_t>(std::max<ssize_t>(0, pread(output_, text.data(), text.size(), 0))));
        return text;
    }
    int output_ = memfd_create("output", MFD_CLOEXEC);
    std::unique_ptr<ProgramSupervisor> supervisor_;
};

TEST_F(Supervisor, returnsTheExitStatus) {
    start("exit 5");
    EXPECT_TRUE(waitFor([&] { return !supervisor_->programRunning(); }));
    EXPECT_EQ(supervisor_->exitStatus(), 5);
}

TEST_F(Supervisor, tracksOrphanedProcesses) {
    start("sleep 60 & exit 3");
    EXPECT_TRUE(waitFor([&] { return !supervisor_->programRunning(); }));
    EXPECT_EQ(supervisor_->exitStatus(), 3);
    EXPECT_TRUE(supervisor_->anyoneLeft());
}

TEST_F(Supervisor, forwardsAnInterruptFromAnotherProcess) {
    start("trap 'echo interrupted; exit 4' INT; echo ready; while :; do sleep 0.02; done");
    ASSERT_TRUE(waitFor([&] { return output() == "ready\n"; }));
    kill(getpid(), SIGINT);
    EXPECT_TRUE(waitFor([&] { return !supervisor_->programRunning(); }));
    EXPECT_EQ(supervisor_->exitStatus(), 4);
    EXPECT_FALSE(supervisor_->stopRequested());
}

TEST_F(Supervisor, endsTheProgramAndItsChildrenOnTermination) {
    start("sleep 60 & echo ready; wait");
    ASSERT_TRUE(waitFor([&] { return output() == "ready\n"; }));
    kill(getpid(), SIGTERM);
    EXPECT_TRUE(waitFor([&] { return !supervisor_->programRunning() && !supervisor_->anyoneLeft(); }));
    EXPECT_EQ(supervisor_->exitStatus(), 128 + SIGTERM);
    EXPECT_EQ(supervisor_->stopSignal(), SIGTERM);
}

TEST_F(Supervisor, killsProcessesThatIgnoreTheirEnd) {
    start("trap '' TERM; echo ready; while :; do sleep 0.02; done");
    ASSERT_TRUE(waitFor([&] { return output() == "ready\n"; }));
    supervisor_->end(50);
    EXPECT_TRUE(waitFor([&] { return !supervisor_->programRunning(); }));
    EXPECT_EQ(supervisor_->exitStatus(), 128 + SIGKILL);
}

TEST_F(Supervisor, ignoresMuralsOwnProcesses) {
    SpawnRequest request;
    request.file = "/bin/sh";
    request.arguments = {"sh", "-c", "sleep 60 & wait"};
    request.environment = {"PATH=/usr/bin:/bin"};
    request.ownSession = true;
    auto own = ChildProcess::start(request);
    ASSERT_TRUE(own.ok());
    supervisor_->leaveAlone(own.value().pid());
    EXPECT_FALSE(supervisor_->anyoneLeft());
    supervisor_->end(0);
    supervisor_->tick();
    EXPECT_TRUE(own.value().running());
    own.value().signal(SIGKILL); // its sleep is now an orphan in our session
    EXPECT_TRUE(waitFor([&] { return !own.value().running(); }));
    EXPECT_FALSE(supervisor_->anyoneLeft());
    own.value().signalGroup(SIGKILL);
}

} // namespace
} // namespace mural::launch
