#include "tools/mural/doctor/doctor_checks.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "common/ipc/capture_ring.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/environment.hpp"
#include "nodes/launch/private_display.hpp"
#include "nodes/launch/program_check.hpp"
#include "nodes/gl/gl_probe.hpp"
#include "tools/mural/commands.hpp"

namespace mural::cli {

namespace {

constexpr int64_t kGlMs = 20'000;
constexpr int64_t kPreloadMs = 10'000;
constexpr uint64_t kMiB = uint64_t{1} << 20;
constexpr rlim_t kNeededFiles = 256;

std::string searchPath() { return launch::Environment::current().get("PATH").value_or("/usr/bin:/bin"); }

bool installed(const std::string& program) { return launch::findProgram(program, searchPath()).ok(); }

} // namespace

Isolated inChild(const std::function<Isolated()>& work, int64_t limitMs) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return {false, std::strerror(errno)};
    const pid_t pid = fork();
    if (pid == 0) {
        const int silent = open("/dev/null", O_WRONLY | O_CLOEXEC);
        if (silent >= 0) dup2(silent, STDERR_FILENO); // hides messages that drivers print to standard error
        const Isolated result = work();
        const std::string bytes = (result.ok ? "+" : "-") + result.text.substr(0, 4000);
        [[maybe_unused]] const ssize_t n = write(ends[1], bytes.data(), bytes.size());
        _exit(0);
    }
    close(ends[1]);
    Isolated result{false, "cannot create a process"};
    if (pid > 0) {
        launch::ChildProcess child = launch::ChildProcess::adopt(pid);
        const bool ended = child.waitUntil(Deadline::inMs(limitMs));
        char text[4096];
        const ssize_t n = ended ? read(ends[0], text, sizeof text) : 0;
        if (n > 0) {
            result = {text[0] == '+', std::string(text + 1, static_cast<size_t>(n - 1))};
        } else {
            result.text = ended ? "the driver crashed (" + child.describeEnd() + ")" : "the driver hangs";
        }
        if (!ended) child.end(Deadline::inMs(0));
    }
    close(ends[0]);
    return result;
}

Check checkVersions() {
    utsname system{};
    uname(&system);
    return {Health::Ok,
            "versions",
            fmt::format("mural {}, kernel {}, glibc {}, {}", muralVersion(), system.release, gnu_get_libc_version(),
                        system.machine),
            {}};
}

Check checkCaptureLibrary() {
    auto library = launch::findCaptureLibrary(launch::ownBinary());
    if (!library) return {Health::Bad, "library", library.error().message, "build or install all of Mural"};
    if (access(library->eglVendorFile.c_str(), R_OK) != 0) {
        return {Health::Warn, "library", library->path + ", without " + library->eglVendorFile,
                "EGL programs are not captured; build or install all of Mural"};
    }
    return {Health::Ok, "library", library->path, {}};
}

Check checkPreload() {
    auto library = launch::findCaptureLibrary(launch::ownBinary());
    launch::Environment environment = launch::Environment::current();
    if (!library) return {Health::Bad, "preload", "the capture library is missing", "build or install all of Mural"};
    const auto added = launch::addCapture(environment, *library, "");
    if (!added) return {Health::Bad, "preload", added.error().message, "move Mural to another folder"};
    environment.unset("MURAL_SESSION");
    launch::SpawnRequest request;
    request.file = launch::ownBinary();
    request.arguments = {"mural", "preload-probe"};
    request.environment = environment.entries();
    auto child = launch::ChildProcess::start(request);
    if (!child) return {Health::Bad, "preload", child.error().message, "check the installation"};
    if (!child->waitUntil(Deadline::inMs(kPreloadMs))) {
        child->end(Deadline::inMs(0));
        return {Health::Bad, "preload", "a program with the capture library does not end",
                "run: LD_DEBUG=libs LD_PRELOAD=" + library->path + " true"};
    }
    if (child->exitStatus() != 0) {
        return {Health::Bad, "preload", "the loader rejects the capture library (" + child->describeEnd() + ")",
                "run: LD_PRELOAD=" + library->path + " true, and read the loader's message"};
    }
    return {Health::Ok, "preload", "the loader accepts the capture library", {}};
}

Check checkDisplay() {
    const std::string name = launch::Environment::current().get("DISPLAY").value_or("");
    if (name.empty())
        return {Health::Ok, "display", "none (DISPLAY is not set): programs run on a private display", {}};
    if (launch::displayUsable(name)) return {Health::Ok, "display", name, {}};
    return {Health::Warn, "display", name + " cannot be opened",
            "start its server, or unset DISPLAY to use a private display"};
}

