// Launchers without their servers: host lists, messages, commands, and a real starter with shell commands as nodes.
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>

#include "nodes/launch/launchers/command_launcher.hpp"
#include "nodes/launch/launchers/create_launcher.hpp"
#include "nodes/launch/launchers/host_list.hpp"
#include "nodes/launch/launchers/pmix_client.hpp"
#include "nodes/launch/launchers/recent_lines.hpp"
#include "nodes/launch/launchers/shell_words.hpp"
#include "nodes/launch/launchers/slurm_launcher.hpp"
#include "nodes/launch/launchers/starter/starter_link.hpp"
#include "nodes/launch/launchers/starter/starter_protocol.hpp"

namespace mural {
namespace {

using Names = std::vector<std::string>;

constexpr int64_t kPatienceMs = 20'000;

Names expanded(std::string_view text) {
    auto hosts = launch::expandHostList(text);
    EXPECT_TRUE(hosts.ok()) << text;
    return hosts ? hosts.value() : Names();
}

TEST(HostList, expandsTheFormsOfSlurm) {
    EXPECT_EQ(expanded("wall1"), (Names{"wall1"}));
    EXPECT_EQ(expanded("a,b"), (Names{"a", "b"}));
    EXPECT_EQ(expanded("wall[1-3,7],gpu2"), (Names{"wall1", "wall2", "wall3", "wall7", "gpu2"}));
    EXPECT_EQ(expanded("n[08-11]"), (Names{"n08", "n09", "n10", "n11"}));
    EXPECT_EQ(expanded("r[1-2]n[1-2]x"), (Names{"r1n1x", "r1n2x", "r2n1x", "r2n2x"}));
    EXPECT_EQ(expanded("n[001]"), (Names{"n001"}));
}

TEST(HostList, rejectsOtherText) {
    for (const char* bad :
         {"", "a,,b", "n[1-", "n1]", "n[a-b]", "n[3-1]", "n[]", "n[1-99999999]", "n[1-9999]m[1-9999]"})
        EXPECT_FALSE(launch::expandHostList(bad).ok()) << bad;
}

TEST(HostFile, readsHostsWithTheirNodes) {
    const auto hosts =
        launch::hostsOfFile("# wall\nwall1\n\nwall2 slots=4 max_slots=8 # two GPUs\nwall3:2\nfe80::1\nuser@wall4", "f");
    ASSERT_TRUE(hosts.ok()) << hosts.error().message;
    std::string text;
    for (const auto& host : hosts.value()) text += host.name + "/" + std::to_string(host.nodes) + " ";
    EXPECT_EQ(text, "wall1/0 wall2/4 wall3/2 fe80::1/0 user@wall4/0 ");
}

TEST(HostFile, namesFileAndLineOfAnError) {
    const auto refusal = [](std::string_view text) {
        const auto hosts = launch::hostsOfFile(text, "my/hosts");
        return hosts ? std::string() : hosts.error().message;
    };
    EXPECT_EQ(refusal("a\n-oProxyCommand=x\n").rfind("my/hosts:2: ", 0), 0U);
    EXPECT_EQ(refusal("a\nb slots=0").rfind("my/hosts:2: \"slots=0\"", 0), 0U);
    EXPECT_EQ(refusal("a b").rfind("my/hosts:1: ", 0), 0U);
    EXPECT_EQ(refusal("# nothing\n").rfind("my/hosts: ", 0), 0U);
}

TEST(StarterProtocol, readsItsOwnLines) {
    launch::StarterRequest start;
    start.kind = launch::StarterRequest::Kind::Start;
    start.id = 3;
    start.host = "wall1";
    start.name = "node2";
    start.endpoint = "10.0.0.1:4711,[fe80::1]:4711";
    start.secret = "00ff";
    const auto read = launch::starterRequestOf(lineOf(start));
    ASSERT_TRUE(read);
    EXPECT_EQ(lineOf(*read), "start 3 wall1 node2 10.0.0.1:4711,[fe80::1]:4711 00ff");
    launch::StarterReply says;
    says.id = 3;
    says.text = "two  words ";
    const auto reply = launch::starterReplyOf(lineOf(says));
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->text, "two  words ");
    EXPECT_EQ(launch::starterReplyOf("started 3 77\r")->pid, 77);
}

TEST(StarterProtocol, ignoresOtherLines) {
    for (const char* line : {"", "Welcome to wall1", "start", "start x * a b c", "start 1 * a b", "start 1 * a b c d",
                             "stop -1", "alive 1", "sealed wall1"})
        EXPECT_FALSE(launch::starterRequestOf(line)) << line;
    for (const char* line : {"", "Welcome to wall1", "mural-starter 1", "started 1", "started 1 x", "ended"})
        EXPECT_FALSE(launch::starterReplyOf(line)) << line;
}

TEST(RecentLines, keepsTheLastFiveWithoutControlCharacters) {
    launch::RecentLines lines;
    for (const char* line : {"0", "1", "2", "", "3", "4\x1b[2J", "5\r"}) lines.add(line);
    EXPECT_EQ(lines.text(), "1 | 2 | 3 | 4 [2J | 5");
}

TEST(ShellWords, quotesForAShell) {
    EXPECT_EQ(launch::quoted("/usr/bin/mural"), "/usr/bin/mural");
    EXPECT_EQ(launch::quoted("/opt/my mural's"), "'/opt/my mural'\\''s'");
    EXPECT_EQ(launch::quoted(""), "''");
}

TEST(SlurmLauncher, readsItsJobFromTheEnvironment) {
    auto job = slurmJobOf(launch::Environment({"SLURM_JOB_ID=12", "SLURM_JOB_NODELIST=wall[1-2]"}));
    ASSERT_TRUE(job.ok());
    EXPECT_EQ(job->id, "12");
    EXPECT_EQ(job->hosts, (Names{"wall1", "wall2"}));
    EXPECT_FALSE(slurmJobOf(launch::Environment()).ok());
    EXPECT_FALSE(slurmJobOf(launch::Environment({"SLURM_JOB_ID=12", "SLURM_JOB_NODELIST=wall["})).ok());
}

TEST(SlurmLauncher, findsTheHostsThatAreLost) {
    EXPECT_EQ(hostsLostIn("srun: error: wall2: task 1: Killed"), (Names{"wall2"}));
    EXPECT_EQ(hostsLostIn("srun: error: wall[1-2]: tasks 0-1: Exited with exit code 3"), (Names{"wall1", "wall2"}));
    EXPECT_EQ(hostsLostIn("srun: error: Node failure on wall3"), (Names{"wall3"}));
    EXPECT_TRUE(hostsLostIn("srun: error: Unable to create step").empty());
    EXPECT_TRUE(hostsLostIn("wall2: task 1: Killed").empty());
}

TEST(SlurmLauncher, addsARemedyToRefusals) {
    EXPECT_NE(srunRemedy("srun: Job 5 step creation temporarily disabled, retrying").find("--overlap"),
              std::string::npos);
    EXPECT_NE(srunRemedy("srun: error: Unable to confirm allocation for job 5: Invalid job id").find("has ended"),
              std::string::npos);
    EXPECT_EQ(srunRemedy("something else"), "");
}

TEST(PmixClient, findsItsPlaceInTheEnvironment) {
    const launch::PmixPlace place = launch::pmixPlaceOf(launch::Environment({"PMIX_RANK=2", "OMPI_COMM_WORLD_SIZE=5"}));
    EXPECT_EQ(place.rank, 2);
    EXPECT_EQ(place.size, 5);
    EXPECT_EQ(launch::pmixPlaceOf(launch::Environment()).rank, -1);
}

TEST(CreateLauncher, needsAJobForSlurm) {
    LaunchSettings settings;
    settings.how = "slurm";
    const auto launcher = createLauncher(settings, launch::Environment());
    ASSERT_FALSE(launcher.ok());
    EXPECT_NE(launcher.error().message.find("SLURM_JOB_ID"), std::string::npos);
}

// A link whose command is a shell script in the role of ssh and a starter.
std::shared_ptr<launch::StarterLink> linkOf(const std::string& script) {
    signal(SIGPIPE, SIG_IGN); // as in the head
    launch::StarterCommand command;
    command.arguments = {"sh", "-c", script};
    command.environment = launch::Environment::current().entries();
    command.name = "test";
    command.version = "1";
    command.build = "b";
    command.onlyHost = "wall1";
    command.lostHosts = hostsLostIn;
    auto link = launch::StarterLink::start(std::move(command));
    EXPECT_TRUE(link.ok());
    return link ? *link : nullptr;
}

std::unique_ptr<RunningNode> nodeOf(launch::StarterLink& link) {
    auto prepared = link.prepare({1, "wall1", "node1", "h:1", "5ec4e7"}, "*");
    link.send(prepared.line);
    return std::move(prepared.node);
}

TEST(StarterLink, passesOnTheEndOfANode) {
    const auto link = linkOf("echo Welcome; echo mural-starter 1 b wall1; read line; echo started 1 77; echo says 1 no "
                             "GL; echo ended 1 exit status 4; cat");
    const auto node = nodeOf(*link);
    EXPECT_EQ(node->waitEnded(Deadline::inMs(kPatienceMs)), "exit status 4");
    EXPECT_EQ(node->pid(), 77);
    EXPECT_EQ(node->details(), ": no GL");
    EXPECT_FALSE(link->ended());
}

TEST(StarterLink, describesTheEndOfItsCommand) {
    const auto link = linkOf("echo no route to wall1 >&2; exit 255");
    const auto node = nodeOf(*link);
    EXPECT_EQ(node->waitEnded(Deadline::inMs(kPatienceMs)), "exit status 255");
    EXPECT_EQ(node->details(), " of \"sh -c echo no route to wall1 >&2; exit 255\": no route to wall1");
    EXPECT_TRUE(link->isGone("wall1"));
}

TEST(StarterLink, refusesAnotherVersion) {
    const auto link = linkOf("echo mural-starter 2 b wall1; cat");
    const auto node = nodeOf(*link);
    EXPECT_EQ(node->waitEnded(Deadline::inMs(kPatienceMs))
                  .value_or("")
                  .rfind("wall1 has mural 2 (stream b), but this machine has 1", 0),
              0U);
    EXPECT_TRUE(link->isGone("wall1"));
}

TEST(StarterLink, losesTheHostsThatItsCommandReports) {
    const auto link = linkOf("echo srun: error: wall1: task 0: Killed >&2; cat");
    const auto node = nodeOf(*link);
    EXPECT_EQ(node->waitEnded(Deadline::inMs(kPatienceMs)), "srun: error: wall1: task 0: Killed");
    EXPECT_FALSE(link->isGone("wall2"));
}

TEST(StarterLink, endsItsCommandWithItsInput) {
    const std::string file = testing::TempDir() + "ended." + std::to_string(getpid());
    {
        const auto link = linkOf("echo mural-starter 1 b wall1; cat; echo over >" + file);
        const auto node = nodeOf(*link);
        const Deadline deadline = Deadline::inMs(kPatienceMs);
        while (!link->isGone("wall1") && node->pid() == 0 && link->recentOutput().empty() && !deadline.passed())
            poll(nullptr, 0, 5);
    }
    std::ifstream text(file);
    std::string word;
    text >> word;
    EXPECT_EQ(word, "over");
    unlink(file.c_str());
}

} // namespace
} // namespace mural
