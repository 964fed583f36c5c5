// NRRD files with header and voxels in one file: lines of text, an empty line, then the voxels, raw or as gzip.
// Orientation is not used. Source: Gordon Kindlmann, "Definition of NRRD File Format", teem.sourceforge.net.
#include <algorithm>
#include <cmath>
#include <utility>

#include "examples/data/file_bytes.hpp"
#include "examples/data/text_cursor.hpp"
#include "examples/data/volume_formats.hpp"

namespace mural::examples {
namespace {

enum class Encoding : uint8_t { Raw, Gzip };

struct Header {
    VoxelSource source;
    Encoding encoding = Encoding::Raw;
    bool hasType = false, hasSizes = false, hasEncoding = false, hasOrder = false;
};

std::optional<VoxelType> typeNamed(std::string_view name) {
    static constexpr std::array<std::pair<std::string_view, VoxelType>, 20> kTypes{{
        {"signed char", VoxelType::Int8}, {"int8", VoxelType::Int8},           {"int8_t", VoxelType::Int8},
        {"uchar", VoxelType::Uint8},      {"unsigned char", VoxelType::Uint8}, {"uint8", VoxelType::Uint8},
        {"uint8_t", VoxelType::Uint8},    {"short", VoxelType::Int16},         {"int16", VoxelType::Int16},
        {"int16_t", VoxelType::Int16},    {"ushort", VoxelType::Uint16},       {"unsigned short", VoxelType::Uint16},
        {"uint16", VoxelType::Uint16},    {"uint16_t", VoxelType::Uint16},     {"int", VoxelType::Int32},
        {"int32", VoxelType::Int32},      {"uint", VoxelType::Uint32},         {"uint32", VoxelType::Uint32},
        {"float", VoxelType::Float32},    {"double", VoxelType::Float64},
    }};
    for (const auto& [known, type] : kTypes) {
        if (known == name) return type;
    }
    return std::nullopt;
}

std::string_view trimmed(std::string_view text) {
    const size_t begin = text.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

// Returns the numbers of a list of three; fails otherwise.
std::array<double, 3> threeNumbers(TextCursor& text, std::string_view value, const char* what) {
    std::array<double, 3> numbers{};
    TextCursor words(value, "");
    for (double& number : numbers) number = text.parse<double>(words.word(), what);
    if (text.ok() && !words.word().empty()) text.fail(std::string("has more than three values of ") + what);
    return numbers;
}

// Returns the lengths of three vectors such as (0.9,0,0) (0,0.9,0) (0,0,1.5).
std::array<double, 3> vectorLengths(TextCursor& text, std::string_view value) {
    std::string numbers(value);
    std::replace_if(
        numbers.begin(), numbers.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
    TextCursor words(numbers, "");
    std::array<double, 3> lengths{};
    for (double& length : lengths) {
        double square = 0;
        for (int k = 0; k < 3; ++k) {
            const auto number = text.parse<double>(words.word(), "space direction");
            square += number * number;
        }
        length = std::sqrt(square);
    }
    return lengths;
}

void takeField(TextCursor& text, std::string_view field, std::string_view value, Header& header) {
    VoxelSource& source = header.source;
    const std::string shown = "\"" + TextCursor::shortened(value) + "\"";
    if (field == "dimension") {
        if (value != "3") text.fail("has " + shown + " dimensions; 3 are needed");
    } else if (field == "type") {
        const std::optional<VoxelType> type = typeNamed(value);
        if (!type) return text.fail("voxels of type " + shown + " are not read");
        source.type = *type;
        header.hasType = true;
    } else if (field == "sizes") {
        const std::array<double, 3> sizes = threeNumbers(text, value, "size");
        for (size_t k = 0; k < 3; ++k)
            source.size[k] = sizes[k] >= 0 && sizes[k] <= double(kMaxVoxelsPerAxis) + 1 ? uint64_t(sizes[k]) : 0;
        header.hasSizes = true;
    } else if (field == "spacings") {
        source.spacing = threeNumbers(text, value, "spacing");
    } else if (field == "space directions") {
        source.spacing = vectorLengths(text, value);
    } else if (field == "endian") {
        if (value != "little" && value != "big") return text.fail(shown + " is no byte order");
        source.order = value == "little" ? std::endian::little : std::endian::big;
        header.hasOrder = true;
    } else if (field == "encoding") {
        if (value != "raw" && value != "gzip" && value != "gz")
            return text.fail("the encoding " + shown + " is not read; raw and gzip are");
        header.encoding = value == "raw" ? Encoding::Raw : Encoding::Gzip;
        header.hasEncoding = true;
    } else if (field == "data file" || field == "datafile") {
        text.fail("the voxels are in a separate file, which is not read");
    } else if (field == "line skip" || field == "lineskip" || field == "byte skip" || field == "byteskip") {
        if (value != "0") text.fail("the field \"" + std::string(field) + "\" is not supported");
    }
}

Header parseHeader(TextCursor& text) {
    Header header;
    text.restOfLine(); // the magic
    while (text.ok()) {
        if (text.isAtEnd()) {
            text.fail("ends before the empty line that precedes the voxels");
            break;
        }
        TextCursor next = text;
        const std::string_view line = next.restOfLine();
        const size_t colon = line.find(": ");
        if (!line.empty() && line.front() != '#' && colon != std::string_view::npos)
            takeField(text, line.substr(0, colon), trimmed(line.substr(colon + 2)), header);
        if (!text.ok()) break;
        text = next;
        if (line.empty()) break;
    }
    if (!header.hasType) text.fail("the header has no field \"type\"");
    if (!header.hasSizes) text.fail("the header has no field \"sizes\"");
    if (!header.hasEncoding) text.fail("the header has no field \"encoding\"");
    if (!header.hasOrder && bytesOf(header.source.type) > 1) text.fail("the header has no field \"endian\"");
    return header;
}

} // namespace

Result<Volume> parseNrrd(std::string_view bytes, const std::string& file, const VolumeWish& wish) {
    TextCursor text(bytes, file);
    Header header = parseHeader(text);
    if (!text.ok()) return text.error();
    VoxelSource& source = header.source;
    source.begin = text.position();
    source.bytes = bytes.substr(source.begin);
    if (header.encoding == Encoding::Raw) return convertVoxels(source, file, wish);
    const Result<uint64_t> needed = neededBytes(source, file);
    if (!needed) return needed.error();
    const Result<std::string> voxels = gunzip(source.bytes, file, needed.value());
    if (!voxels) return voxels.error();
    source.bytes = voxels.value();
    return convertVoxels(source, file, wish);
}

} // namespace mural::examples
