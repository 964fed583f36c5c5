// A part of an image of a texture. Nodes give whole images: the part is taken out of what they gave.
#pragma once

#include <GL/gl.h>
#include <cstddef>

namespace mural {

struct Level {
    GLint width = 0, height = 0, depth = 0;
};

// In pixels, or in blocks of a compressed image.
struct ImagePart {
    Level image, from, size;
    size_t groupBytes = 0; // of a pixel or a block; 0: the whole image
};

// Moves the part to the beginning of the image, both of them tight.
void keepPart(std::byte* image, const ImagePart& part);

} // namespace mural
