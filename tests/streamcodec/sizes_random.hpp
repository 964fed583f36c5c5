// Random pixel store states and bytes for the tests of sizes. A failure prints the seed.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "streamcodec/sizes/pixel_format.hpp"

namespace mural::sizes {

class Random {
public:
    explicit Random(uint32_t seed) : engine_(seed) {}

    int upTo(int maximum) { return std::uniform_int_distribution<int>(0, maximum)(engine_); }
    int between(int minimum, int maximum) { return std::uniform_int_distribution<int>(minimum, maximum)(engine_); }
    bool oneIn(int n) { return upTo(n - 1) == 0; }
    uint8_t byte() { return static_cast<uint8_t>(upTo(255)); }

    std::vector<uint8_t> bytes(size_t size) {
        std::vector<uint8_t> result(size);
        for (uint8_t& b : result) b = byte();
        return result;
    }

    // Rows never overlap: rowLength and imageHeight are 0 or cover the image.
    PixelStore store(int width, int height) {
        PixelStore s;
        s.alignment = 1 << upTo(3);
        s.rowLength = oneIn(2) ? 0 : width + upTo(9);
        s.skipPixels = oneIn(2) ? 0 : upTo(s.rowLength > 0 ? s.rowLength - width : 3);
        s.skipRows = oneIn(2) ? 0 : upTo(3);
        s.imageHeight = oneIn(2) ? 0 : height + upTo(4);
        s.skipImages = oneIn(2) ? 0 : upTo(2);
        s.swapBytes = oneIn(3);
        s.lsbFirst = oneIn(2);
        return s;
    }

private:
    std::mt19937 engine_;
};

inline std::string describe(const PixelStore& s) {
    return "alignment " + std::to_string(s.alignment) + " rowLength " + std::to_string(s.rowLength) + " skip " +
           std::to_string(s.skipPixels) + "," + std::to_string(s.skipRows) + "," + std::to_string(s.skipImages) +
           " imageHeight " + std::to_string(s.imageHeight) + (s.swapBytes ? " swapped" : "") +
           (s.lsbFirst ? " lsbFirst" : "") + (s.invert ? " inverted" : "");
}

} // namespace mural::sizes
