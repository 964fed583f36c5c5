// NIfTI-1 files with header and voxels in one file (.nii): a header of 348 bytes in the byte order of its writer, then
// the voxels. Orientation is not used. Source: nifti1.h of the NIfTI Data Format Working Group, 2007.
#include "examples/data/byte_cursor.hpp"
#include "examples/data/volume_formats.hpp"

namespace mural::examples {
namespace {

constexpr size_t kHeaderBytes = 348;
// Offsets of the header.
constexpr size_t kDim = 40, kDataType = 70, kPixDim = 76, kVoxOffset = 108, kSlope = 112, kIntercept = 116,
                 kMagic = 344;

std::optional<VoxelType> typeOf(int16_t code) {
    switch (code) {
    case 2: return VoxelType::Uint8;
    case 4: return VoxelType::Int16;
    case 8: return VoxelType::Int32;
    case 16: return VoxelType::Float32;
    case 64: return VoxelType::Float64;
    case 256: return VoxelType::Int8;
    case 512: return VoxelType::Uint16;
    case 768: return VoxelType::Uint32;
    default: return std::nullopt;
    }
}

} // namespace

bool isNifti(std::string_view bytes) {
    return bytes.size() >= kHeaderBytes && (bytes.substr(kMagic, 3) == "n+1" || bytes.substr(kMagic, 3) == "ni1");
}

Result<Volume> parseNifti(std::string_view bytes, const std::string& file, const VolumeWish& wish) {
    if (bytes.substr(kMagic, 3) == "ni1")
        return Error{file + ": byte 344: the voxels are in a separate file .img, which is not read"};
    VoxelSource source;
    // The header begins with its length.
    const bool isLittle = loadNumber<int32_t>(bytes.data(), std::endian::little) == kHeaderBytes;
    source.order = isLittle ? std::endian::little : std::endian::big;
    const auto at = [&]<class T>(size_t offset, T) { return loadNumber<T>(bytes.data() + offset, source.order); };
    if (at(0, int32_t{}) != int32_t{kHeaderBytes}) return Error{file + ": byte 0: the header is not 348 bytes long"};
    const int16_t dimensions = at(kDim, int16_t{});
    if (dimensions < 3 || dimensions > 7)
        return Error{file + ": byte 40: has " + std::to_string(dimensions) + " dimensions; 3 are needed"};
    for (size_t k = 0; k < 3; ++k) {
        const int16_t size = at(kDim + 2 * (k + 1), int16_t{});
        source.size[k] = size > 0 ? static_cast<uint64_t>(size) : 0;
        source.spacing[k] = at(kPixDim + 4 * (k + 1), float{});
    }
    const int16_t code = at(kDataType, int16_t{});
    const std::optional<VoxelType> type = typeOf(code);
    if (!type) return Error{file + ": byte 70: voxels of type " + std::to_string(code) + " are not read"};
    source.type = *type;
    const float slope = at(kSlope, float{});
    if (slope != 0) { // 0: no scale
        source.slope = slope;
        source.intercept = at(kIntercept, float{});
    }
    const float offset = at(kVoxOffset, float{});
    if (!(offset >= kHeaderBytes && offset <= float(bytes.size())))
        return Error{file + ": byte 108: the voxels begin outside of the file"};
    source.begin = std::min<uint64_t>(static_cast<uint64_t>(offset), bytes.size());
    source.bytes = bytes.substr(source.begin);
    return convertVoxels(source, file, wish); // the first volume of a series
}

} // namespace mural::examples
