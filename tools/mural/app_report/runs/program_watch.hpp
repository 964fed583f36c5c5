// Observes the processes of a running program through /proc: toolkits, ways of drawing, threads, network.
#pragma once

#include <set>
#include <string>
#include <sys/types.h>
#include <vector>

namespace mural::cli {

struct ProgramSeen {
    std::set<std::string> toolkits;   // "Qt 5", "SDL 2"
    std::set<std::string> interfaces; // ways of drawing: "GLX", "EGL", "Vulkan", "OSMesa"
    std::set<std::string> programs;   // names of its processes' binaries
    int threads = 0;                  // largest sum over its processes
    int processes = 0;                // largest number at the same time
    int inetSockets = 0;              // largest number of sockets for IP
    bool filtersSystemCalls = false;  // a seccomp sandbox
};

class ProgramWatch {
public:
    // Examines the descendants of a `mural run`, without Mural's own processes.
    void look(pid_t run);
    // Returns these descendants.
    [[nodiscard]] static std::vector<pid_t> processesOf(pid_t run);
    [[nodiscard]] const ProgramSeen& seen() const { return seen_; }

private:
    ProgramSeen seen_;
};

// Adds what the library tells about a program: its name without the folder, such as "libQt5Gui.so.5".
void noteLibrary(const std::string& name, ProgramSeen& seen);

} // namespace mural::cli
