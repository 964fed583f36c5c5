// What a backend of this machine can do: for `mural doctor`, a node's Ready message, and for
// telling programs no more than every node has.
#pragma once

#include <string>
#include <vector>

#include "nodes/gl/gl_platform.hpp"

namespace mural::gl {

struct GlProbe {
    std::string backend; // Platform::describe()
    std::string vendor, renderer, version;
    int glVersion = 0;   // 10 * major + minor
    bool es = false;
    std::vector<std::string> extensions; // sorted
    int maxSurfaceSize = 0;

    [[nodiscard]] bool has(const std::string& extension) const;
};

// Makes a small surface and a context of the highest version and asks it. core: the highest core
// profile; desktop only. Afterwards no context is current on this thread.
Result<GlProbe> probe(Platform& platform, Api api, bool core);

} // namespace mural::gl
