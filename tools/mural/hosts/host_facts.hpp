// Facts of a machine that its own process collects for `mural doctor --nodes`, and their lines.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "nodes/output/windows/monitors.hpp"
#include "tools/mural/hosts/seat_facts.hpp"

namespace mural::cli {

// One EGL device, or another GL.
struct GlDeviceFacts {
    std::string name; // "device 0"
    std::string renderer;
    std::string drmNode;    // /dev/dri/renderD128; empty: none
    std::string pciAddress; // 0000:65:00.0; empty: unknown
    std::string uuid;       // hex digits; empty: the driver has none
    bool software = false;
};

struct DisplayFacts {
    std::string name;    // ":0.0"
    std::string problem; // empty: it can be opened
    ScreenFacts screen;
};

struct HostFacts {
    std::string build;  // streamBuild()
    std::string system; // "Debian GNU/Linux 12 (bookworm), kernel 6.1.0, glibc 2.36"
    std::string muralPath;
    std::string user;
    std::string glUsed;    // the GL that nodes select; empty: none can draw
    std::string glProblem; // reason of an empty glUsed
    std::string renderer, glVersion;
    int maxPictureSize = 0;
    std::string eglProblem; // empty: EGL draws
    std::vector<GlDeviceFacts> devices;
    std::vector<DisplayFacts> displays;
    SeatFacts seat;
    std::vector<std::string> closedDrmNodes; // files in /dev/dri that this user cannot open
    bool hasDrm = false;                     // /dev/dri exists
    uint64_t openFiles = 0, lockedBytes = 0; // limits; UINT64_MAX: none
    uint64_t sharedMemoryBytes = 0;          // size of /dev/shm
    std::string sharedMemoryProblem;         // of the memory that a node shares; empty: none
    uint64_t memoryBytes = 0;
    std::string recordingFolder; // folder for recordings, and its free space
    uint64_t recordingFreeBytes = 0;
};

// Parts of the examination that the doctor chooses.
struct InspectionPlan {
    std::vector<std::string> displays; // X displays; empty: DISPLAY, if it is set
    std::string folder;                // for recordings; empty: the home folder
};

// Takes at most some seconds. Drivers run in child processes.
HostFacts inspectThisHost(const InspectionPlan& plan);

nlohmann::json toJson(const HostFacts& facts);
// Missing or mistyped fields keep their defaults.
HostFacts hostFactsFrom(const nlohmann::json& json);

} // namespace mural::cli
