// Describes a node for its Ready message: host, process, and the GL that programs can use on it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "nodes/gl/gl_platform.hpp"

namespace mural {

// Keys: host, pid; renderer, glVersion (the highest of desktop GL), maxPixels (the largest surface), and extensions of
// all kinds of contexts.
[[nodiscard]] nlohmann::json describeNode(gl::Platform& platform);

} // namespace mural
