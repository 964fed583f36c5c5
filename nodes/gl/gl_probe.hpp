// Queries the capabilities of a backend, for `mural doctor`, a node's Ready message, and the intersection that programs
// see.
#pragma once

#include <string>
#include <vector>

#include "nodes/gl/gl_platform.hpp"

namespace mural::gl {

struct GlProbe {
    std::string backend; // Platform::describe()
    std::string vendor, renderer, version;
    int glVersion = 0; // 10 * major + minor
    bool es = false;
    std::vector<std::string> extensions; // sorted
    int maxSurfaceSize = 0;

    [[nodiscard]] bool has(const std::string& extension) const;
};

// Queries a small surface with a context of the highest version. core: the highest core profile; desktop GL only.
// Leaves no context current.
Result<GlProbe> probe(Platform& platform, Api api, bool core);

} // namespace mural::gl
