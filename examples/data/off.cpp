// OFF, the object file format of Geomview: counts, then vertices, then faces as lists of vertices. The variants COFF
// (colours) and NOFF (normals) are read as well. Source: Geomview's manual, "OFF Files".
#include <algorithm>

#include "examples/data/mesh_formats.hpp"
#include "examples/data/text_cursor.hpp"

namespace mural::examples {
namespace {

// A colour component is a number from 0 to 255, or from 0 to 1 if it has a point.
uint8_t takeColour(TextCursor& text) {
    const std::string_view word = text.word();
    const double value = text.parse<double>(word, "colour") * (word.find('.') == std::string_view::npos ? 1 : 255);
    return value >= 255 ? 255 : value > 0 ? static_cast<uint8_t>(value + .5) : 0;
}

Point takePoint(TextCursor& text) {
    const double x = text.number("coordinate");
    const double y = text.number("coordinate");
    const double z = text.number("coordinate");
    return {float(x), float(y), float(z)};
}

} // namespace

Result<Mesh> parseOff(std::string_view bytes, const std::string& file) {
    TextCursor text(bytes, file, '#');
    const std::string_view form = text.word();
    if (form != "OFF" && form != "COFF" && form != "NOFF" && form != "CNOFF")
        return Error{file + ":1: the variant " + TextCursor::shortened(form) + " is not read; OFF, COFF and NOFF are"};
    const bool hasColours = form.front() == 'C';
    const bool hasNormals = form.find('N') != std::string_view::npos;
    const uint32_t vertices = text.count("number of vertices");
    const uint32_t faces = text.count("number of faces");
    text.count("number of edges");
    Mesh mesh;
    // A coordinate takes at least two bytes of text, so the memory is bounded by the file.
    mesh.positions.reserve(std::min<size_t>(vertices, text.bytesLeft() / 6));
    mesh.indices.reserve(std::min<size_t>(faces, text.bytesLeft() / 8) * 3);
    for (uint32_t v = 0; v < vertices && text.ok(); ++v) {
        mesh.positions.push_back(takePoint(text));
        if (hasNormals) mesh.normals.push_back(takePoint(text));
        if (hasColours) {
            Colour& colour = mesh.colours.emplace_back();
            for (uint8_t& component : colour) component = takeColour(text);
        }
    }
    for (uint32_t f = 0; f < faces && text.ok(); ++f) {
        const uint32_t corners = text.count("number of corners");
        Fan fan(mesh.indices);
        for (uint32_t k = 0; k < corners && text.ok(); ++k) fan.add(text.count("index of a vertex"));
        text.restOfLine(); // the colour of the face
    }
    if (!text.ok()) return text.error();
    return mesh;
}

} // namespace mural::examples
