// Makes numbers visible: GL's replies become part of the picture, so that a wrong reply is a wrong pixel. Drawn with
// scissored clears, which work in every profile and version.
#pragma once

#include <cstdint>

namespace programs {

struct Color {
    float red, green, blue, alpha = 1.0F;
};

void fillRectangle(int x, int y, int width, int height, Color color);

// Shows the 32 bits of `value` as 32 cells of 4×4 pixels in row `row`, from the lower left corner on.
void showBits(int row, std::uint32_t value);
void showBits(int row, float value);

// Shows a bar of `value` pixels (at most 250) in row `row`.
void showBar(int row, std::int64_t value);

// Pseudo-random numbers that are equal in every run.
class Sequence {
public:
    explicit Sequence(std::uint32_t seed) : state_(seed * 2654435761U + 12345U) {}
    std::uint32_t next() {
        state_ = state_ * 1664525U + 1013904223U;
        return state_ >> 8;
    }
    float unit() { return static_cast<float>(next() & 0xffffU) / 65535.0F; }
    std::uint8_t byte() { return static_cast<std::uint8_t>(next()); }

private:
    std::uint32_t state_;
};

} // namespace programs
