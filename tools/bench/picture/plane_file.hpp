// Planes in files, as written by plane_capture, and synthetic planes.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "compositor/image/plane.hpp"

namespace mural::bench {

struct NamedPlane {
    std::string name;
    compositor::Plane plane;
};

[[nodiscard]] Result<NamedPlane> readPlane(const std::string& path);
// Returns all *.plane files of a folder, sorted by name. Skips the files of a second frame (*.next.*).
[[nodiscard]] Result<std::vector<NamedPlane>> readPlanes(const std::string& folder);

} // namespace mural::bench
