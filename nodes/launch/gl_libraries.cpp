#include "nodes/launch/gl_libraries.hpp"

#include <algorithm>
#include <fcntl.h>
#include <poll.h>
#include <string_view>
#include <unistd.h>

#include "common/base/gl_library_names.hpp"
#include "nodes/launch/base_name.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/elf_check.hpp"

namespace mural::launch {

namespace {

constexpr int64_t kLoaderMs = 10'000; // large programs have hundreds of libraries, and disks may spin up
constexpr const char* kOpenedByName = "libGL.so.1 libEGL.so.1 libGLESv2.so.2 libGLESv1_CM.so.1";

std::string readAll(int fd, Deadline deadline) {
    std::string text;
    char part[4096];
    while (!deadline.passed()) {
        pollfd waiting{fd, POLLIN, 0};
        if (poll(&waiting, 1, static_cast<int>(deadline.leftNs() / kNsPerMs) + 1) <= 0) continue;
        const ssize_t n = read(fd, part, sizeof part);
        if (n <= 0) break;
        text.append(part, static_cast<size_t>(n));
    }
    return text;
}

// Returns the loader's list of libraries, one per line: "\tNAME => PATH (ADDRESS)". Does not run the program.
std::string resolveWithLoader(const std::string& loader, const std::string& executable, const Environment& environment,
                              bool openedToo) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return {};
    const int silent = open("/dev/null", O_WRONLY | O_CLOEXEC);
    SpawnRequest request;
    request.file = loader;
    request.arguments = {loader, "--list", executable};
    if (openedToo) request.arguments.insert(request.arguments.begin() + 1, {"--preload", kOpenedByName});
    request.environment = environment.entries();
    request.outputFd = ends[1];
    request.errorFd = silent;
    auto child = ChildProcess::start(request);
    close(ends[1]);
    if (silent >= 0) close(silent);
    const Deadline deadline = Deadline::inMs(kLoaderMs);
    const std::string text = child ? readAll(ends[0], deadline) : std::string();
    close(ends[0]);
    if (child && !child->waitUntil(deadline)) child->end(Deadline::inMs(0));
    return text;
}

// The paths of GL libraries in the loader's list.
std::vector<std::string> glLibrariesIn(std::string_view list) {
    std::vector<std::string> found;
    for (size_t at = 0; at < list.size();) {
        const size_t end = std::min(list.find('\n', at), list.size());
        std::string_view line = list.substr(at, end - at);
        at = end + 1;
        const auto arrow = line.find(" => ");
        line.remove_prefix(arrow == std::string_view::npos ? std::min(line.find_first_not_of(" \t"), line.size())
                                                           : arrow + 4);
        line = line.substr(0, line.rfind(" ("));
        if (!line.starts_with('/') || !(baseName(line).starts_with("libGL") || baseName(line).starts_with("libEGL")))
            continue;
        const Drawing drawing = drawingOf(std::string(line));
        if (drawing == Drawing::Glvnd || drawing == Drawing::OwnGl) found.emplace_back(line);
    }
    return found;
}

std::vector<std::string> onlyOwn(std::vector<std::string> libraries) {
    std::erase_if(libraries, [](const std::string& path) { return drawingOf(path) != Drawing::OwnGl; });
    return libraries;
}

} // namespace

Drawing drawingOf(const std::string& libraryPath) {
    const auto facts = readLibrary(libraryPath);
    if (!facts) return Drawing::None;
    const std::string& name = facts.value().soname;
    if (isGlLibraryName(name)) {
        const auto& needed = facts.value().needed;
        return std::any_of(needed.begin(), needed.end(), isGlvndDispatch) ? Drawing::Glvnd : Drawing::OwnGl;
    }
    if (name.starts_with("libOSMesa")) return Drawing::OffScreen;
    if (name.starts_with("libvulkan.so")) return Drawing::Vulkan;
    if (name.starts_with("libX11.so") || name == "libxcb.so.1") return Drawing::X11;
    return Drawing::None;
}

std::vector<std::string> ownGlLibraries(const std::string& executable, const Environment& environment) {
    const auto facts = readExecutable(executable);
    if (!facts || facts.value().interpreter.empty()) return {};
    const std::string& loader = facts.value().interpreter;
    // Two separate runs: a library opened by name could hide one that a dependency finds elsewhere.
    const auto linked = glLibrariesIn(resolveWithLoader(loader, executable, environment, false));
    if (!linked.empty()) return onlyOwn(linked);
    return onlyOwn(glLibrariesIn(resolveWithLoader(loader, executable, environment, true)));
}

} // namespace mural::launch
