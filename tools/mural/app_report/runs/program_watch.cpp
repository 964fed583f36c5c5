#include "tools/mural/app_report/runs/program_watch.hpp"

#include <algorithm>
#include <climits>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <unistd.h>

#include "nodes/launch/base_name.hpp"
#include "nodes/launch/environment.hpp"
#include "nodes/launch/process_tree.hpp"

namespace mural::cli {

namespace {

struct LibraryName {
    std::string_view beginning;
    const char* means;
};
constexpr LibraryName kToolkits[] = {
    {"libQt6Gui", "Qt 6"},
    {"libQt5Gui", "Qt 5"},
    {"libgtk-4", "GTK 4"},
    {"libgtk-3", "GTK 3"},
    {"libgtk-x11-2", "GTK 2"},
    {"libSDL3", "SDL 3"},
    {"libSDL2-", "SDL 2"},
    {"libSDL-1", "SDL 1.2"},
    {"libglfw", "GLFW"},
    {"libglut", "GLUT"},
    {"libfreeglut", "GLUT"},
    {"libwx_", "wxWidgets"},
    {"libfltk", "FLTK"},
    {"libsfml-window", "SFML"},
    {"libXt.", "Xt"},
    {"libvtk", "VTK"},
    {"libosgViewer", "OpenSceneGraph"},
    {"libOgreMain", "OGRE"},
    {"libjvm", "Java"},
    {"libpython3", "Python"},
    {"liballegro", "Allegro"},
    {"libclutter", "Clutter"},
};
constexpr LibraryName kInterfaces[] = {
    {"libGLX.so", "GLX"},
    {"libEGL.so", "EGL"},
    {"libvulkan.so", "Vulkan"},
    {"libOSMesa", "OSMesa"},
    {"libwayland-client.so", "Wayland"},
};

std::string linkOf(const std::string& path) {
    char name[PATH_MAX];
    const ssize_t n = readlink(path.c_str(), name, sizeof name);
    return n > 0 ? std::string(name, static_cast<size_t>(n)) : std::string();
}

void noteLibraries(const std::string& folder, ProgramSeen& seen) {
    std::ifstream maps(folder + "/maps");
    std::set<std::string> names;
    for (std::string line; std::getline(maps, line);) {
        const auto slash = line.rfind('/');
        if (slash != std::string::npos && line.find(" r-xp ") != std::string::npos)
            names.insert(line.substr(slash + 1));
    }
    for (const std::string& name : names) noteLibrary(name, seen);
}

// Inodes of IP sockets in the process's network namespace, from the tenth column of four tables.
std::set<std::string> inetSockets(const std::string& folder) {
    std::set<std::string> inodes;
    for (const char* table : {"tcp", "tcp6", "udp", "udp6"}) {
        std::ifstream file(folder + "/net/" + table);
        std::string line;
        std::getline(file, line); // heading
        while (std::getline(file, line)) {
            std::istringstream columns(line);
            std::string word;
            for (int i = 0; i < 10; ++i) columns >> word;
            inodes.insert("socket:[" + word + "]");
        }
    }
    return inodes;
}

int socketsOf(const std::string& folder, const std::set<std::string>& inet) {
    int count = 0;
    std::error_code failed;
    for (const auto& fd : std::filesystem::directory_iterator(folder + "/fd", failed))
        count += static_cast<int>(inet.contains(linkOf(fd.path())));
    return count;
}

void noteStatus(const std::string& folder, int& threads, ProgramSeen& seen) {
    std::ifstream status(folder + "/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("Threads:")) threads += std::atoi(line.c_str() + 8);
        if (line.starts_with("Seccomp:") && std::atoi(line.c_str() + 8) == 2) seen.filtersSystemCalls = true;
    }
}

} // namespace

void noteLibrary(const std::string& name, ProgramSeen& seen) {
    for (const LibraryName& toolkit : kToolkits)
        if (name.starts_with(toolkit.beginning)) seen.toolkits.insert(toolkit.means);
    for (const LibraryName& interface : kInterfaces)
        if (name.starts_with(interface.beginning)) seen.interfaces.insert(interface.means);
}

std::vector<pid_t> ProgramWatch::processesOf(pid_t run) {
    const std::string mural = launch::ownBinary();
    std::vector<pid_t> pids;
    for (const launch::ProcessFacts& p : launch::descendantsOf(run, {})) {
        const std::string binary = linkOf("/proc/" + std::to_string(p.pid) + "/exe");
        const std::string_view name = launch::baseName(binary);
        // mural run asks the loader for the program's libraries.
        const bool isHelper = binary == mural || name == "Xvfb" || name.starts_with("ld-linux");
        if (p.state != 'Z' && !binary.empty() && !isHelper) pids.push_back(p.pid);
    }
    return pids;
}

void ProgramWatch::look(pid_t run) {
    int threads = 0, processes = 0, sockets = 0;
    for (const pid_t pid : processesOf(run)) {
        const std::string folder = "/proc/" + std::to_string(pid);
        const std::string name(launch::baseName(linkOf(folder + "/exe")));
        ++processes;
        seen_.programs.insert(name);
        if (name.starts_with("python3")) seen_.toolkits.insert("Python");
        noteLibraries(folder, seen_);
        noteStatus(folder, threads, seen_);
        sockets += socketsOf(folder, inetSockets(folder));
    }
    seen_.threads = std::max(seen_.threads, threads);
    seen_.processes = std::max(seen_.processes, processes);
    seen_.inetSockets = std::max(seen_.inetSockets, sockets);
}

} // namespace mural::cli
