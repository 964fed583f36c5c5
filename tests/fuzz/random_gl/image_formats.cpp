#include "tests/fuzz/random_gl/image_formats.hpp"

namespace fuzz {
namespace {

constexpr ImageFormat kFormats[] = {
    {GL_RGBA, GL_RGBA, GL_UNSIGNED_BYTE, false, true, true, true},
    {GL_RGB, GL_RGB, GL_UNSIGNED_BYTE, false, true, true, true},
    {GL_RGBA, GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4, false, true, true, true},
    {GL_RGBA, GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1, false, true, true, true},
    {GL_RGB, GL_RGB, GL_UNSIGNED_SHORT_5_6_5, false, true, true, true},
    {GL_ALPHA, GL_ALPHA, GL_UNSIGNED_BYTE, false, true, true, false},
    {GL_LUMINANCE, GL_LUMINANCE, GL_UNSIGNED_BYTE, false, true, true, false},
    {GL_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE, false, true, true, false},
    {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, true, true, false, true},
    {GL_RGB8, GL_RGB, GL_UNSIGNED_BYTE, true, true, false, true},
    {GL_RG8, GL_RG, GL_UNSIGNED_BYTE, true, true, false, true},
    {GL_R8, GL_RED, GL_UNSIGNED_BYTE, true, true, false, true},
    {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, true, true, false, true},
    {GL_RGB565, GL_RGB, GL_UNSIGNED_SHORT_5_6_5, true, true, false, true},
    {GL_RGBA4, GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4, true, true, false, true},
    {GL_RGB5_A1, GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1, true, true, false, true},
    {GL_RGB10_A2, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, true, true, false, true},
    {GL_RGBA16F, GL_RGBA, GL_FLOAT, true, true, false, true},
    {GL_RGBA32F, GL_RGBA, GL_FLOAT, true, true, false, true},
    {GL_R32F, GL_RED, GL_FLOAT, true, true, false, true},
    {GL_R11F_G11F_B10F, GL_RGB, GL_FLOAT, true, true, false, true},
    {GL_RGB9_E5, GL_RGB, GL_FLOAT, true, true, false, false},
    {GL_RGBA8UI, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE, true, true, false, true},
    {GL_RGBA8I, GL_RGBA_INTEGER, GL_BYTE, true, true, false, true},
    {GL_R32I, GL_RED_INTEGER, GL_INT, true, true, false, true},
    {GL_RG16UI, GL_RG_INTEGER, GL_UNSIGNED_SHORT, true, true, false, true},
    {GL_RGBA8_SNORM, GL_RGBA, GL_BYTE, true, true, false, false},
    {GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT, true, true, false, false},
    {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, true, true, false, false},
    {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, true, true, false, false},
    {GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, true, true, false, false},
    {GL_RGBA16, GL_RGBA, GL_UNSIGNED_SHORT, true, false, false, true},
    {GL_RGBA16_SNORM, GL_RGBA, GL_SHORT, true, false, false, false},
    {GL_RGBA12, GL_BGRA, GL_UNSIGNED_SHORT, true, false, false, true},
    {GL_RGBA8, GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV, true, false, false, true},
    {GL_R3_G3_B2, GL_RGB, GL_UNSIGNED_BYTE_3_3_2, true, false, false, true},
    {GL_RGB, GL_BGR, GL_UNSIGNED_BYTE, false, false, false, true},
    {GL_INTENSITY, GL_RED, GL_FLOAT, false, false, false, false},
    {GL_LUMINANCE16, GL_LUMINANCE, GL_SHORT, false, false, false, false},
};

// Formats from which a window's GL draws textures without integer shaders.
constexpr CompressedFormat kCompressed[] = {
    {GL_COMPRESSED_RGB_S3TC_DXT1_EXT, 4, 4, 8, "GL_EXT_texture_compression_s3tc"},
    {GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, 4, 4, 16, "GL_EXT_texture_compression_s3tc"},
    {GL_COMPRESSED_RED_RGTC1, 4, 4, 8, "GL_ARB_texture_compression_rgtc"},
    {GL_COMPRESSED_RG_RGTC2, 4, 4, 16, "GL_EXT_texture_compression_rgtc"},
    {GL_COMPRESSED_RGBA_BPTC_UNORM, 4, 4, 16, "GL_ARB_texture_compression_bptc"},
    {GL_COMPRESSED_RGB8_ETC2, 4, 4, 8, nullptr},
    {GL_COMPRESSED_RGBA8_ETC2_EAC, 4, 4, 16, nullptr},
    {GL_COMPRESSED_R11_EAC, 4, 4, 8, nullptr},
};

bool fits(const World& w, const ImageFormat& format) {
    const bool legacy = format.internal == GL_ALPHA ||
                        (format.internal >= GL_LUMINANCE && format.internal <= GL_LUMINANCE_ALPHA) ||
                        format.internal == GL_INTENSITY || format.internal == GL_LUMINANCE16;
    switch (w.profile) {
    case Profile::Compat: return true;
    case Profile::Core: return !legacy;
    case Profile::Es1: return format.classic;
    case Profile::Es3: return format.es;
    }
    return false;
}

} // namespace

const ImageFormat& anyFormat(World& w) {
    for (;;) {
        const ImageFormat& format = w.random.of(kFormats);
        if (fits(w, format)) {
            return format;
        }
    }
}

const ImageFormat& drawableFormat(World& w) {
    for (;;) {
        const ImageFormat& format = anyFormat(w);
        if (format.color && (w.profile == Profile::Es1 || format.texture)) {
            return format;
        }
    }
}

const CompressedFormat* anyCompressedFormat(World& w) {
    const CompressedFormat& format = w.random.of(kCompressed);
    const bool known = format.extension == nullptr ? w.shaders() : w.has(format.extension);
    return known ? &format : nullptr;
}

} // namespace fuzz
