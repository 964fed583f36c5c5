#include "tools/mural/hosts/hosts_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "tools/mural/network/network_verdict.hpp"

namespace mural::cli {

namespace {

constexpr double kLateClockS = 0.005; // frames of two logs cannot be ordered any more
constexpr double kWrongClockS = 0.1;
constexpr uint64_t kNeededFiles = 256;
constexpr uint64_t kMiB = uint64_t{1} << 20;
constexpr uint64_t kNeededSharedMiB = 64;
constexpr uint64_t kNeededDiskMiB = 1024;
constexpr double kSlowBytesPerS = 12.5e6; // 100 Mbit/s

Check good(std::string name, std::string found) { return {Health::Ok, std::move(name), std::move(found), {}}; }

Check start(const HostExamined& x) {
    if (x.failure.empty()) return good("start", "without a password");
    const std::string& why = x.failure;
    const auto contains = [&](const char* words) { return why.find(words) != std::string::npos; };
    const std::string name = x.failurePart.empty() ? "start" : "test of " + x.failurePart;
    if (!x.failurePart.empty())
        return {Health::Bad, name, why, fmt::format("repeat it on the host: `ssh {} mural doctor`", x.host)};
    if (contains("Permission denied") || contains("publickey"))
        return {Health::Bad, name, why, fmt::format("`ssh-copy-id {}`", x.host)};
    if (contains("Host key verification"))
        return {Health::Bad, name, why,
                fmt::format("`ssh-keyscan {} >> ~/.ssh/known_hosts`, after a check of the key", x.host)};
    if (contains("Could not resolve") || contains("Name or service"))
        return {Health::Bad, name, why, fmt::format("check the name: `getent hosts {}`", x.host)};
    if (contains("No route") || contains("timed out") || contains("refused") || contains("unreachable"))
        return {Health::Bad, name, why, fmt::format("start the machine and its ssh server: `ping {}`", x.host)};
    if (contains("not found") || contains("No such file"))
        return {Health::Bad, name, why, "install Mural there, or give its path with --remote-mural"};
    return {
        Health::Bad, name, why,
        fmt::format("its launch command must run a command there without a password: `ssh -o BatchMode=yes {} mural "
                    "version` (--launch, --remote-mural)",
                    x.host)};
}

Check ports(const HostExamined& x) {
    if (x.portProblem.empty()) return good("connection to it", "TCP, any port");
    return {Health::Bad, "connection to it", "this machine cannot connect to the host: " + x.portProblem,
            "allow TCP from this machine to any port of the host (`nft list ruleset` there)"};
}

Check rate(const char* name, const RateMeasured& rate) {
    if (!rate.problem.empty())
        return {Health::Warn, name, "not measured: " + rate.problem, "see the connections above, and repeat the test"};
    const std::string found = fmt::format("{:.0f} Mbit/s", rate.bytesPerS * 8e-6);
    if (rate.bytesPerS < kSlowBytesPerS)
        return {Health::Warn, name, found,
                "slow for pictures and geometry: check the cable and the switch port (`ethtool`)"};
    return good(name, found);
}

Check clockCheck(const HostExamined& x) {
    if (!x.clock.measured) return {Health::Warn, "clock", "not measured", "repeat the test"};
    const std::string found =
        fmt::format("{:+.1f} ms, error at most {:.1f} ms", x.clock.offsetS * 1e3, x.clock.errorS * 1e3);
    const double certain = std::abs(x.clock.offsetS) - x.clock.errorS;
    if (certain <= kLateClockS) return good("clock", found);
    return {certain > kWrongClockS ? Health::Bad : Health::Warn, "clock", found,
            "lines of logs have wrong times: `timedatectl set-ntp true` there and here, or `chronyc makestep`"};
}

Check build(const HostsSurvey& survey, const HostExamined& x) {
    if (x.machine.build == survey.build) return good("build", x.machine.build);
    return {Health::Bad, "build", fmt::format("stream {} there, {} here", x.machine.build, survey.build),
            "install the same build of Mural on all machines"};
}

void addGl(const HostFacts& f, std::vector<Check>& checks) {
    if (f.glUsed.empty()) {
        checks.push_back({Health::Bad, "GL", "no GL can draw: " + f.glProblem,
                          "`apt-get install libegl-mesa0`, or the graphics driver's package"});
        return;
    }
    checks.push_back(good("GL", f.glUsed));
    checks.push_back(good("renderer", f.renderer));
    checks.push_back(good("GL version", f.glVersion));
    checks.push_back(f.eglProblem.empty()
                         ? good("EGL", "draws")
                         : Check{Health::Warn, "EGL", f.eglProblem,
                                 "`apt-get install libegl1 libegl-mesa0`, or the graphics driver's package; another GL "
                                 "draws meanwhile"});
    std::string devices;
    bool gpu = false;
    for (const GlDeviceFacts& d : f.devices) {
        gpu = gpu || !d.software;
        devices += fmt::format("{}{}: {}{}{}{}", devices.empty() ? "" : "; ", d.name,
                               !d.renderer.empty() ? d.renderer
                               : d.software        ? "software"
                                                   : "GPU",
                               d.drmNode.empty() ? "" : " " + d.drmNode, d.pciAddress.empty() ? "" : " " + d.pciAddress,
                               d.uuid.empty() ? "" : " " + d.uuid);
    }
    if (!f.devices.empty()) checks.push_back(good("EGL devices", devices));
    if (!f.closedDrmNodes.empty())
        checks.push_back({Health::Warn, "/dev/dri", f.closedDrmNodes.front() + " cannot be opened",
                          fmt::format("`usermod -aG render,video {}`, then a new login", f.user)});
    else
        checks.push_back(good("/dev/dri", !f.hasDrm ? "no GPU" : "can be opened"));
}

void addDisplay(const HostFacts& f, const DisplayFacts& d, std::vector<Check>& checks) {
    const std::string name = "display " + d.name;
    if (!d.problem.empty()) {
        const bool isOthers = !f.seat.user.empty() && f.seat.user != f.user;
        checks.push_back({Health::Bad, name, d.problem,
                          fmt::format("{}admit this user: `xhost +si:localuser:{}` in {}",
                                      isOthers ? "" : "start the X server, and ", f.user,
                                      isOthers ? "the session of " + f.seat.user : "its session")});
        return;
    }
    std::string monitors;
    for (const MonitorFacts& m : d.screen.monitors)
        monitors += fmt::format(", {} {}x{}+{}+{}", m.name, m.width, m.height, m.x, m.y);
    checks.push_back(good(name, fmt::format("{}x{}{}", d.screen.width, d.screen.height, monitors)));
}

const DisplayFacts* displayOf(const HostFacts& f, const std::string& name) {
    if (name.empty()) return f.displays.empty() ? nullptr : &f.displays.front();
    const auto found = std::ranges::find_if(f.displays, [&](const DisplayFacts& d) { return d.name == name; });
    return found == f.displays.end() ? nullptr : &*found;
}

// Compares a display with the file.
void addExpected(const HostFacts& f, const ExpectedScreen& e, std::vector<Check>& checks) {
    const DisplayFacts* d = displayOf(f, e.display);
    const std::string name = "screen " + (e.display.empty() ? std::string("of the environment") : e.display);
    if (!d) {
        if (!e.windows.empty() || e.width > 0)
            checks.push_back(
                {Health::Bad, name, "the host has no X display", "start an X server there, and set DISPLAY"});
        return;
    }
    if (!d->problem.empty()) return; // a finding of its own
    const ScreenFacts& s = d->screen;
    if (e.width > 0 && (s.width != e.width || s.height != e.height)) {
        checks.push_back({Health::Bad, name,
                          fmt::format("{}x{} there, {}x{} in the file", s.width, s.height, e.width, e.height),
                          fmt::format("`DISPLAY={} xrandr --fb {}x{}` with modes for its outputs, or correct the "
                                      "viewport of the pipe",
                                      d->name, e.width, e.height)});
        return;
    }
    for (const ExpectedWindow& w : e.windows) {
        const bool exact = std::ranges::any_of(
            s.monitors, [&](const MonitorFacts& m) { return m.width == w.width && m.height == w.height; });
        if (w.fullScreen && !exact) {
            checks.push_back(
                {Health::Bad, name,
                 fmt::format("no monitor has the {}x{} pixels of the full-screen window {}", w.width, w.height, w.name),
                 fmt::format("`DISPLAY={} xrandr --output NAME --mode {}x{}`, or correct the file", d->name, w.width,
                             w.height)});
            return;
        }
        if (w.x < 0 || w.y < 0 || w.x + w.width > s.width || w.y + w.height > s.height) {
            checks.push_back({Health::Bad, name,
                              fmt::format("window {} ({}x{}+{}+{}) is not within the {}x{} pixels of the screen",
                                          w.name, w.width, w.height, w.x, w.y, s.width, s.height),
                              "correct the viewport of the window, or the mode of the monitor (`xrandr`)"});
            return;
        }
    }
    checks.push_back(good(name, "as in the file"));
}

void addLimits(const HostFacts& f, std::vector<Check>& checks) {
    if (!f.sharedMemoryProblem.empty())
        checks.push_back(
            {Health::Bad, "shared memory", f.sharedMemoryProblem, "raise the memory limit: `ulimit -v unlimited`"});
    const std::string shared = fmt::format("{} MiB", f.sharedMemoryBytes / kMiB);
    checks.push_back(f.sharedMemoryBytes >= kNeededSharedMiB * kMiB
                         ? good("/dev/shm", shared)
                         : Check{Health::Warn, "/dev/shm", shared,
                                 fmt::format("`mount -o remount,size={}M /dev/shm` (containers: --shm-size)",
                                             4 * kNeededSharedMiB)});
    const std::string files = fmt::format("at most {}", f.openFiles);
    checks.push_back(
        f.openFiles >= kNeededFiles
            ? good("open files", files)
            : Check{Health::Warn, "open files", files,
                    fmt::format("`ulimit -n {}`, or nofile in /etc/security/limits.conf", 4 * kNeededFiles)});
    checks.push_back(
        good("locked memory", f.lockedBytes == UINT64_MAX ? "no limit" : fmt::format("{} KiB", f.lockedBytes / 1024)));
    checks.push_back(good("memory", fmt::format("{:.1f} GiB", static_cast<double>(f.memoryBytes) / (1024.0 * kMiB))));
    const std::string disk = fmt::format("{} MiB free in {}", f.recordingFreeBytes / kMiB, f.recordingFolder);
    checks.push_back(
        f.recordingFreeBytes >= kNeededDiskMiB * kMiB
            ? good("disk", disk)
            : Check{Health::Warn, "disk", disk,
                    "recordings need more: free space (`du -xh --max-depth=1 ~ | sort -h`), or give another "
                    "folder with --recordings"});
}

// Names of the network's checks begin with the host.
std::vector<Check> networkChecks(const HostsSurvey& survey, const HostExamined& x) {
    std::vector<Check> checks = judgeHost(survey.here, x.network);
    const std::string prefix = x.host + ": ";
    for (Check& c : checks) {
        if (c.name.starts_with(prefix)) c.name.erase(0, prefix.size());
        if (c.name == "connection") c.name = "connection from it";
    }
    return checks;
}

std::vector<Check> judgeOne(const HostsSurvey& survey, const HostExamined& x,
                            const std::map<std::string, std::vector<ExpectedScreen>>& expected) {
    std::vector<Check> checks{start(x)};
    if (!x.failure.empty() && x.failurePart.empty()) return checks;
    for (Check& c : networkChecks(survey, x)) checks.push_back(std::move(c));
    checks.push_back(clockCheck(x));
    if (!x.network.reached.empty()) {
        checks.push_back(ports(x));
        if (x.portProblem.empty()) {
            checks.push_back(rate("rate to it", x.toHost));
            checks.push_back(rate("rate from it", x.fromHost));
        }
    }
    if (!x.failure.empty()) return checks; // the machine was not examined
    checks.push_back(build(survey, x));
    checks.push_back(good("system", x.machine.system));
    addGl(x.machine, checks);
    checks.push_back(good("seat", textOf(x.machine.seat)));
    for (const DisplayFacts& d : x.machine.displays) addDisplay(x.machine, d, checks);
    if (const auto screens = expected.find(x.host); screens != expected.end())
        for (const ExpectedScreen& e : screens->second) addExpected(x.machine, e, checks);
    addLimits(x.machine, checks);
    return checks;
}

// Texture handles and rounding depend on the driver: hosts that differ from most of the others are reported.
void compareDrivers(const HostsSurvey& survey, std::vector<HostChecks>& all) {
    std::map<std::string, int> votes;
    for (const HostExamined& x : survey.hosts)
        if (!x.machine.glVersion.empty()) ++votes[x.machine.glVersion];
    if (votes.size() < 2) return;
    const auto most = std::ranges::max_element(votes, {}, [](const auto& v) { return v.second; });
    for (size_t i = 0; i < all.size(); ++i) {
        const HostFacts& f = survey.hosts[i].machine;
        for (Check& c : all[i].checks) {
            if (c.name != "GL version" || f.glVersion == most->first) continue;
            c.health = Health::Warn;
            c.advice = fmt::format("most hosts have {}: install the same driver in the same version on all machines, "
                                   "otherwise pictures of the parts may differ",
                                   most->first);
        }
    }
}

} // namespace

std::vector<HostChecks> judgeHosts(const HostsSurvey& survey,
                                   const std::map<std::string, std::vector<ExpectedScreen>>& expected) {
    std::vector<HostChecks> all;
    for (const HostExamined& x : survey.hosts) all.push_back({x.host, judgeOne(survey, x, expected)});
    compareDrivers(survey, all);
    return all;
}

Health worstOf(const std::vector<HostChecks>& hosts) {
    Health worst = Health::Ok;
    for (const HostChecks& h : hosts)
        for (const Check& c : h.checks) worst = std::max(worst, c.health);
    return worst;
}

} // namespace mural::cli
