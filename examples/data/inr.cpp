// INR files: a text header of a multiple of 256 bytes that ends with "##}", then the voxels. Source: INRIA,
// "Format des images Inrimage", version 4.
#include "examples/data/text_cursor.hpp"
#include "examples/data/volume_formats.hpp"

namespace mural::examples {
namespace {

constexpr size_t kHeaderStep = 256;

// The header's values of the type.
struct Kind {
    bool isFloat = false, isSigned = false;
    uint32_t bits = 0;
};

std::optional<VoxelType> typeOf(const Kind& kind) {
    if (kind.isFloat) {
        if (kind.bits == 32) return VoxelType::Float32;
        return kind.bits == 64 ? std::optional(VoxelType::Float64) : std::nullopt;
    }
    switch (kind.bits) {
    case 8: return kind.isSigned ? VoxelType::Int8 : VoxelType::Uint8;
    case 16: return kind.isSigned ? VoxelType::Int16 : VoxelType::Uint16;
    case 32: return kind.isSigned ? VoxelType::Int32 : VoxelType::Uint32;
    default: return std::nullopt;
    }
}

void takeField(TextCursor& text, std::string_view field, std::string_view value, VoxelSource& source, Kind& kind) {
    const auto number = [&] { return text.parse<double>(value, "number"); };
    const auto size = [&] { return uint64_t{text.parse<uint32_t>(value, "size")}; };
    if (field == "XDIM")
        source.size[0] = size();
    else if (field == "YDIM")
        source.size[1] = size();
    else if (field == "ZDIM")
        source.size[2] = size();
    else if (field == "VX")
        source.spacing[0] = number();
    else if (field == "VY")
        source.spacing[1] = number();
    else if (field == "VZ")
        source.spacing[2] = number();
    else if (field == "PIXSIZE")
        kind.bits = text.parse<uint32_t>(value.substr(0, value.find(' ')), "number of bits");
    else if (field == "VDIM" && value != "1")
        text.fail("has " + TextCursor::shortened(value) + " values per voxel; 1 is needed");
    else if (field == "CPU")
        source.order = value == "sun" || value == "sgi" ? std::endian::big : std::endian::little;
    else if (field == "TYPE") {
        kind.isFloat = value.substr(0, 5) == "float";
        kind.isSigned = value.substr(0, 6) == "signed";
    }
}

} // namespace

Result<Volume> parseInr(std::string_view bytes, const std::string& file, const VolumeWish& wish) {
    constexpr std::string_view kEnd = "##}";
    const size_t end = bytes.find(kEnd);
    const size_t length = end == std::string_view::npos ? 0 : end + kEnd.size() + 1; // a line end follows
    if (length == 0 || length % kHeaderStep != 0 || length > bytes.size())
        return Error{file + ": the header does not end with \"##}\" after a multiple of 256 bytes"};
    TextCursor text(bytes.substr(0, end), file);
    VoxelSource source;
    Kind kind;
    while (text.ok() && !text.isAtEnd()) {
        TextCursor next = text;
        const std::string_view line = next.restOfLine();
        const size_t equals = line.find('=');
        if (equals != std::string_view::npos)
            takeField(text, line.substr(0, equals), line.substr(equals + 1), source, kind);
        if (text.ok()) text = next;
    }
    if (!text.ok()) return text.error();
    const std::optional<VoxelType> type = typeOf(kind);
    if (!type) return Error{file + ": voxels of " + std::to_string(kind.bits) + " bits are not read"};
    source.type = *type;
    source.begin = length;
    source.bytes = bytes.substr(length);
    return convertVoxels(source, file, wish);
}

} // namespace mural::examples
