// The readers behind parseVolume(), and the conversion of voxels that they share.
#pragma once

#include <bit>

#include "examples/data/volume.hpp"

namespace mural::examples {

// The voxels of a file, not converted yet.
struct VoxelSource {
    std::array<uint64_t, 3> size{};
    std::array<double, 3> spacing{1, 1, 1};
    VoxelType type = VoxelType::Uint8;
    std::endian order = std::endian::little;
    double slope = 1, intercept = 0; // value = slope * voxel + intercept
    uint64_t begin = 0;              // position of the first voxel in the file; for messages
    std::string_view bytes;          // the voxels; may be longer than needed
};

// Returns the number of bytes that the voxels of the source take. Errors: the size of an axis is 0 or too large.
Result<uint64_t> neededBytes(const VoxelSource& source, const std::string& file);
// Validates size, spacing and length, and converts the voxels.
Result<Volume> convertVoxels(const VoxelSource& source, const std::string& file, const VolumeWish& wish);

Result<Volume> parseNifti(std::string_view bytes, const std::string& file, const VolumeWish& wish);
Result<Volume> parseNrrd(std::string_view bytes, const std::string& file, const VolumeWish& wish);
Result<Volume> parseInr(std::string_view bytes, const std::string& file, const VolumeWish& wish);
[[nodiscard]] bool isNifti(std::string_view bytes);

} // namespace mural::examples
