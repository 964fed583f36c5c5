// Triangle meshes, and their files: PLY, OFF, STL and OBJ, each optionally compressed with gzip.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"

namespace mural::examples {

using Point = std::array<float, 3>;
using Colour = std::array<uint8_t, 4>; // red, green, blue, alpha

struct Mesh {
    std::vector<Point> positions;
    std::vector<Point> normals;    // one per position, of length 1
    std::vector<Colour> colours;   // one per position, or none
    std::vector<uint32_t> indices; // three per triangle, each below positions.size()

    [[nodiscard]] size_t triangles() const { return indices.size() / 3; }
};

// Reads a mesh file. The contents select the format; OBJ, which has no mark, is selected by the ending .obj or .obj.gz.
// Polygons become fans of triangles. Missing normals are computed. Errors: the file, the line or byte, the problem.
Result<Mesh> readMesh(const std::string& path);
// The same of contents in memory. `file` is the name in errors; its ending matters for OBJ alone.
Result<Mesh> parseMesh(std::string_view bytes, const std::string& file);

// Sets normals of vertices: the normals of their triangles, weighted by area. Triangles without an area have no weight.
// A vertex without any normal gets 0 0 1.
void computeNormals(Mesh& mesh);

} // namespace mural::examples
