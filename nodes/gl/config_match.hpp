// Choice of a framebuffer configuration whose bits are exactly those asked for: one bit more or less
// rounds, clears or blends differently, and the picture is no longer the native one.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/result.hpp"
#include "nodes/gl/gl_platform.hpp"

namespace mural::gl {

constexpr int kMaxSurfaceSize = 16384;

// Something that a backend can make surfaces of. Width and height of bits mean nothing here.
struct ConfigCandidate {
    SurfaceConfig bits;
    int rank = 0; // of several with equal bits the one with the lowest rank is taken, then the first
};

// Index into candidates. The error names the first wish that no candidate meets, and what there is.
Result<size_t> matchConfig(const std::string& backend,
                           const std::vector<ConfigCandidate>& candidates,
                           const SurfaceConfig& wish);

// True when both can be drawn to by the same context on backends that bind contexts to configurations.
bool sameBits(const SurfaceConfig& one, const SurfaceConfig& other);

// maxSize: the largest viewport of the driver, at most kMaxSurfaceSize.
Result<void> checkSize(const std::string& backend, const SurfaceConfig& wish, int maxSize);

// What to ask the driver for. Up to 3.0 there are no profiles: the driver gives its latest compatible
// version, as glXCreateContext does. At 3.1 drivers disagree whether a request without a profile is
// compatible (measured, Mesa 22.3.6: GLX and OSMesa yes, EGL no), so 3.2 with the profile is asked for.
struct VersionRequest {
    int major, minor;
    bool profile; // name the profile
};
VersionRequest versionRequest(const ContextConfig& config);

// For messages, e.g. "OpenGL 3.3 core forward-compatible", "OpenGL ES 2.0".
std::string describeContext(const ContextConfig& config);

} // namespace mural::gl
