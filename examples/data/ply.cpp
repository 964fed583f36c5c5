// PLY, the Stanford polygon format: a text header that lists elements and their properties, then the elements as text
// or as binary in either byte order. Source: Greg Turk, "The PLY Polygon File Format", 1994.
#include <algorithm>
#include <optional>

#include "examples/data/byte_cursor.hpp"
#include "examples/data/mesh_formats.hpp"
#include "examples/data/text_cursor.hpp"

namespace mural::examples {
namespace {

enum class Type : uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

struct Property {
    std::string name;
    Type type = Type::Float32;
    std::optional<Type> countType; // of lists
};

struct Element {
    std::string name;
    uint32_t count = 0;
    std::vector<Property> properties;
};

enum class Encoding : uint8_t { Ascii, Little, Big };

struct Header {
    std::optional<Encoding> encoding;
    std::vector<Element> elements;
};

std::optional<Type> typeNamed(std::string_view name) {
    static constexpr std::array<std::pair<std::string_view, Type>, 16> kTypes{{{"char", Type::Int8},
                                                                               {"int8", Type::Int8},
                                                                               {"uchar", Type::Uint8},
                                                                               {"uint8", Type::Uint8},
                                                                               {"short", Type::Int16},
                                                                               {"int16", Type::Int16},
                                                                               {"ushort", Type::Uint16},
                                                                               {"uint16", Type::Uint16},
                                                                               {"int", Type::Int32},
                                                                               {"int32", Type::Int32},
                                                                               {"uint", Type::Uint32},
                                                                               {"uint32", Type::Uint32},
                                                                               {"float", Type::Float32},
                                                                               {"float32", Type::Float32},
                                                                               {"double", Type::Float64},
                                                                               {"float64", Type::Float64}}};
    for (const auto& [known, type] : kTypes) {
        if (known == name) return type;
    }
    return std::nullopt;
}

Type takeType(TextCursor& text) {
    const std::string_view name = text.wordOfLine();
    const std::optional<Type> type = typeNamed(name);
    if (!type) text.fail("\"" + TextCursor::shortened(name) + "\" is no type of PLY");
    return type.value_or(Type::Int8);
}

void parseProperty(TextCursor& text, Header& header) {
    if (header.elements.empty()) return text.fail("a property precedes the first element");
    Property property;
    TextCursor ahead = text;
    if (ahead.wordOfLine() == "list") {
        text = ahead;
        property.countType = takeType(text);
        if (property.countType >= Type::Float32) text.fail("the length of a list is no integer");
    }
    property.type = takeType(text);
    property.name = text.wordOfLine();
    if (text.ok() && property.name.empty()) text.fail("the property has no name");
    header.elements.back().properties.push_back(std::move(property));
}

void parseFormat(TextCursor& text, Header& header) {
    const std::string_view name = text.wordOfLine();
    if (name == "ascii")
        header.encoding = Encoding::Ascii;
    else if (name == "binary_little_endian")
        header.encoding = Encoding::Little;
    else if (name == "binary_big_endian")
        header.encoding = Encoding::Big;
    else
        text.fail("\"" + TextCursor::shortened(name) + "\" is no format of PLY");
}

Header parseHeader(TextCursor& text) {
    Header header;
    text.restOfLine(); // "ply"
    while (text.ok()) {
        if (text.isAtEnd()) text.fail("ends before end_header");
        const std::string_view keyword = text.wordOfLine();
        if (keyword == "end_header") {
            if (!header.encoding) text.fail("the header has no line \"format\"");
            text.restOfLine();
            return header;
        }
        if (keyword == "format") {
            parseFormat(text, header);
        } else if (keyword == "element") {
            Element& element = header.elements.emplace_back();
            element.name = text.wordOfLine();
            element.count = text.parse<uint32_t>(text.wordOfLine(), "number of elements");
        } else if (keyword == "property") {
            parseProperty(text, header);
        } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
            text.fail("\"" + TextCursor::shortened(keyword) + "\" is no keyword of PLY");
        }
        if (text.ok()) text.restOfLine();
    }
    return header;
}

// The values of the elements, from text.
class TextValues {
public:
    explicit TextValues(TextCursor& text) : cursor(text) {}
    double take(Type) { return cursor.number("number"); }
    TextCursor& cursor;
};

// The values of the elements, from binary.
class BinaryValues {
public:
    explicit BinaryValues(ByteCursor& bytes) : cursor(bytes) {}
    double take(Type type) {
        constexpr const char* kWhat = "the end of its elements";
        switch (type) {
        case Type::Int8: return cursor.take<int8_t>(kWhat);
        case Type::Uint8: return cursor.take<uint8_t>(kWhat);
        case Type::Int16: return cursor.take<int16_t>(kWhat);
        case Type::Uint16: return cursor.take<uint16_t>(kWhat);
        case Type::Int32: return cursor.take<int32_t>(kWhat);
        case Type::Uint32: return cursor.take<uint32_t>(kWhat);
        case Type::Float32: return cursor.take<float>(kWhat);
        case Type::Float64: break;
        }
        return cursor.take<double>(kWhat);
    }
    ByteCursor& cursor;
};

// Calls use(value) for each value of a list.
template <class Values, class Use> void takeList(Values& values, const Property& property, Use&& use) {
    const double count = values.take(*property.countType);
    if (!(count >= 0)) values.cursor.fail("the length of a list is negative");
    for (double k = 0; k < count && values.cursor.ok(); ++k) use(values.take(property.type));
}

template <class Values> void skipElements(Values& values, const Element& element) {
    if (element.properties.empty()) return;
    for (uint32_t e = 0; e < element.count && values.cursor.ok(); ++e) {
        for (const Property& property : element.properties) {
            if (property.countType)
                takeList(values, property, [](double) {});
            else
                values.take(property.type);
        }
    }
}

// The slot of a property of vertices: 0 to 2 position, 3 to 5 normal, 6 to 9 colour.
constexpr size_t kVertexSlots = 10;
size_t slotOfVertex(const std::string& name) {
    static constexpr std::array<std::string_view, kVertexSlots> kNames{"x",  "y",   "z",     "nx",   "ny",
                                                                       "nz", "red", "green", "blue", "alpha"};
    return static_cast<size_t>(std::find(kNames.begin(), kNames.end(), name) - kNames.begin());
}

uint8_t colourOf(double value, Type type) {
    const double scale = type >= Type::Float32 ? 255 : type == Type::Uint16 ? 1 / 257. : 1;
    const double scaled = value * scale;
    return scaled >= 255 ? 255 : scaled > 0 ? static_cast<uint8_t>(scaled + .5) : 0;
}

template <class Values> void takeVertices(Values& values, const Element& element, Mesh& mesh) {
    std::array<bool, kVertexSlots> has{};
    for (const Property& property : element.properties) {
        const size_t slot = slotOfVertex(property.name);
        if (slot < kVertexSlots && !property.countType) has[slot] = true;
    }
    if (!has[0] || !has[1] || !has[2]) return values.cursor.fail("the vertices have no x, y and z");
    const bool hasNormals = has[3] && has[4] && has[5];
    const bool hasColours = has[6] && has[7] && has[8];
    // An element takes at least a byte per property, so the memory is bounded by the file.
    const size_t expected = std::min<size_t>(element.count, values.cursor.bytesLeft() / element.properties.size());
    mesh.positions.reserve(expected);
    if (hasNormals) mesh.normals.reserve(expected);
    if (hasColours) mesh.colours.reserve(expected);
    for (uint32_t e = 0; e < element.count && values.cursor.ok(); ++e) {
        std::array<double, kVertexSlots> slots{};
        slots[9] = 255;
        for (const Property& property : element.properties) {
            if (property.countType) {
                takeList(values, property, [](double) {});
                continue;
            }
            const size_t slot = slotOfVertex(property.name);
            const double value = values.take(property.type);
            if (slot < kVertexSlots) slots[slot] = slot < 6 ? value : colourOf(value, property.type);
        }
        mesh.positions.push_back({float(slots[0]), float(slots[1]), float(slots[2])});
        if (hasNormals) mesh.normals.push_back({float(slots[3]), float(slots[4]), float(slots[5])});
        if (hasColours)
            mesh.colours.push_back({uint8_t(slots[6]), uint8_t(slots[7]), uint8_t(slots[8]), uint8_t(slots[9])});
    }
}

template <class Values> void takeFaces(Values& values, const Element& element, Mesh& mesh) {
    const auto isIndices = [](const Property& p) {
        return p.countType && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    if (std::none_of(element.properties.begin(), element.properties.end(), isIndices))
        return values.cursor.fail("the faces have no list vertex_indices");
    mesh.indices.reserve(std::min<size_t>(element.count, values.cursor.bytesLeft() / 4) * 3);
    for (uint32_t e = 0; e < element.count && values.cursor.ok(); ++e) {
        for (const Property& property : element.properties) {
            if (isIndices(property)) {
                Fan fan(mesh.indices);
                takeList(values, property, [&](double index) {
                    if (!(index >= 0 && index < double(UINT32_MAX)))
                        values.cursor.fail("the index of a vertex is negative or too large");
                    else
                        fan.add(static_cast<uint32_t>(index));
                });
            } else if (property.countType) {
                takeList(values, property, [](double) {});
            } else {
                values.take(property.type);
            }
        }
    }
}

template <class Values> Result<Mesh> takeMesh(Values values, const Header& header) {
    Mesh mesh;
    for (const Element& element : header.elements) {
        if (element.name == "vertex" && mesh.positions.empty())
            takeVertices(values, element, mesh);
        else if (element.name == "face")
            takeFaces(values, element, mesh);
        else
            skipElements(values, element);
        if (!values.cursor.ok()) return values.cursor.error();
    }
    return mesh;
}

} // namespace

Result<Mesh> parsePly(std::string_view bytes, const std::string& file) {
    TextCursor text(bytes, file);
    const Header header = parseHeader(text);
    if (!text.ok()) return text.error();
    if (header.encoding == Encoding::Ascii) return takeMesh(TextValues(text), header);
    const size_t begin = text.position();
    ByteCursor data(bytes.substr(begin), file,
                    header.encoding == Encoding::Little ? std::endian::little : std::endian::big, begin);
    return takeMesh(BinaryValues(data), header);
}

} // namespace mural::examples
