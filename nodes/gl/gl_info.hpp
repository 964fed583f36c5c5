// What the context that is current says about itself.
#pragma once

#include <string>
#include <vector>

#include "nodes/gl/gl_platform.hpp"

namespace mural::gl {

struct GlInfo {
    std::string vendor, renderer, version;
    int glVersion = 0; // 10 * major + minor, e.g. 45
    bool es = false;
    std::vector<std::string> extensions; // sorted
    int maxSurfaceSize = 0;              // the smaller side of GL_MAX_VIEWPORT_DIMS
    ColorBuffers colorBuffers = ColorBuffers::OneNamedFront; // desktop only; of the surface that is current, in a context that has just been made
};

// A context of the platform must be current. Fails when the driver hands out no functions.
Result<GlInfo> readGlInfo(Platform& platform);

// The same of a platform that was just opened, by a context and a surface of its own: what no query of the
// window system tells. Leaves no context current. embedded: a driver that has only OpenGL ES will do.
Result<GlInfo> measureGl(Platform& platform, bool embedded);

// Waits until all is drawn that the current context has been told. Mesa's software driver does not always wait by itself
// when it reads a surface that was drawn to until just now and is then current for reading only (README.md).
void finishDrawing(Platform& platform);

// Hands what the current context holds back to the driver.
void flushDrawing(Platform& platform);

// Whether glReadPixels gives what was drawn to a surface with samples; true where there are none. Leaves no context current.
bool showsSamples(Platform& platform);

// "4.5 (Compatibility Profile) Mesa 22.3.6" → 45, "OpenGL ES-CM 1.1 Mesa" → 11; 0 when there is no number.
int parseGlVersion(const std::string& version);

// "4.5 (Compatibility Profile) Mesa 22.3.6" → 22; 0 when it is not Mesa's.
int parseMesaVersion(const std::string& version);

} // namespace mural::gl
