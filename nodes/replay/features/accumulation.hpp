// The arithmetic of an accumulation buffer, for windows without one (EGL, OSMesa): signed normalised 16-bit values that
// wrap around. Colours of 8-bit windows are decoded from sRGB on input and encoded on output; alpha is not. Measured
// with Mesa 22.3.6; tests/replay holds the figures.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::accumulation {

// Pixels are four values: red, green, blue, alpha, in both directions.
void load(int16_t* values, const uint8_t* rgba, size_t pixels, float by, bool add); // GL_LOAD, GL_ACCUM
void multiply(int16_t* values, size_t pixels, float by);                            // GL_MULT
void add(int16_t* values, size_t pixels, float what);                               // GL_ADD
void clear(int16_t* values, size_t pixels, const float* colour);                    // glClear
// GL_RETURN. channels: enabled by the colour mask.
void giveBack(const int16_t* values, uint8_t* rgba, size_t pixels, float by, const bool* channels);

float decoded(uint8_t byte);

} // namespace mural::accumulation
