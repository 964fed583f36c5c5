// The EGL devices of this machine, for `mural doctor`.
#pragma once

#include <string>
#include <vector>

namespace mural::gl {

struct EglDevice {
    std::string name;     // "device 0", as in the description of a backend
    std::string renderer; // empty: the driver has no name for it
    std::string drmNode;  // "/dev/dri/renderD128"; empty: none
    std::string uuid;     // 32 hex digits; empty: the driver has none
    bool software = false;
};

// Creates no context. Empty: no EGL, or no device extensions.
std::vector<EglDevice> listEglDevices();

} // namespace mural::gl
