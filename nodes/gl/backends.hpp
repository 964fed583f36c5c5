// The constructors of the backends; openPlatform() chooses among them.
#pragma once

#include <memory>

#include "nodes/gl/gl_platform.hpp"

namespace mural::gl {

// Each has made a context and drawn nothing when it returns: a backend that opens, works.
// Leaves no context current.
Result<std::unique_ptr<Platform>> openEgl();
Result<std::unique_ptr<Platform>> openOsmesa();
Result<std::unique_ptr<Platform>> openGlx(); // on the display that DISPLAY names

} // namespace mural::gl
