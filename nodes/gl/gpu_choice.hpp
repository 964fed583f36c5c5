// The choice of one GPU among those of a machine.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "nodes/gl/egl_devices.hpp"

namespace mural::gl {

struct GpuChoice {
    std::string name; // of a device, see matchesGpu(); empty: by turn
    int turn = 0;     // number of this process among those that divide the GPUs of its machine
    int turns = 1;    // number of these processes; 1: the driver's first GPU
};

// True if `name` is the number of the device, its UUID (also as nvidia-smi prints it, GPU-…), its DRM node
// (/dev/dri/renderD128) or its PCI address (0000:65:00.0).
bool matchesGpu(const std::string& name, size_t number, const EglDevice& device);

// Returns the names of the GPUs that a Slurm job grants to this process, separated by commas: "0,2", "GPU-0a1b2c3d".
// Empty: no job, or it names no GPU. variable: getenv().
std::string gpusOfJob(const std::function<const char*(const char* name)>& variable);

// Returns the numbers of the devices that these names select, in the order of the names. Numbers among the names count
// the GPUs that open, in the order of their PCI addresses. Device groups of a job may hide the others, and then the
// numbers begin at 0. Names may be beginnings of UUIDs. Unknown names are ignored; software renderers never count.
// opens: returns true if the device with this number can be opened.
std::vector<size_t> selectGpus(const std::string& names, const std::vector<EglDevice>& devices,
                               const std::function<bool(size_t device)>& opens);

// Returns one line with all devices and their names, for errors.
std::string listOf(const std::vector<EglDevice>& devices);

} // namespace mural::gl
