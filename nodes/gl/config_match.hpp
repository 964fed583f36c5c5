// Chooses a framebuffer configuration that has exactly the requested bits. One bit more or less changes rounding,
// clears or blending, and the picture then differs from the native one.
//
// A driver may lack such a configuration: only Mesa has depths of 32 bits. The nearest depth, stencil, samples, colour
// bits and non-zero alpha bits then replace the requested ones. The surface reports its real bits. A picture that may
// differ is better than none.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/gl/gl_platform.hpp"

namespace mural::gl {

constexpr int kMaxSurfaceSize = 16384;

// One kind of surface that a backend can create. Width and height of `bits` have no meaning here.
struct ConfigCandidate {
    SurfaceConfig bits;
    int rank = 0; // the lowest rank wins among equal bits, then the first candidate
};

// Returns an index into `candidates`. Attributes without the requested value get the next larger value, or the largest
// one if none is larger. Errors: no candidate is acceptable; the text names the first attribute that fails and the
// values on offer.
Result<size_t> matchConfig(const std::string& backend, const std::vector<ConfigCandidate>& candidates,
                           const SurfaceConfig& requested);

// Returns the bits of a candidate with the requested size.
SurfaceConfig bitsOf(const ConfigCandidate& taken, const SurfaceConfig& requested);

// Returns a text such as "depth 24 instead of 32, samples 0 instead of 4". Empty: no difference.
std::string describeDifference(const SurfaceConfig& there, const SurfaceConfig& requested);

// Returns whether one context can draw to surfaces of both configurations, on backends that bind contexts to
// configurations.
bool sameBits(const SurfaceConfig& one, const SurfaceConfig& other);

// maxSize: the largest viewport of the driver, at most kMaxSurfaceSize.
Result<void> checkSize(const std::string& backend, const SurfaceConfig& requested, int maxSize);

// The context version that is requested from the driver. Up to 3.0 there are no profiles: the driver returns its latest
// compatible version, as glXCreateContext does. Drivers disagree whether a request for 3.1 without a profile is
// compatible (measured, Mesa 22.3.6: GLX and OSMesa yes, EGL no). Mural therefore requests 3.2 with the profile instead
// of 3.1.
struct VersionRequest {
    int major, minor;
    bool profile; // name the profile
};
VersionRequest versionRequest(const ContextConfig& config);

// For messages, e.g. "OpenGL 3.3 core forward-compatible", "OpenGL ES 2.0".
std::string describeContext(const ContextConfig& config);

} // namespace mural::gl
