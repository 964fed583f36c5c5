// The choice of --launch auto, and the hosts of nodes.
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tools/mural/run/run_option_readers.hpp"
#include "tools/mural/run/slurm_allocation.hpp"

namespace mural::cli {
namespace {

using Names = std::vector<std::string>;

struct Choice {
    SessionConfig config;
    std::string why, error;
};

Choice chosen(const RunArguments& arguments, const Names& environment) {
    Choice choice;
    choice.config.columns = choice.config.rows = 2; // read before
    auto why = readLaunch(arguments, launch::Environment(environment), choice.config);
    if (why)
        choice.why = *why;
    else
        choice.error = why.error().message;
    return choice;
}

RunArguments newRun() {
    RunArguments arguments;
    arguments.startsNodes = true;
    arguments.tiles = "2x2";
    return arguments;
}

const Names kJob = {"SLURM_JOB_ID=7", "SLURM_JOB_NODELIST=wall[1-6]"};

TEST(LaunchOptions, usesNoOtherHostsByDefault) {
    const Choice c = chosen(newRun(), {});
    EXPECT_EQ(c.error, "");
    EXPECT_EQ(c.why, "");
    EXPECT_TRUE(c.config.hosts.empty());
}

TEST(LaunchOptions, takesTheHostsOfTheJobForItsTiles) {
    const Choice c = chosen(newRun(), kJob);
    EXPECT_EQ(c.config.launchCommand, "slurm");
    EXPECT_EQ(c.config.hosts, (Names{"wall1", "wall2", "wall3", "wall4"}));
    EXPECT_EQ(c.why, "nodes start by slurm: Slurm job 7 has the hosts wall1,wall2,wall3,wall4,wall5,wall6");
    RunArguments two = newRun();
    two.perHost = "2";
    EXPECT_EQ(chosen(two, kJob).config.hosts, (Names{"wall1", "wall1", "wall2", "wall2"}));
}

TEST(LaunchOptions, leavesTheJobOfThisMachineAlone) {
    char name[256] = "";
    gethostname(name, sizeof(name) - 1);
    const Choice c = chosen(newRun(), {"SLURM_JOB_ID=7", std::string("SLURM_JOB_NODELIST=") + name});
    EXPECT_TRUE(c.config.hosts.empty());
    RunArguments local = newRun();
    local.localNodes = "4";
    EXPECT_TRUE(chosen(local, kJob).config.hosts.empty());
    RunArguments change = newRun();
    change.startsNodes = false; // mural change
    EXPECT_TRUE(chosen(change, kJob).config.hosts.empty());
}

TEST(LaunchOptions, usesSlurmForHostsOfTheJobAndSshForOthers) {
    RunArguments a = newRun();
    a.nodes = "wall2,wall3";
    EXPECT_EQ(chosen(a, kJob).config.launchCommand, "slurm");
    EXPECT_EQ(chosen(a, {}).config.launchCommand, "ssh");
    a.nodes = "wall2,elsewhere";
    EXPECT_EQ(chosen(a, kJob).config.launchCommand, "ssh");
    a.launch = "ssh -p 2222";
    EXPECT_EQ(chosen(a, kJob).config.launchCommand, "ssh -p 2222");
}

TEST(LaunchOptions, takesTheRanksOfMpirun) {
    const Names ranks = {"PMIX_RANK=0", "OMPI_COMM_WORLD_SIZE=3", "SLURM_JOB_ID=7", "SLURM_JOB_NODELIST=wall[1-6]"};
    const Choice c = chosen(newRun(), ranks);
    EXPECT_EQ(c.config.launchCommand, "pmix");
    EXPECT_EQ(c.config.hosts, (Names{"rank1", "rank2"}));
    // an interactive shell of srun is a single process
    EXPECT_EQ(chosen(newRun(), {"PMIX_RANK=0", "SLURM_STEP_NUM_TASKS=1"}).config.launchCommand, "ssh");
    RunArguments pmix = newRun();
    pmix.launch = "pmix";
    EXPECT_NE(chosen(pmix, {}).error.find("PMIX_RANK is not set"), std::string::npos);
}

TEST(LaunchOptions, startsLocalNodesOnRequest) {
    RunArguments a = newRun();
    a.nodes = "wall2,wall3";
    a.launch = "local";
    const Choice c = chosen(a, kJob);
    EXPECT_EQ(c.config.localNodes, 2);
    EXPECT_TRUE(c.config.hosts.empty());
}

TEST(LaunchOptions, readsAHostFile) {
    const std::string file = testing::TempDir() + "hosts." + std::to_string(getpid());
    std::ofstream(file) << "wall1 slots=2\nwall3\n";
    RunArguments a = newRun();
    a.hostFile = file;
    EXPECT_EQ(chosen(a, {}).config.hosts, (Names{"wall1", "wall1", "wall3"}));
    a.perHost = "1";
    EXPECT_EQ(chosen(a, {}).config.hosts, (Names{"wall1", "wall3"}));
    a.nodes = "wall1";
    EXPECT_NE(chosen(a, {}).error.find("--nodes and --hostfile"), std::string::npos);
    unlink(file.c_str());
}

TEST(LaunchOptions, namesWrongOptions) {
    const auto refusal = [](const std::function<void(RunArguments&)>& change) {
        RunArguments a = newRun();
        change(a);
        return chosen(a, {}).error;
    };
    EXPECT_NE(refusal([](RunArguments& a) { a.launch = "slurm"; }).find("SLURM_JOB_ID is not set"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.launch = " "; }).find("--launch"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.nodes = "@wall1"; }).find("--secret FILE"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.perHost = "2"; }).find("--per-host needs hosts"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.startTimeout = "0"; }).find("--start-timeout"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.hostFile = "/no/such/file"; }).find("/no/such/file"), std::string::npos);
}

TEST(SlurmAllocation, runsTheSameCommandInANewJob) {
    const Names program{"app", "--slurm", "x"};
    const Names wanted{"salloc",
                       "--job-name=mural",
                       "--kill-command=TERM",
                       "-N4",
                       "-t",
                       "60",
                       "/bin/mural",
                       "run",
                       "--tiles",
                       "2x2",
                       "--",
                       "app",
                       "--slurm",
                       "x"};
    for (const Names& separator : {Names{}, Names{"--"}}) {
        Names arguments{"run", "--slurm", "-N4 -t 60", "--tiles", "2x2"};
        arguments.insert(arguments.end(), separator.begin(), separator.end());
        arguments.insert(arguments.end(), program.begin(), program.end());
        EXPECT_EQ(sallocCommandOf("/bin/mural", arguments, program, "-N4 -t 60"), wanted);
    }
}

} // namespace
} // namespace mural::cli
