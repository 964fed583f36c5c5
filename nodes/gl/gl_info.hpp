// Queries version, extensions and limits of the current context.
#pragma once

#include <string>
#include <vector>

#include "nodes/gl/gl_platform.hpp"

namespace mural::gl {

struct GlInfo {
    std::string vendor, renderer, version;
    int glVersion = 0; // 10 * major + minor, e.g. 45
    bool es = false;
    std::vector<std::string> extensions;                     // sorted
    int maxSurfaceSize = 0;                                  // the smaller side of GL_MAX_VIEWPORT_DIMS
    ColorBuffers colorBuffers = ColorBuffers::OneNamedFront; // desktop GL only; of the current surface in a new context
};

// A context of the platform must be current. Errors: the driver returns no functions.
Result<GlInfo> readGlInfo(Platform& platform);

// The same for a new platform, with a temporary context and surface, for properties without a window-system query.
// Leaves no context current. embedded: accepts a driver with OpenGL ES only.
Result<GlInfo> measureGl(Platform& platform, bool embedded);

// Waits for all commands of the current context. Mesa's software driver does not always wait before it reads a surface
// that is current for reading only and was just drawn to (README.md).
void finishDrawing(Platform& platform);

// Returns the current context's temporary memory to the driver.
void flushDrawing(Platform& platform);

// Returns whether glReadPixels reads the content of a multisampled surface; true without such surfaces. Leaves no
// context current.
bool showsSamples(Platform& platform);

// "4.5 (Compatibility Profile) Mesa 22.3.6" → 45, "OpenGL ES-CM 1.1 Mesa" → 11; 0 without a number.
int parseGlVersion(const std::string& version);

// "4.5 (Compatibility Profile) Mesa 22.3.6" → 22; 0 for other drivers.
int parseMesaVersion(const std::string& version);

} // namespace mural::gl
