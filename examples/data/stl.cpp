// STL, stereolithography: triangles without shared vertices, as text or binary (little endian). Equal positions become
// one vertex, so that computed normals are smooth. The normals of the file, one per triangle, are not used.
// Source: 3D Systems, "StereoLithography Interface Specification", 1988.
#include <bit>
#include <cmath>
#include <unordered_map>

#include "examples/data/byte_cursor.hpp"
#include "examples/data/mesh_formats.hpp"
#include "examples/data/text_cursor.hpp"

namespace mural::examples {
namespace {

constexpr size_t kHeaderBytes = 84; // 80 of text, 4 of the number of triangles
constexpr size_t kTriangleBytes = 50;

// Collects triangles and merges equal positions.
class Welder {
public:
    void add(Point point) {
        for (float& x : point) x = x == 0 ? 0 : x; // -0 equals 0
        const auto [entry, isNew] = vertices_.try_emplace(point, static_cast<uint32_t>(mesh.positions.size()));
        if (isNew) mesh.positions.push_back(point);
        mesh.indices.push_back(entry->second);
    }
    Mesh mesh;

private:
    struct Hash {
        size_t operator()(const Point& p) const {
            uint64_t hash = 0;
            for (const float x : p) hash = (hash ^ std::bit_cast<uint32_t>(x)) * 0x9e3779b97f4a7c15ull;
            return hash ^ hash >> 32;
        }
    };
    std::unordered_map<Point, uint32_t, Hash> vertices_;
};

uint64_t binaryTriangles(std::string_view bytes) {
    return loadNumber<uint32_t>(bytes.data() + kHeaderBytes - 4, std::endian::little);
}

// Binary files may begin with "solid" too, so their length decides.
bool isBinary(std::string_view bytes) {
    return bytes.size() >= kHeaderBytes && bytes.size() == kHeaderBytes + kTriangleBytes * binaryTriangles(bytes);
}

Result<Mesh> parseBinary(std::string_view bytes, const std::string& file) {
    ByteCursor cursor(bytes.substr(kHeaderBytes), file, std::endian::little, kHeaderBytes);
    Welder welder;
    const uint64_t triangles = binaryTriangles(bytes);
    for (uint64_t t = 0; t < triangles && cursor.ok(); ++t) {
        for (int k = 0; k < 3; ++k) cursor.take<float>("a normal");
        for (int corner = 0; corner < 3; ++corner) {
            Point point{};
            for (float& x : point) {
                x = cursor.take<float>("a vertex");
                if (!std::isfinite(x)) cursor.fail("a coordinate is not finite");
            }
            welder.add(point);
        }
        cursor.take<uint16_t>("the attribute of a triangle");
    }
    if (!cursor.ok()) return cursor.error();
    return std::move(welder.mesh);
}

void expect(TextCursor& text, std::string_view wanted) {
    const std::string_view word = text.word();
    if (word != wanted && text.ok())
        text.fail("\"" + TextCursor::shortened(word) + "\" stands in place of \"" + std::string(wanted) + "\"");
}

void takeFacet(TextCursor& text, Welder& welder) {
    expect(text, "normal");
    for (int k = 0; k < 3; ++k) text.word(); // may be "nan" in the files of some programs
    expect(text, "outer");
    expect(text, "loop");
    for (int corner = 0; corner < 3 && text.ok(); ++corner) {
        expect(text, "vertex");
        Point point{};
        for (float& x : point) {
            x = static_cast<float>(text.number("coordinate"));
            if (!std::isfinite(x)) text.fail("a coordinate is not finite");
        }
        welder.add(point);
    }
    expect(text, "endloop");
    expect(text, "endfacet");
}

Result<Mesh> parseText(std::string_view bytes, const std::string& file) {
    TextCursor text(bytes, file);
    Welder welder;
    for (std::string_view word = text.word(); !word.empty() && text.ok(); word = text.word()) {
        if (word == "solid" || word == "endsolid")
            text.restOfLine(); // its name
        else if (word == "facet")
            takeFacet(text, welder);
        else
            text.fail("\"" + TextCursor::shortened(word) + "\" is no keyword of STL");
    }
    if (!text.ok()) return text.error();
    return std::move(welder.mesh);
}

} // namespace

bool isStl(std::string_view bytes) { return isBinary(bytes) || bytes.substr(0, 5) == "solid"; }

Result<Mesh> parseStl(std::string_view bytes, const std::string& file) {
    return isBinary(bytes) ? parseBinary(bytes, file) : parseText(bytes, file);
}

} // namespace mural::examples
