#include "examples/data/volume.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "examples/data/byte_cursor.hpp"
#include "examples/data/file_bytes.hpp"
#include "examples/data/text_cursor.hpp"
#include "examples/data/volume_formats.hpp"

namespace mural::examples {
namespace {

// Calls use(T{}) with the C++ type of the voxels.
template <class Use> auto withType(VoxelType type, Use&& use) {
    switch (type) {
    case VoxelType::Uint8: return use(uint8_t{});
    case VoxelType::Int8: return use(int8_t{});
    case VoxelType::Uint16: return use(uint16_t{});
    case VoxelType::Int16: return use(int16_t{});
    case VoxelType::Uint32: return use(uint32_t{});
    case VoxelType::Int32: return use(int32_t{});
    case VoxelType::Float32: return use(float{});
    case VoxelType::Float64: break;
    }
    return use(double{});
}

// Returns the smallest and the largest finite voxel; 0 and 1 if there is none.
template <class T> std::array<double, 2> extremes(const char* from, uint64_t count, std::endian order) {
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (uint64_t v = 0; v < count; ++v) {
        const auto value = static_cast<double>(loadNumber<T>(from + v * sizeof(T), order));
        if (!std::isfinite(value)) continue;
        lowest = std::min(lowest, value);
        highest = std::max(highest, value);
    }
    return lowest <= highest ? std::array{lowest, highest} : std::array{0., 1.};
}

// Maps the voxels `window[0]` to `window[1]` to the integers 0 to the largest. Voxels that are no numbers become 0.
template <class T, class Integer>
void scale(const char* from, uint64_t count, std::endian order, const std::array<double, 2>& window, std::byte* to) {
    constexpr double kLargest = std::numeric_limits<Integer>::max();
    const double width = window[1] - window[0];
    const double factor = std::abs(width) > 0 ? kLargest / width : 0;
    for (uint64_t v = 0; v < count; ++v) {
        const double value = (static_cast<double>(loadNumber<T>(from + v * sizeof(T), order)) - window[0]) * factor;
        const auto integer = static_cast<Integer>(value >= kLargest ? kLargest : value > 0 ? value + .5 : 0);
        std::memcpy(to + v * sizeof(Integer), &integer, sizeof(Integer));
    }
}

std::optional<VoxelType> voxelTypeNamed(std::string_view name) {
    static constexpr std::array<std::string_view, 8> kNames{"uint8",  "int8",  "uint16", "int16",
                                                            "uint32", "int32", "float",  "double"};
    const auto* found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end()) return std::nullopt;
    return static_cast<VoxelType>(found - kNames.begin());
}

Result<Volume> parseRaw(std::string_view bytes, const std::string& file, const RawForm& form, const VolumeWish& wish) {
    VoxelSource source;
    std::copy(form.size.begin(), form.size.end(), source.size.begin());
    source.spacing = form.spacing;
    source.type = form.type;
    source.bytes = bytes;
    const Result<uint64_t> needed = neededBytes(source, file);
    if (!needed) return needed.error();
    if (needed.value() != bytes.size())
        return Error{file + ": has " + std::to_string(bytes.size()) + " bytes, but the stated size needs " +
                     std::to_string(needed.value())};
    return convertVoxels(source, file, wish);
}

} // namespace

uint32_t bytesOf(VoxelType type) {
    return withType(type, [](auto value) { return static_cast<uint32_t>(sizeof(value)); });
}

Result<uint64_t> neededBytes(const VoxelSource& source, const std::string& file) {
    uint64_t bytes = bytesOf(source.type);
    for (const uint64_t voxels : source.size) {
        if (voxels == 0 || voxels > kMaxVoxelsPerAxis)
            return Error{file + ": has an axis of " + std::to_string(voxels) + " voxels; 1 to " +
                         std::to_string(kMaxVoxelsPerAxis) + " are possible"};
        bytes *= voxels; // at most 2^3 * 2^45
    }
    return bytes;
}