Check checkPrivateDisplay() {
    const bool there = installed("Xvfb");
    const bool needed = !launch::displayUsable(launch::Environment::current().get("DISPLAY").value_or(""));
    if (!there)
        return {needed ? Health::Bad : Health::Warn, "private display", "Xvfb was not found",
                "install Debian's package xvfb; it is required without a display and for --size"};
    auto display = launch::PrivateDisplay::start(64, 64);
    if (!display)
        return {needed ? Health::Bad : Health::Warn, "private display", display.error().message,
                "run Xvfb :99 manually and read its messages"};
    return {Health::Ok, "private display", "Xvfb starts", {}};
}

Check checkSharedMemory() {
    const uint64_t wanted = uint64_t{capture::kDefaultChunks} * capture::kChunkBytes + capture::kReplyBytes;
    const int fd = memfd_create("mural-doctor", MFD_CLOEXEC);
    if (fd < 0)
        return {Health::Bad, "shared memory", "memfd_create: " + std::string(std::strerror(errno)),
                "use kernel 3.17 or later, and a sandbox that permits memfd_create"};
    const bool sized = ftruncate(fd, static_cast<off_t>(wanted)) == 0;
    void* at = sized ? mmap(nullptr, wanted, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0) : MAP_FAILED;
    const int reason = errno;
    if (at != MAP_FAILED) munmap(at, wanted);
    close(fd);
    if (at == MAP_FAILED)
        return {Health::Bad, "shared memory",
                fmt::format("cannot allocate {} MiB: {}", wanted / kMiB, std::strerror(reason)),
                "raise the memory limit (ulimit -v, container)"};
    return {Health::Ok, "shared memory", fmt::format("{} MiB for each captured program", wanted / kMiB), {}};
}

Check checkMemoryFolder() {
    struct statvfs facts {};
    if (statvfs("/dev/shm", &facts) != 0)
        return {Health::Warn, "/dev/shm", std::strerror(errno),
                "mount a tmpfs there; programs and X servers transfer pictures through it"};
    const uint64_t sizeMiB = facts.f_blocks * facts.f_frsize / kMiB;
    if (sizeMiB < 64)
        return {Health::Warn, "/dev/shm", fmt::format("{} MiB", sizeMiB),
                "give it 64 MiB or more (containers: --shm-size)"};
    return {Health::Ok, "/dev/shm", fmt::format("{} MiB", sizeMiB), {}};
}

Check checkOpenFiles() {
    rlimit limit{};
    getrlimit(RLIMIT_NOFILE, &limit);
    if (limit.rlim_cur < kNeededFiles)
        return {Health::Warn, "open files", fmt::format("at most {}", limit.rlim_cur),
                fmt::format("ulimit -n {}", kNeededFiles)};
    return {Health::Ok, "open files", fmt::format("at most {}", limit.rlim_cur), {}};
}

Check checkVideo() {
    if (installed("ffmpeg")) return {Health::Ok, "video", "ffmpeg", {}};
    return {Health::Warn, "video", "ffmpeg was not found", "install Debian's package ffmpeg for --out wall.mp4"};
}

Check checkRemote() {
    if (installed("ssh")) return {Health::Ok, "other hosts", "ssh", {}};
    return {Health::Warn, "other hosts", "ssh was not found",
            "install Debian's package openssh-client for --nodes, or give --launch"};
}

std::vector<Check> checkGl(bool& usable) {
    std::vector<Check> checks;
    usable = false;
    for (const char* backend : {"egl", "osmesa", "glx"}) {
        const Isolated result = inChild(
            [backend]() -> Isolated {
                auto platform = gl::openPlatform(backend);
                if (!platform) return {false, platform.error().message};
                const auto found = gl::probe(**platform, gl::Api::Desktop, false);
                if (!found) return {false, found.error().message};
                const gl::GlProbe& p = found.value();
                return {true, fmt::format("{}, pictures up to {} pixels wide", p.backend, p.maxSurfaceSize)};
            },
            kGlMs);
        usable = usable || result.ok;
        const char* advice = "";
        if (!result.ok) advice = "only matters for --gl with this name, as long as another GL draws";
        checks.push_back(
            {result.ok ? Health::Ok : Health::Warn, fmt::format("GL by {}", backend), result.text, advice});
    }
    return checks;
}

} // namespace mural::cli
