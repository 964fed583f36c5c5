// Planes in files, as plane_capture writes them, and planes made up here.
#pragma once

#include <string>
#include <vector>

#include "common/result.hpp"
#include "compositor/image/plane.hpp"

namespace mural::bench {

struct NamedPlane {
    std::string name;
    compositor::Plane plane;
};

[[nodiscard]] Result<NamedPlane> readPlane(const std::string& path);
// All *.plane of a folder, sorted by name, those of a second frame (*.next.*) left out.
[[nodiscard]] Result<std::vector<NamedPlane>> readPlanes(const std::string& folder);

} // namespace mural::bench
