// A part of a texture image. Nodes send whole images, from which the part is extracted.
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

// Moves the part to the start of the image; both are tight.
void keepPart(std::byte* image, const ImagePart& part);

} // namespace mural
