#include "examples/data/mesh.hpp"

#include <cmath>

#include "examples/data/file_bytes.hpp"
#include "examples/data/mesh_formats.hpp"

namespace mural::examples {
namespace {

using Triple = std::array<double, 3>;

Triple difference(const Point& a, const Point& b) {
    return {double(a[0]) - double(b[0]), double(a[1]) - double(b[1]), double(a[2]) - double(b[2])};
}
Triple crossProduct(const Triple& a, const Triple& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Point unit(const Triple& a) {
    const double size = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    if (!(size > 0) || !std::isfinite(size)) return {0, 0, 1};
    return {float(a[0] / size), float(a[1] / size), float(a[2] / size)};
}

bool endsWith(std::string_view name, std::string_view ending) {
    return name.size() >= ending.size() && name.substr(name.size() - ending.size()) == ending;
}

Result<Mesh> finishMesh(Mesh mesh, const std::string& file) {
    if (mesh.positions.size() > UINT32_MAX) return Error{file + ": has more than 2^32 vertices"};
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        for (const float x : mesh.positions[v]) {
            if (!std::isfinite(x)) return Error{file + ": vertex " + std::to_string(v) + " is not finite"};
        }
    }
    for (size_t i = 0; i < mesh.indices.size(); ++i) {
        if (mesh.indices[i] >= mesh.positions.size())
            return Error{file + ": triangle " + std::to_string(i / 3) + " has vertex " +
                         std::to_string(mesh.indices[i]) + ", but there are " + std::to_string(mesh.positions.size()) +
                         " vertices"};
    }
    if (mesh.indices.empty()) return Error{file + ": has no faces; a mesh of triangles or polygons is needed"};
    if (mesh.normals.size() != mesh.positions.size()) computeNormals(mesh);
    for (Point& normal : mesh.normals) normal = unit({normal[0], normal[1], normal[2]});
    if (mesh.colours.size() != mesh.positions.size()) mesh.colours.clear();
    return mesh;
}

Result<Mesh> parseByContents(std::string_view bytes, const std::string& file) {
    if (bytes.substr(0, 3) == "ply") return parsePly(bytes, file);
    if (endsWith(file, ".obj") || endsWith(file, ".obj.gz")) return parseObj(bytes, file);
    if (isStl(bytes)) return parseStl(bytes, file);
    const std::string_view firstWord = bytes.substr(0, bytes.find_first_of(" \t\r\n"));
    if (endsWith(firstWord, "OFF")) return parseOff(bytes, file);
    return Error{file + ": is no PLY, OFF, STL or OBJ file"};
}

} // namespace

void computeNormals(Mesh& mesh) {
    std::vector<Triple> sums(mesh.positions.size(), Triple{});
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Point& a = mesh.positions[mesh.indices[i]];
        // The length of the cross product is twice the area.
        const Triple normal = crossProduct(difference(mesh.positions[mesh.indices[i + 1]], a),
                                           difference(mesh.positions[mesh.indices[i + 2]], a));
        for (size_t corner = i; corner < i + 3; ++corner) {
            for (size_t k = 0; k < 3; ++k) sums[mesh.indices[corner]][k] += normal[k];
        }
    }
    mesh.normals.resize(sums.size());
    for (size_t v = 0; v < sums.size(); ++v) mesh.normals[v] = unit(sums[v]);
}

Result<Mesh> parseMesh(std::string_view bytes, const std::string& file) {
    Result<Mesh> mesh = parseByContents(bytes, file);
    if (!mesh) return mesh.error();
    return finishMesh(std::move(*mesh), file);
}

Result<Mesh> readMesh(const std::string& path) {
    Result<std::string> bytes = readFile(path);
    if (!bytes) return bytes.error();
    return parseMesh(*bytes, path);
}

} // namespace mural::examples
