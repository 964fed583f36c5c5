// Findings of mural doctor --nodes from measurements, and its table.
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/temporary_folder.hpp"
#include "tools/mural/hosts/fix_script.hpp"
#include "tools/mural/hosts/hosts_table.hpp"
#include "tools/mural/hosts/hosts_verdict.hpp"

namespace mural::cli {
namespace {

constexpr uint64_t kGiB = uint64_t{1} << 30;

HostExamined goodHost(const std::string& name) {
    HostExamined x;
    x.host = x.network.host = name;
    x.network.hasStream = false;
    x.network.version = "1";
    x.network.reached = "10.0.0.1";
    x.network.own = "10.0.0.2";
    x.network.facts.interface = "eth0";
    x.network.facts.mtuBytes = 1500;
    x.network.facts.multicast = true;
    x.network.facts.bufferBytes = 8 << 20;
    for (const ProbePath p : kProbePaths) x.network.path(p) = {true, true, true, 1472, {}};
    x.clock = {true, 0.001, 0.0002};
    x.toHost.bytesPerS = x.fromHost.bytesPerS = 1e8;
    HostFacts& f = x.machine;
    f.build = "b1";
    f.glUsed = "EGL";
    f.renderer = "llvmpipe";
    f.glVersion = "4.5 Mesa 22.3.6";
    f.devices = {{"device 0", "llvmpipe", "", "", "", true}};
    f.displays = {{":0", "", {1920, 1080, {{"HDMI-1", 0, 0, 1920, 1080, 0, 0}}}}};
    f.openFiles = 1024;
    f.sharedMemoryBytes = f.memoryBytes = kGiB;
    f.recordingFreeBytes = 10 * kGiB;
    return x;
}

HostsSurvey surveyOf(std::vector<HostExamined> hosts) {
    HostsSurvey s;
    s.build = "b1";
    s.here.version = "1";
    s.here.facts = hosts.front().network.facts;
    s.here.group = "239.255.77.85:4277";
    s.here.cardBytes = 1472;
    s.hosts = std::move(hosts);
    return s;
}

// Names of the findings of a host.
std::vector<std::string> findings(const HostExamined& x,
                                  const std::map<std::string, std::vector<ExpectedScreen>>& expected = {}) {
    std::vector<std::string> names;
    const std::vector<HostChecks> hosts = judgeHosts(surveyOf({x}), expected);
    for (const Check& c : hosts.front().checks)
        if (c.health != Health::Ok) {
            names.push_back(c.name);
            EXPECT_FALSE(c.advice.empty()) << c.name;
        }
    return names;
}

using Names = std::vector<std::string>;

TEST(HostsVerdict, findsNothingOnAGoodHost) {
    EXPECT_EQ(findings(goodHost("wall1")), Names{});
    EXPECT_EQ(worstOf(judgeHosts(surveyOf({goodHost("wall1")}), {})), Health::Ok);
}

TEST(HostsVerdict, reportsAHostThatCannotBeStartedAndNothingElse) {
    HostExamined x = goodHost("wall1");
    x.failure = "the test process ended: exit status 255, user@wall1: Permission denied (publickey).";
    const auto checks = judgeHosts(surveyOf({x}), {}).front().checks;
    ASSERT_EQ(checks.size(), 1u);
    EXPECT_EQ(checks[0].advice, "`ssh-copy-id wall1`");
}

TEST(HostsVerdict, findsEachFaultAlone) {
    HostExamined x = goodHost("wall1");
    x.clock.offsetS = 0.02;
    EXPECT_EQ(findings(x), Names{"clock"});
    x = goodHost("wall1");
    x.machine.build = "b2";
    EXPECT_EQ(findings(x), Names{"build"});
    x = goodHost("wall1");
    x.network.version = "2";
    EXPECT_EQ(findings(x), Names{"version"});
    x = goodHost("wall1");
    x.machine.eglProblem = "no EGL";
    EXPECT_EQ(findings(x), Names{"EGL"});
    x = goodHost("wall1");
    x.machine.glUsed.clear();
    EXPECT_EQ(findings(x), Names{"GL"});
    x = goodHost("wall1");
    x.machine.closedDrmNodes = {"/dev/dri/renderD128"};
    EXPECT_EQ(findings(x), Names{"/dev/dri"});
    x = goodHost("wall1");
    x.machine.sharedMemoryBytes = 16 << 20;
    EXPECT_EQ(findings(x), Names{"/dev/shm"});
    x = goodHost("wall1");
    x.machine.openFiles = 64;
    EXPECT_EQ(findings(x), Names{"open files"});
    x = goodHost("wall1");
    x.machine.recordingFreeBytes = 1 << 20;
    EXPECT_EQ(findings(x), Names{"disk"});
    x = goodHost("wall1");
    x.portProblem = "Connection timed out";
    EXPECT_EQ(findings(x), Names{"connection to it"});
    x = goodHost("wall1");
    x.toHost.bytesPerS = 1e6;
    EXPECT_EQ(findings(x), Names{"rate to it"});
    x = goodHost("wall1");
    x.network.facts.bufferBytes = 1 << 17;
    EXPECT_EQ(findings(x), Names{"buffers"});
    x = goodHost("wall1");
    x.machine.displays[0].problem = "cannot be opened";
    EXPECT_EQ(findings(x), Names{"display :0"});
}

TEST(HostsVerdict, trustsAClockOnlyAsFarAsItWasMeasured) {
    HostExamined x = goodHost("wall1");
    x.clock = {true, 0.03, 0.028};
    EXPECT_EQ(findings(x), Names{});
    x.clock = {true, -0.3, 0.001};
    EXPECT_EQ(worstOf(judgeHosts(surveyOf({x}), {})), Health::Bad);
}

TEST(HostsVerdict, comparesScreensWithTheFile) {
    const HostExamined x = goodHost("wall1");
    const auto with = [&](ExpectedScreen screen) { return findings(x, {{"wall1", {std::move(screen)}}}); };
    EXPECT_EQ(with({":0", 1920, 1080, {}}), Names{});
    EXPECT_EQ(with({":0", 3840, 1080, {}}), Names{"screen :0"});
    EXPECT_EQ(with({":1", 1920, 1080, {}}), Names{"screen :1"});
    EXPECT_EQ(with({":0", 0, 0, {{"w", 0, 0, 1920, 1080, true}}}), Names{});
    EXPECT_EQ(with({":0", 0, 0, {{"w", 0, 0, 1280, 1024, true}}}), Names{"screen :0"});
    EXPECT_EQ(with({":0", 0, 0, {{"w", 1000, 0, 1280, 1024, false}}}), Names{"screen :0"});
    EXPECT_EQ(findings(x, {{"wall2", {{":0", 1, 1, {}}}}}), Names{}); // of another host
}

TEST(HostsVerdict, reportsADriverThatDiffersFromMost) {
    std::vector<HostExamined> hosts{goodHost("a"), goodHost("b"), goodHost("c")};
    hosts[1].machine.glVersion = "4.5 Mesa 20.1";
    const auto judged = judgeHosts(surveyOf(hosts), {});
    EXPECT_EQ(worstOf({judged[0], judged[2]}), Health::Ok);
    EXPECT_EQ(worstOf(judged), Health::Warn);
    EXPECT_NE(findingsOf(judged).find("warn b: GL version: 4.5 Mesa 20.1 -> most hosts have"), std::string::npos)
        << findingsOf(judged);
}

TEST(HostsTable, showsDifferencesAndFaultsOnly) {
    std::vector<HostExamined> hosts{goodHost("wall1"), goodHost("wall2")};
    EXPECT_EQ(tableOf(judgeHosts(surveyOf(hosts), {}), false), "");
    EXPECT_NE(tableOf(judgeHosts(surveyOf(hosts), {}), true).find("/dev/shm"), std::string::npos);
    hosts[1].machine.openFiles = 64;
    const std::string table = tableOf(judgeHosts(surveyOf(hosts), {}), false);
    EXPECT_EQ(table, "check       wall1         wall2\nopen files  at most 1024  warn at most 64\n");
}

TEST(HostFactsLines, keepAllFieldsAndRefuseOthers) {
    HostFacts f = goodHost("wall1").machine;
    f.closedDrmNodes = {"/dev/dri/renderD129"};
    f.lockedBytes = UINT64_MAX;
    f.displays[0].screen.monitors[0].x = -1920;
    EXPECT_EQ(toJson(hostFactsFrom(toJson(f))), toJson(f));
    const auto odd =
        nlohmann::json{{"displays", {1, {{"monitors", "none"}, {"width", -5}}}}, {"devices", 3}, {"openFiles", "many"}};
    EXPECT_EQ(hostFactsFrom(odd).displays.size(), 1u);
    EXPECT_EQ(hostFactsFrom(odd).openFiles, 0u);
}

TEST(HostsVerdict, namesTheUserOfTheSeat) {
    HostExamined x = goodHost("wall1");
    x.machine.user = "wall";
    x.machine.seat = {"seat0", "alice", "x11"};
    EXPECT_EQ(findings(x), Names{}) << "another user may admit this one";
    x.machine.displays.front().problem = "cannot be opened";
    std::map<std::string, Check> checks;
    const auto judged = judgeHosts(surveyOf({x}), {});
    for (const Check& c : judged.front().checks) checks[c.name] = c;
    EXPECT_EQ(checks["seat"].found, "seat0: alice, x11");
    EXPECT_EQ(checks["display :0"].advice, "admit this user: `xhost +si:localuser:wall` in the session of alice");
}

TEST(SeatFacts, readsTheStateOfLogind) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(textOf(readSeat(folder.path())), "none");
    std::filesystem::create_directories(folder.path() + "/seats");
    std::filesystem::create_directories(folder.path() + "/sessions");
    std::ofstream(folder.path() + "/seats/seat0") << "# This is private data.\nIS_SEAT0=1\n";
    EXPECT_EQ(textOf(readSeat(folder.path())), "seat0: nobody is logged in");
    std::ofstream(folder.path() + "/seats/seat0") << "ACTIVE=c2\nACTIVE_UID=0\n";
    std::ofstream(folder.path() + "/sessions/c2") << "UID=0\nTYPE=x11\n";
    EXPECT_EQ(textOf(readSeat(folder.path())), "seat0: root, x11");
}

TEST(FixScript, runsCommandsAtTheirMachines) {
    const HostChecks host{
        "wall1",
        {{Health::Warn, "clock", "+9 ms", "`timedatectl set-ntp true` there and here, or `chronyc makestep`"},
         {Health::Ok, "GL", "EGL", "`rm -r it`"},
         {Health::Bad, "start", "no key", "`ssh-copy-id wall1`"},
         {Health::Bad, "size", "short", "`ip link set dev eth0 mtu 1500` here"},
         {Health::Bad, "screen", "small", "`DISPLAY=:0 xrandr --output NAME --mode 8x8`, or correct the file"},
         {Health::Bad, "disk", "full\nrm -r it", "free space (`du -xh ~ | sort -h`)"}}};
    const std::string text = fixScriptOf({host}, "ssh -q");
    std::vector<std::string> commands;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (!line.empty() && line[0] != '#') commands.push_back(line);
    EXPECT_EQ(commands,
              (Names{"ssh-copy-id wall1", "ip link set dev eth0 mtu 1500", "ssh -q wall1 'timedatectl set-ntp true'"}))
        << text;
    EXPECT_NE(text.find("# wall1: clock: +9 ms\n#   `timedatectl"), std::string::npos) << text;
}

} // namespace
} // namespace mural::cli
