// The arithmetic of an accumulation buffer, for nodes whose windows have none (EGL, OSMesa): 16 bits signed,
// normalised, wrapping around. Colours of windows with 8 bits per channel are decoded from sRGB when they come
// in and encoded when they go out, alpha is not. Measured with Mesa 22.3.6; tests/replay keeps the figures.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::accumulation {

// Pixels are four values, red, green, blue, alpha, in both directions.
void load(int16_t* values, const uint8_t* rgba, size_t pixels, float by, bool add); // GL_LOAD, GL_ACCUM
void multiply(int16_t* values, size_t pixels, float by);                            // GL_MULT
void add(int16_t* values, size_t pixels, float what);                               // GL_ADD
void clear(int16_t* values, size_t pixels, const float* colour);                    // glClear
// GL_RETURN; channels: those that the colour mask lets through.
void giveBack(const int16_t* values, uint8_t* rgba, size_t pixels, float by, const bool* channels);

float decoded(uint8_t byte);

} // namespace mural::accumulation
