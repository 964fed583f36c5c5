// The choice of one GPU among those of a machine.
#pragma once

#include <cstddef>
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

// Returns one line with all devices and their names, for errors.
std::string listOf(const std::vector<EglDevice>& devices);

} // namespace mural::gl
