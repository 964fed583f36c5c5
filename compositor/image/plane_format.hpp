// Pixel formats of planes. Names and layouts are OpenGL's. The values are part of encoded pictures and never change.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::compositor {

enum class PlaneFormat : uint8_t {
    Rgba8 = 0,   // GL_RGBA, GL_UNSIGNED_BYTE: red in the first byte
    Rgb10A2 = 1, // GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV: red in the lowest 10 bits, alpha in the highest 2
    Rgba16F = 2, // GL_RGBA, GL_HALF_FLOAT
    Rgba32F = 3, // GL_RGBA, GL_FLOAT
    D24S8 = 4,   // GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8: depth in the upper 24 bits
    D32F = 5,    // GL_DEPTH_COMPONENT, GL_FLOAT
};
constexpr int kPlaneFormats = 6;

[[nodiscard]] constexpr size_t bytesPerPixel(PlaneFormat f) {
    return f == PlaneFormat::Rgba32F ? 16 : f == PlaneFormat::Rgba16F ? 8 : 4;
}
[[nodiscard]] constexpr bool isDepth(PlaneFormat f) { return f == PlaneFormat::D24S8 || f == PlaneFormat::D32F; }
[[nodiscard]] constexpr const char* nameOf(PlaneFormat f) {
    constexpr const char* kNames[kPlaneFormats] = {"RGBA8", "RGB10A2", "RGBA16F", "RGBA32F", "D24S8", "D32F"};
    return kNames[static_cast<size_t>(f)];
}

} // namespace mural::compositor
