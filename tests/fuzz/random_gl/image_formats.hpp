// Image formats that every GL of a profile accepts: internal formats with their formats and types.
#pragma once

#include "tests/fuzz/random_gl/world.hpp"

namespace fuzz {

struct ImageFormat {
    GLenum internal, format, type;
    bool texture; // has a sized internal format that textures keep
    bool es;      // also in OpenGL ES
    bool classic; // also in OpenGL ES 1 and with the fixed function
    bool color;   // a framebuffer object may draw into it
};

const ImageFormat& anyFormat(World& w);      // valid for glTexImage* in this context
const ImageFormat& drawableFormat(World& w); // and as a render target

struct CompressedFormat {
    GLenum format;
    int width, height, bytes; // size of a block
    const char* extension;    // nullptr: part of OpenGL ES 3 and of 4.3
};

const CompressedFormat* anyCompressedFormat(World& w); // nullptr: none fits

} // namespace fuzz
