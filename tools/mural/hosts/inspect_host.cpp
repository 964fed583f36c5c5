#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gnu/libc-version.h>
#include <pwd.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <sys/sysinfo.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "nodes/gl/egl_devices.hpp"
#include "nodes/gl/gl_probe.hpp"
#include "nodes/launch/environment.hpp"
#include "nodes/session/stream_build.hpp"
#include "tools/mural/doctor/doctor_checks.hpp"
#include "tools/mural/hosts/host_facts.hpp"

namespace mural::cli {

namespace {

constexpr int64_t kGlMs = 8'000;
constexpr int64_t kDisplayMs = 8'000;

std::string systemText() {
    std::string name = "Linux";
    std::ifstream release("/etc/os-release");
    for (std::string line; std::getline(release, line);)
        if (line.starts_with("PRETTY_NAME=")) name = line.substr(12);
    std::erase(name, '"');
    utsname kernel{};
    uname(&kernel);
    return fmt::format("{}, kernel {}, glibc {}", name, kernel.release, gnu_get_libc_version());
}

std::string userName() {
    const passwd* user = getpwuid(geteuid());
    return user != nullptr ? user->pw_name : std::to_string(geteuid());
}

// Results of child processes are lines of JSON.
nlohmann::json inChildJson(const std::function<nlohmann::json()>& work, int64_t limitMs, std::string& problem) {
    const Isolated result = inChild([&]() -> Isolated { return {true, jsonText(work())}; }, limitMs);
    if (!result.ok) {
        problem = result.text;
        return nlohmann::json::object();
    }
    nlohmann::json reply = parseJson(result.text);
    if (!reply.is_object()) {
        problem = "the examination gave no result";
        return nlohmann::json::object();
    }
    problem = reply.value("problem", "");
    return reply;
}

nlohmann::json probeJson(const char* backend) {
    auto platform = gl::openPlatform(backend);
    if (!platform) return {{"problem", platform.error().message}};
    const auto found = gl::probe(**platform, gl::Api::Desktop, false);
    if (!found) return {{"problem", found.error().message}};
    const gl::GlProbe& p = found.value();
    return {{"backend", p.backend}, {"renderer", p.renderer}, {"version", p.version}, {"size", p.maxSurfaceSize}};
}

void inspectGl(HostFacts& f) {
    const nlohmann::json egl = inChildJson([] { return probeJson("egl"); }, kGlMs, f.eglProblem);
    const nlohmann::json used =
        f.eglProblem.empty() ? egl : inChildJson([] { return probeJson("auto"); }, kGlMs, f.glProblem);
    f.glUsed = used.value("backend", "");
    f.renderer = used.value("renderer", "");
    f.glVersion = used.value("version", "");
    f.maxPictureSize = used.value("size", 0);
    if (!f.eglProblem.empty()) return; // without EGL there are no devices
    std::string ignored;
    const nlohmann::json devices = inChildJson(
        [] {
            nlohmann::json list = nlohmann::json::array();
            for (const gl::EglDevice& d : gl::listEglDevices())
                list.push_back({{"name", d.name},
                                {"renderer", d.renderer},
                                {"drm", d.drmNode},
                                {"pci", d.pciAddress},
                                {"uuid", d.uuid},
                                {"software", d.software}});
            return nlohmann::json{{"devices", list}};
        },
        kGlMs, ignored);
    for (const auto& d : devices.value("devices", nlohmann::json::array()))
        f.devices.push_back({d.value("name", ""), d.value("renderer", ""), d.value("drm", ""), d.value("pci", ""),
                             d.value("uuid", ""), d.value("software", false)});
}

DisplayFacts inspectDisplay(const std::string& name) {
    DisplayFacts facts;
    facts.name = name;
    const nlohmann::json reply = inChildJson(
        [&]() -> nlohmann::json {
            const auto screen = readScreen(name);
            if (!screen) return {{"problem", screen.error().message}};
            nlohmann::json monitors = nlohmann::json::array();
            for (const MonitorFacts& m : screen.value().monitors)
                monitors.push_back({m.name, m.x, m.y, m.width, m.height, m.widthMm, m.heightMm});
            return {{"width", screen.value().width}, {"height", screen.value().height}, {"monitors", monitors}};
        },
        kDisplayMs, facts.problem);
    facts.screen.width = reply.value("width", 0);
    facts.screen.height = reply.value("height", 0);
    for (const auto& m : reply.value("monitors", nlohmann::json::array()))
        facts.screen.monitors.push_back({m.at(0), m.at(1), m.at(2), m.at(3), m.at(4), m.at(5), m.at(6)});
    return facts;
}

void inspectDrm(HostFacts& f) {
    std::error_code failed;
    for (const auto& entry : std::filesystem::directory_iterator("/dev/dri", failed)) {
        const std::string name = entry.path().filename();
        if (!name.starts_with("card") && !name.starts_with("renderD")) continue;
        f.hasDrm = true;
        // Drawing without a window system needs the render node only.
        if (name.starts_with("renderD") && access(entry.path().c_str(), R_OK | W_OK) != 0)
            f.closedDrmNodes.push_back(entry.path());
    }
    std::ranges::sort(f.closedDrmNodes);
}

void inspectLimits(HostFacts& f, const std::string& folder) {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) == 0) f.openFiles = limit.rlim_cur;
    if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0) f.lockedBytes = limit.rlim_cur;
    struct statvfs space {};
    if (statvfs("/dev/shm", &space) == 0) f.sharedMemoryBytes = uint64_t{space.f_blocks} * space.f_frsize;
    if (const Check memory = checkSharedMemory(); memory.health == Health::Bad) f.sharedMemoryProblem = memory.found;
    struct sysinfo system {};
    if (sysinfo(&system) == 0) f.memoryBytes = uint64_t{system.totalram} * system.mem_unit;
    const char* home = std::getenv("HOME");
    f.recordingFolder = !folder.empty() ? folder : home != nullptr ? home : "/tmp";
    if (statvfs(f.recordingFolder.c_str(), &space) == 0)
        f.recordingFreeBytes = uint64_t{space.f_bavail} * space.f_frsize;
}

} // namespace

HostFacts inspectThisHost(const InspectionPlan& plan) {
    HostFacts f;
    f.build = streamBuild();
    f.system = systemText();
    f.muralPath = launch::ownBinary();
    f.user = userName();
    f.seat = readSeat();
    inspectDrm(f);
    inspectLimits(f, plan.folder);
    std::vector<std::string> displays = plan.displays;
    if (const char* own = std::getenv("DISPLAY"); displays.empty() && own != nullptr && *own != '\0')
        displays.push_back(own);
    for (const std::string& name : displays) f.displays.push_back(inspectDisplay(name));
    inspectGl(f);
    return f;
}

} // namespace mural::cli