Result<Volume> convertVoxels(const VoxelSource& source, const std::string& file, const VolumeWish& wish) {
    const Result<uint64_t> needed = neededBytes(source, file);
    if (!needed) return needed.error();
    if (source.bytes.size() < needed.value())
        return Error{file + ": byte " + std::to_string(source.begin + source.bytes.size()) +
                     ": ends early; the voxels need " + std::to_string(needed.value()) + " bytes, and " +
                     std::to_string(source.bytes.size()) + " exist"};
    if (!std::isfinite(source.slope) || !std::isfinite(source.intercept) || source.slope == 0)
        return Error{file + ": the scale of the voxels is 0 or not finite"};
    Volume volume;
    for (size_t k = 0; k < 3; ++k) {
        volume.size[k] = static_cast<uint32_t>(source.size[k]);
        const double spacing = std::abs(source.spacing[k]);
        volume.spacing[k] = std::isfinite(spacing) && spacing > 0 ? spacing : 1;
    }
    const uint64_t count = volume.voxelCount();
    const char* from = source.bytes.data();
    std::array<double, 2> window{0, 255}; // in voxels of the file
    if (wish.window) {
        for (size_t k = 0; k < 2; ++k) window[k] = ((*wish.window)[k] - source.intercept) / source.slope;
    } else if (source.type != VoxelType::Uint8) {
        window = withType(source.type, [&](auto t) { return extremes<decltype(t)>(from, count, source.order); });
        if (source.slope < 0) std::swap(window[0], window[1]);
    }
    const bool isInteger = source.type < VoxelType::Float32;
    const bool needs8Bits = bytesOf(source.type) == 1 || (isInteger && std::abs(window[1] - window[0]) < 256);
    volume.bytesPerVoxel = wish.bits == 8 || (wish.bits != 16 && needs8Bits) ? 1 : 2;
    volume.lowest = window[0] * source.slope + source.intercept;
    volume.highest = window[1] * source.slope + source.intercept;
    volume.voxels.resize(count * volume.bytesPerVoxel);
    withType(source.type, [&](auto t) {
        if (volume.bytesPerVoxel == 1)
            scale<decltype(t), uint8_t>(from, count, source.order, window, volume.voxels.data());
        else
            scale<decltype(t), uint16_t>(from, count, source.order, window, volume.voxels.data());
    });
    return volume;
}

Result<Volume> parseVolume(std::string_view bytes, const std::string& file, const VolumeWish& wish) {
    if (bytes.substr(0, 4) == "NRRD") return parseNrrd(bytes, file, wish);
    if (bytes.substr(0, 12) == "#INRIMAGE-4#") return parseInr(bytes, file, wish);
    if (isNifti(bytes)) return parseNifti(bytes, file, wish);
    return Error{file + ": is no NIfTI-1, NRRD or INR file; voxels without a header need their size"};
}

Result<Volume> readVolume(const std::string& path, const VolumeWish& wish) {
    const Result<std::string> bytes = readFile(path);
    if (!bytes) return bytes.error();
    return parseVolume(bytes.value(), path, wish);
}

Result<Volume> readRawVolume(const std::string& path, const RawForm& form, const VolumeWish& wish) {
    const Result<std::string> bytes = readFile(path);
    if (!bytes) return bytes.error();
    return parseRaw(bytes.value(), path, form, wish);
}

Result<RawForm> parseRawForm(std::string_view text) {
    const Error problem{"\"" + TextCursor::shortened(text) + "\" is no size such as 256x256x108 or 256x256x108:int16"};
    RawForm form;
    const size_t colon = text.find(':');
    if (colon != std::string_view::npos) {
        const std::optional<VoxelType> type = voxelTypeNamed(text.substr(colon + 1));
        if (!type) return problem;
        form.type = *type;
    }
    std::string sizes(text.substr(0, colon));
    if (std::count(sizes.begin(), sizes.end(), 'x') != 2) return problem;
    std::replace(sizes.begin(), sizes.end(), 'x', ' ');
    TextCursor words(sizes, "");
    for (uint32_t& size : form.size) size = words.count("size");
    if (!words.ok() || !words.word().empty()) return problem;
    return form;
}

} // namespace mural::examples
