// Reads and compares colours of windows without a loss of bits.
#pragma once

#include <GL/gl.h>
#include <cstddef>
#include <cstdint>

#include "streamcodec/wire/control_records.hpp"

namespace mural {

struct Context;
struct Window;

struct ColourReads {
    GLenum type;
    uint32_t pixelBytes;
    uint32_t fillFlag; // flag of kOpFillWindow
};

// Returns the type that reads all bits of the window as GL_RGBA. OpenGL ES before 3 reads bytes only.
ColourReads colourReadsOf(const Context& context, const Window& window);

// Differences in 255ths of the largest value, rounded up: a single bit of 10 counts as 1.
struct ColourDifference {
    uint64_t differingPixels = 0;
    uint64_t squared = 0; // sum over all components
    uint32_t largest = 0; // of one component
};
ColourDifference compareColours(const void* a, const void* b, size_t pixels, GLenum type);

// Converts colours in place to four bytes per pixel.
void reduceToBytes(void* colours, size_t pixels, GLenum type);

} // namespace mural
