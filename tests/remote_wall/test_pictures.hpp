// Pictures for the tests of remote walls.
#pragma once

#include <cmath>
#include <cstdint>

#include "nodes/output/picture.hpp"

namespace mural::remote::testing {

// Returns a picture with smooth colours and a square at the place of the step.
inline OwnedPicture pictureOf(int width, int height, int step) {
    OwnedPicture picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            std::byte* const pixel = picture.row(y) + 4 * static_cast<ptrdiff_t>(x);
            const bool isInside = x / 16 == step && y / 16 == step;
            pixel[0] = static_cast<std::byte>(isInside ? 255 : x * 255 / width);
            pixel[1] = static_cast<std::byte>(isInside ? 20 : y * 255 / height);
            pixel[2] = static_cast<std::byte>(isInside ? 90 : 60 + ((x + y) & 31));
            pixel[3] = std::byte{255};
        }
    return picture;
}

// Returns the peak signal-to-noise ratio of the colours, in dB.
inline double decibels(const Picture& a, const Picture& b) {
    double squares = 0;
    for (size_t i = 0; i < a.sizeBytes(); ++i) {
        if (i % 4 == 3) continue;
        const double apart = std::to_integer<int>(a.bgra[i]) - std::to_integer<int>(b.bgra[i]);
        squares += apart * apart;
    }
    return squares == 0 ? INFINITY : 10 * std::log10(255.0 * 255.0 * 3 * a.width * a.height / squares);
}

} // namespace mural::remote::testing
