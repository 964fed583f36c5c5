// The constructors of the backends. openPlatform() selects one.
#pragma once

#include <memory>

#include "nodes/gl/gl_platform.hpp"

namespace mural::gl {

// Each constructor creates a test context, so that an opened backend works. Leaves no context current.
Result<std::unique_ptr<Platform>> openEgl(const GpuChoice& choice);
Result<std::unique_ptr<Platform>> openOsmesa();
Result<std::unique_ptr<Platform>> openGlx(); // on the display named by DISPLAY

} // namespace mural::gl
