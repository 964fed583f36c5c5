// Detects CPU rendering from GL_RENDERER.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace mural::gl {

[[nodiscard]] inline bool drawsWithoutGpu(std::string_view renderer) {
    constexpr std::array<std::string_view, 5> kSoftware{"llvmpipe", "softpipe", "swrast", "SWR", "Software Rasterizer"};
    return std::ranges::any_of(kSoftware,
                               [&](std::string_view name) { return renderer.find(name) != std::string_view::npos; });
}

} // namespace mural::gl
