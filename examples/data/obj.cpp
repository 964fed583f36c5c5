// OBJ, Wavefront's text format: the vertices and faces of it. Texture coordinates, normals, materials and groups are
// skipped. Source: Alias Wavefront, "Object Files", appendix B1.
#include "examples/data/mesh_formats.hpp"
#include "examples/data/text_cursor.hpp"

namespace mural::examples {
namespace {

// Takes the vertex of a corner such as "7", "7/2" or "-1//3". Positive numbers count from 1, negative ones from the
// newest vertex.
void takeCorner(TextCursor& text, std::string_view word, size_t vertices, Fan& fan) {
    const auto number = text.parse<int64_t>(word.substr(0, word.find('/')), "index of a vertex");
    if (!text.ok()) return;
    const int64_t index = number > 0 ? number - 1 : static_cast<int64_t>(vertices) + number;
    if (number == 0 || index < 0 || index >= static_cast<int64_t>(vertices))
        text.fail("vertex " + std::to_string(number) + " does not exist; " + std::to_string(vertices) +
                  " vertices precede this face");
    else
        fan.add(static_cast<uint32_t>(index));
}

} // namespace

Result<Mesh> parseObj(std::string_view bytes, const std::string& file) {
    TextCursor text(bytes, file, '#');
    Mesh mesh;
    while (text.ok() && !text.isAtEnd()) {
        const std::string_view keyword = text.wordOfLine();
        if (keyword == "v") {
            Point point{};
            for (float& x : point) x = static_cast<float>(text.parse<double>(text.wordOfLine(), "coordinate"));
            mesh.positions.push_back(point);
        } else if (keyword == "f") {
            Fan fan(mesh.indices);
            for (auto word = text.wordOfLine(); !word.empty() && text.ok(); word = text.wordOfLine())
                takeCorner(text, word, mesh.positions.size(), fan);
        }
        if (text.ok()) text.restOfLine();
    }
    if (!text.ok()) return text.error();
    return mesh;
}

} // namespace mural::examples
