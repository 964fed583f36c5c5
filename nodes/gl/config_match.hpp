// Choice of a framebuffer configuration whose bits are exactly those asked for: one bit more or less
// rounds, clears or blends differently, and the picture is no longer the native one. Where a driver has no such
// one (depths of 32 bits are Mesa's alone), the nearest in depth, stencil, samples, bits of a colour and bits of alpha, if
// there are any, is taken, and told: a picture that may differ is better than none.
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

// Index into candidates; the error names the first wish that none comes near, and what there is. Of what has not the bits
// asked for, the least that has more is taken, else the most that there is.
Result<size_t> matchConfig(const std::string& backend,
                           const std::vector<ConfigCandidate>& candidates,
                           const SurfaceConfig& wish);

// What a surface of this candidate is, of the size that was wished.
SurfaceConfig bitsOf(const ConfigCandidate& taken, const SurfaceConfig& wish);

// "depth 24 instead of 32, samples 0 instead of 4"; empty: all is as wished.
std::string whatDiffers(const SurfaceConfig& there, const SurfaceConfig& wish);

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
