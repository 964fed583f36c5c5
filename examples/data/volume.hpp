// Volumes of voxels, and their files: NIfTI-1, NRRD, INR, and raw voxels of a stated size; each optionally compressed
// with gzip.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"

namespace mural::examples {

// A grid of voxels with one value each, as unsigned integers of 8 or 16 bits in the byte order of this machine. The
// integer 0 stands for the value `lowest`, the largest integer for `highest`.
struct Volume {
    std::array<uint32_t, 3> size{};         // voxels along x, y, z; x varies fastest
    std::array<double, 3> spacing{1, 1, 1}; // distances between voxels, in millimetres
    uint32_t bytesPerVoxel = 1;             // 1 or 2
    double lowest = 0, highest = 255;
    std::vector<std::byte> voxels;

    [[nodiscard]] uint64_t voxelCount() const { return uint64_t{size[0]} * size[1] * size[2]; }
};

// Largest accepted number of voxels along an axis.
constexpr uint32_t kMaxVoxelsPerAxis = 32768;

enum class VoxelType : uint8_t { Uint8, Int8, Uint16, Int16, Uint32, Int32, Float32, Float64 };
[[nodiscard]] uint32_t bytesOf(VoxelType type);

// How the values of a file become voxels.
struct VolumeWish {
    // Bits per voxel: 8 or 16. 0: 8 for files with 8 bits or less than 256 values, otherwise 16.
    uint32_t bits = 0;
    // The values that become the smallest and the largest integer; values outside of them are clamped. Without it: 0 to
    // 255 for unsigned 8-bit files, otherwise the smallest and largest value of the file.
    std::optional<std::array<double, 2>> window;
};

// Size and type of a file without a header.
struct RawForm {
    std::array<uint32_t, 3> size{};
    VoxelType type = VoxelType::Uint8; // 16-bit and larger types: little endian
    std::array<double, 3> spacing{1, 1, 1};
};

// Reads a volume file. The contents select the format. Errors: the file, the line or byte, the problem.
Result<Volume> readVolume(const std::string& path, const VolumeWish& wish = {});
// Reads voxels without a header. Error: the length of the file does not match the form.
Result<Volume> readRawVolume(const std::string& path, const RawForm& form, const VolumeWish& wish = {});
// The same of contents in memory. `file` is the name in errors. Voxels that are compressed inside of the contents are
// decompressed.
Result<Volume> parseVolume(std::string_view bytes, const std::string& file, const VolumeWish& wish = {});

// Returns the form that a text states, such as "256x256x108" or "256x256x108:int16". Error: the problem.
Result<RawForm> parseRawForm(std::string_view text);

} // namespace mural::examples
