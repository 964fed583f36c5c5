// Reads the pixels of a drawable from the X server.
#pragma once

#include <cstdint>
#include <cstdio>

#include "tests/programs/support/x_window.hpp"

namespace programs {

// Sum of colours; bits of a pixel outside all channels are undefined and excluded.
struct Shown {
    std::uint64_t sum = 0; // includes positions and colours
    int lit = 0;           // pixels that are not black
};

inline Shown shownBy(Drawable drawable, int width, int height) {
    Shown shown;
    XImage* const image =
        XGetImage(openDisplayOnce(), drawable, 0, 0, unsigned(width), unsigned(height), AllPlanes, ZPixmap);
    if (image == nullptr) {
        return shown;
    }
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const std::uint64_t pixel = XGetPixel(image, x, y) & 0xffffffU;
            shown.sum = (shown.sum ^ pixel) * 1099511628211ULL;
            shown.lit += pixel != 0;
        }
    }
    XDestroyImage(image);
    return shown;
}

inline void printShown(const char* what, Drawable drawable, int width, int height) {
    const Shown shown = shownBy(drawable, width, height);
    std::printf("%s shows %016llx, %d lit\n", what, static_cast<unsigned long long>(shown.sum), shown.lit);
    std::fflush(stdout);
}

} // namespace programs
