// Typical planes for codecs: noise, empty, surfaces, edges, repeated rows.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "compositor/image/plane.hpp"

namespace mural::compositor::test {

constexpr PlaneFormat kEveryFormat[] = {PlaneFormat::Rgba8,   PlaneFormat::Rgb10A2, PlaneFormat::Rgba16F,
                                        PlaneFormat::Rgba32F, PlaneFormat::D24S8,   PlaneFormat::D32F};

enum class Content { Noise, Uniform, Surface, Sparse, Rows, Mixed };
constexpr Content kEveryContent[] = {Content::Noise,  Content::Uniform, Content::Surface,
                                     Content::Sparse, Content::Rows,    Content::Mixed};

inline uint32_t surfaceWord(PlaneFormat format, int32_t x, int32_t y) {
    const double z = 0.25 + 0.0003 * x + 0.0001 * y + 0.00002 * ((x ^ y) & 3);
    if (format == PlaneFormat::D24S8) return static_cast<uint32_t>(z * 0xffffff) << 8 | 5;
    if (format == PlaneFormat::D32F || format == PlaneFormat::Rgba32F)
        return std::bit_cast<uint32_t>(static_cast<float>(z));
    const auto shade = static_cast<uint32_t>(x / 3 + y / 2) & 0xff;
    return shade | shade << 8 | (shade ^ 1) << 16 | 0xff000000u;
}

inline uint32_t wordOf(std::mt19937& random, PlaneFormat format, Content content, int32_t x, int32_t y) {
    switch (content) {
    case Content::Noise: return static_cast<uint32_t>(random());
    case Content::Uniform: return 0x42ff0142u;
    case Content::Surface: return surfaceWord(format, x, y);
    case Content::Sparse: return random() % 97 == 0 ? static_cast<uint32_t>(random()) : 0;
    case Content::Rows: return static_cast<uint32_t>(x) * 2654435761u;
    case Content::Mixed: return x / 70 % 2 == y / 40 % 2 ? surfaceWord(format, x, y) : (random() & 0x03030303u);
    }
    return 0;
}

inline Plane makePlane(std::mt19937& random, PlaneFormat format, Content content, int32_t width, int32_t height) {
    Plane plane(format, width, height);
    const auto words = static_cast<int32_t>(bytesPerPixel(format) / 4);
    for (int32_t y = 0; y < height; ++y)
        for (int32_t x = 0; x < width * words; ++x) {
            // Pixels of several words repeat per pixel.
            const uint32_t word = wordOf(random, format, content, content == Content::Uniform ? 0 : x / words, y);
            std::memcpy(plane.view().row(y) + 4 * x, &word, 4);
        }
    return plane;
}

} // namespace mural::compositor::test
