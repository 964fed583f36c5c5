// Feeds arbitrary bytes to the readers of meshes. They report an error or return a mesh whose indices are valid.
#include <cmath>

#include "examples/data/mesh.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace mural::fuzz {

uint64_t fuzzOne(std::span<const std::byte> input) {
    const std::string_view bytes(reinterpret_cast<const char*>(input.data()), input.size());
    uint64_t triangles = 0;
    for (const char* file : {"input", "input.obj"}) { // OBJ is selected by its name
        const Result<examples::Mesh> mesh = examples::parseMesh(bytes, file);
        if (!mesh) {
            must(mesh.error().message.rfind(file, 0) == 0, "an error names the file");
            continue;
        }
        const examples::Mesh& m = mesh.value();
        must(m.triangles() > 0 && m.indices.size() == 3 * m.triangles(), "a mesh has whole triangles");
        must(m.normals.size() == m.positions.size(), "every vertex has a normal");
        must(m.colours.empty() || m.colours.size() == m.positions.size(), "every vertex has a colour, or none");
        for (const uint32_t index : m.indices) must(index < m.positions.size(), "an index has a vertex");
        for (const auto& position : m.positions) must(std::isfinite(position[0]), "a position is finite");
        triangles += m.triangles();
    }
    return triangles;
}

} // namespace mural::fuzz
