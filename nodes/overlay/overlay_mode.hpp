// The contents of the overlay over the wall's picture (docs/guide/walls.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace mural {

enum class OverlayMode : uint32_t { Off, Stats, Names, Grid };

inline constexpr std::pair<OverlayMode, const char*> kOverlayModes[] = {{OverlayMode::Off, "off"},
                                                                        {OverlayMode::Stats, "stats"},
                                                                        {OverlayMode::Names, "names"},
                                                                        {OverlayMode::Grid, "grid"}};
inline constexpr OverlayMode kLastOverlayMode = OverlayMode::Grid;
inline constexpr const char* kOverlayModeNames = "off, stats, names or grid"; // for messages

[[nodiscard]] constexpr const char* nameOf(OverlayMode mode) { return kOverlayModes[static_cast<size_t>(mode)].second; }

[[nodiscard]] constexpr std::optional<OverlayMode> overlayModeOf(std::string_view name) {
    for (const auto& [mode, text] : kOverlayModes)
        if (name == text) return mode;
    return std::nullopt;
}

} // namespace mural
