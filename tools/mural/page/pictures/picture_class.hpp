// The classes of pictures that viewers request, with their limits. Pure.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace mural::page {

enum class PictureClass : uint8_t { Thumb, Preview, Full };
inline constexpr size_t kPictureClasses = 3;
inline constexpr std::array<std::string_view, kPictureClasses> kPictureClassNames = {"thumb", "preview", "full"};

// Upper limits of what viewers can request: --preview-rate, --preview-size, --preview-quality.
struct PictureLimits {
    int previewRate = 15;   // pictures per second of the class preview
    int previewSize = 1280; // pixels of its width
    int quality = 80;       // of JPEG, 1 to 95
};

struct ClassLimits {
    int maxWidth = 0, maxHeight = 0;
    int64_t intervalNs = 0;
};

[[nodiscard]] inline ClassLimits limitsOf(PictureClass pictureClass, const PictureLimits& limits) {
    constexpr int kMaxSide = 16384; // above JPEG's practical size
    constexpr int64_t kSecondNs = 1'000'000'000;
    switch (pictureClass) {
    case PictureClass::Thumb: return {320, 320, kSecondNs / 2};
    case PictureClass::Preview:
        return {limits.previewSize, limits.previewSize, kSecondNs / std::max(limits.previewRate, 1)};
    case PictureClass::Full: break;
    }
    return {kMaxSide, kMaxSide, kSecondNs / 60};
}

[[nodiscard]] inline std::optional<PictureClass> pictureClassOfName(std::string_view name) {
    const auto found = std::ranges::find(kPictureClassNames, name);
    if (found == kPictureClassNames.end()) return std::nullopt;
    return static_cast<PictureClass>(found - kPictureClassNames.begin());
}

} // namespace mural::page
