// Sessions of mural run with a fake head.
#include "tools/mural/run/run_session.hpp"

#include <csignal>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "nodes/launch/process_tree.hpp"
#include "tests/temporary_folder.hpp"

namespace mural::cli {
namespace {

struct Outcome {
    int status = 0;
    std::string words; // messages to the user
};

class RunSession : public ::testing::Test {
protected:
    // A session with a head in this mode and a shell script as the program.
    Outcome run(const std::string& mode, const std::string& script) {
        PreparedRun run;
        run.config.session = "mural-test";
        run.programPath = "/bin/sh";
        run.program = {"sh", "-c", script};
        run.programEnvironment = launch::Environment({"PATH=/usr/bin:/bin", "FOLDER=" + folder_.at("")});
        run.headEnvironment = run.programEnvironment;
        run.headCommand = {MURAL_FAKE_HEAD, mode};
        const int saved = dup(STDERR_FILENO);
        const int errors = memfd_create("heard", MFD_CLOEXEC);
        dup2(errors, STDERR_FILENO);
        Console console(false);
        Outcome outcome;
        outcome.status = runSession(run, console);
        dup2(saved, STDERR_FILENO);
        outcome.words.resize(4096);
        outcome.words.resize(static_cast<size_t>(std::max<ssize_t>(0, pread(errors, outcome.words.data(), 4096, 0))));
        close(saved);
        close(errors);
        return outcome;
    }
    void expectNobodyLeft() {
        for (const auto& p : launch::descendantsOf(getpid(), {})) EXPECT_EQ(p.state, 'Z') << p.pid;
    }
    test::TemporaryFolder folder_;
};

TEST_F(RunSession, returnsTheProgramsStatusAndPrintsTheReport) {
    const Outcome o = run("ok", "exit 7");
    EXPECT_EQ(o.status, 7);
    EXPECT_EQ(o.words, "mural: 3 frames in 1.0 s, 3.0 frames/s, 0 B per frame to each node, 0 round trips\n");
    EXPECT_EQ(run("ok", "kill -ABRT $$").status, 134);
    expectNobodyLeft();
}

TEST_F(RunSession, reportsAHeadThatCannotStartAndRunsNoProgram) {
    Outcome o = run("error", "touch $FOLDER/ran");
    EXPECT_EQ(o.status, 2);
    EXPECT_EQ(o.words, "mural: no GL on this machine\n");
    o = run("mute", "touch $FOLDER/ran");
    EXPECT_EQ(o.status, 2);
    EXPECT_EQ(o.words, "mural: the head process ended before the session began (exit status 0); see mural doctor\n");
    EXPECT_FALSE(std::filesystem::exists(folder_.at("ran")));
    expectNobodyLeft();
}

TEST_F(RunSession, letsTheProgramOutliveItsHead) {
    const Outcome o = run("die", "sleep 0.3; exit 6");
    EXPECT_EQ(o.status, 6);
    EXPECT_EQ(o.words,
              "mural: the head process was lost (signal 9 (Killed)); the program continues alone, without the wall\n");
    expectNobodyLeft();
}

TEST_F(RunSession, endsTheProgramWithSuccessAfterEnoughFrames) {
    EXPECT_EQ(run("frames", "sleep 60").status, 0);
    EXPECT_EQ(run("frames", "sleep 60 & wait").status, 0);
    expectNobodyLeft();
}

TEST_F(RunSession, waitsForAProgramThatLeavesItsLauncher) {
    const Outcome o = run("ok", "(sleep 0.3; touch $FOLDER/late) & exit 3");
    EXPECT_EQ(o.status, 3);
    EXPECT_TRUE(std::filesystem::exists(folder_.at("late")));
    expectNobodyLeft();
}

TEST_F(RunSession, reportsAProgramThatCannotBeExecuted) {
    PreparedRun broken;
    broken.config.session = "mural-test";
    broken.programPath = "/nonexistent/app";
    broken.program = {"app"};
    broken.headEnvironment = launch::Environment({"PATH=/usr/bin:/bin"});
    broken.headCommand = {MURAL_FAKE_HEAD, "ok"};
    Console console(true);
    EXPECT_EQ(runSession(broken, console), 126);
    expectNobodyLeft();
}

} // namespace
} // namespace mural::cli
