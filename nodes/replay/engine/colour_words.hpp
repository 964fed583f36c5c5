// Pixel types for lossless reads of a window's colours and lossless uploads to a texture.
#pragma once

#include "gl_functions.hpp"

namespace mural {

struct ColourWords {
    GLenum type;      // of GL_RGBA
    GLenum storage;   // internal format with the same precision
    size_t sizeBytes; // per pixel
};

inline constexpr ColourWords kByteWords{GL_UNSIGNED_BYTE, GL_RGBA8, 4};
inline constexpr ColourWords kTenBitWords{GL_UNSIGNED_INT_2_10_10_10_REV, GL_RGB10_A2, 4};
inline constexpr ColourWords kFloatWords{GL_FLOAT, GL_RGBA16F, 16}; // windows have at most 16 bits per channel

// Returns null for a type that does not read windows.
[[nodiscard]] constexpr const ColourWords* colourWordsOf(GLenum type) {
    for (const ColourWords* words : {&kByteWords, &kTenBitWords, &kFloatWords})
        if (words->type == type) return words;
    return nullptr;
}

} // namespace mural
