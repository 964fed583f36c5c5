// Images that every GL of a profile takes: what internal format goes with what format and type.
#pragma once

#include "tests/fuzz/random_gl/world.hpp"

namespace fuzz {

struct ImageFormat {
    GLenum internal, format, type;
    bool texture;  // has a sized internal format that textures keep
    bool es;       // OpenGL ES takes it, too
    bool classic;  // OpenGL ES 1 and the fixed function take it
    bool color;    // a framebuffer object may draw into it
};

const ImageFormat& anyFormat(World& w);      // good for glTexImage* in this context
const ImageFormat& drawableFormat(World& w); // and for drawing into

struct CompressedFormat {
    GLenum format;
    int width, height, bytes; // of a block
    const char* extension;    // nullptr: part of OpenGL ES 3 and of 4.3
};

const CompressedFormat* anyCompressedFormat(World& w); // nullptr: none fits

} // namespace fuzz
