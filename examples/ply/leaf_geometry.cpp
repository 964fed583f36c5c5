#include "examples/ply/leaf_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>

namespace mural::examples {
namespace {

struct Header {
    uint32_t magic = 0x4641454c; // "LEAF"
    uint32_t vertices = 0, indices = 0, reserved = 0;
};
static_assert(sizeof(Header) == 16);

LeafVertex vertexOf(const Mesh& mesh, uint32_t index) {
    LeafVertex vertex{mesh.positions[index], {}, {255, 255, 255, 255}};
    for (size_t k = 0; k < 3; ++k)
        vertex.normal[k] = static_cast<int16_t>(std::lround(std::clamp(mesh.normals[index][k], -1.f, 1.f) * 32767));
    if (!mesh.colours.empty()) vertex.colour = mesh.colours[index];
    return vertex;
}

} // namespace

std::vector<std::byte> packLeaf(const Mesh& mesh, std::span<const uint32_t> triangles) {
    std::vector<LeafVertex> vertices;
    std::vector<uint16_t> indices;
    std::unordered_map<uint32_t, uint16_t> known;
    for (const uint32_t triangle : triangles) {
        for (size_t corner = 0; corner < 3; ++corner) {
            const uint32_t index = mesh.indices[3 * size_t{triangle} + corner];
            const auto [entry, isNew] = known.try_emplace(index, static_cast<uint16_t>(vertices.size()));
            if (isNew) vertices.push_back(vertexOf(mesh, index));
            indices.push_back(entry->second);
        }
    }
    Header header;
    header.vertices = static_cast<uint32_t>(vertices.size());
    header.indices = static_cast<uint32_t>(indices.size());
    std::vector<std::byte> bytes;
    const auto append = [&bytes](std::span<const std::byte> more) {
        bytes.insert(bytes.end(), more.begin(), more.end());
    };
    append(std::as_bytes(std::span(&header, 1)));
    append(std::as_bytes(std::span(vertices)));
    append(std::as_bytes(std::span(indices)));
    return bytes;
}

std::optional<LeafView> viewLeaf(std::span<const std::byte> bytes) {
    Header header, expected;
    if (bytes.size() < sizeof(header)) return std::nullopt;
    std::memcpy(&header, bytes.data(), sizeof(header));
    const uint64_t vertexBytes = uint64_t{header.vertices} * sizeof(LeafVertex);
    if (header.magic != expected.magic || header.indices % 3 != 0 ||
        bytes.size() != sizeof(header) + vertexBytes + uint64_t{header.indices} * sizeof(uint16_t))
        return std::nullopt;
    const std::byte* vertices = bytes.data() + sizeof(header);
    const LeafView view{{reinterpret_cast<const LeafVertex*>(vertices), header.vertices},
                        {reinterpret_cast<const uint16_t*>(vertices + vertexBytes), header.indices}};
    const auto isValid = [&](uint16_t index) { return index < header.vertices; };
    if (!std::all_of(view.indices.begin(), view.indices.end(), isValid)) return std::nullopt;
    return view;
}

} // namespace mural::examples
