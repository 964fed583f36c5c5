// The EGL devices of this machine.
#pragma once

#include <string>
#include <vector>

namespace mural::gl {

inline constexpr int kMaxEglDevices = 64;

struct EglDevice {
    std::string name;       // "device 0", as in the description of a backend
    std::string renderer;   // empty: the driver has no name for it
    std::string drmNode;    // "/dev/dri/renderD128"; empty: none
    std::string pciAddress; // "0000:65:00.0"; empty: it has no DRM node
    std::string uuid;       // 32 hex digits; empty: the driver has none
    bool software = false;
};

// In the order of EGL, which is the order of their numbers. Creates no context. Empty: no EGL, or no device extensions.
std::vector<EglDevice> listEglDevices();

} // namespace mural::gl
