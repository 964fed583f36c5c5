#include "streamcodec/sizes/pixel_format.hpp"

#include "streamcodec/sizes/gl_enums.hpp"

namespace mural::sizes {
namespace {

// A type that packs all components of a pixel into one word (two for 64 bits).
struct PackedType {
    uint32_t bytes;    // 0: not packed
    uint32_t channels; // of matching formats
};

PackedType packedType(GLenum type) {
    switch (type) {
    case GL_UNSIGNED_BYTE_3_3_2:
    case GL_UNSIGNED_BYTE_2_3_3_REV: return {1, 3};
    case GL_UNSIGNED_SHORT_5_6_5:
    case GL_UNSIGNED_SHORT_5_6_5_REV: return {2, 3};
    case GL_UNSIGNED_SHORT_4_4_4_4:
    case GL_UNSIGNED_SHORT_4_4_4_4_REV:
    case GL_UNSIGNED_SHORT_5_5_5_1:
    case GL_UNSIGNED_SHORT_1_5_5_5_REV: return {2, 4};
    case GL_UNSIGNED_INT_8_8_8_8:
    case GL_UNSIGNED_INT_8_8_8_8_REV:
    case GL_UNSIGNED_INT_10_10_10_2:
    case GL_UNSIGNED_INT_2_10_10_10_REV:
    case GL_UNSIGNED_INT_S8_S8_8_8_NV:
    case GL_UNSIGNED_INT_8_8_S8_S8_REV_NV: return {4, 4};
    case GL_UNSIGNED_INT_10F_11F_11F_REV:
    case GL_UNSIGNED_INT_5_9_9_9_REV: return {4, 3};
    case GL_UNSIGNED_INT_24_8:
    case GL_UNSIGNED_INT_8_24_REV_MESA:
    case GL_UNSIGNED_INT_24_8_MESA: return {4, 2};
    case GL_UNSIGNED_SHORT_15_1_MESA:
    case GL_UNSIGNED_SHORT_1_15_REV_MESA:
    case GL_UNSIGNED_SHORT_8_8_MESA: // = APPLE
    case GL_UNSIGNED_SHORT_8_8_REV_MESA: return {2, 2};
    case GL_FLOAT_32_UNSIGNED_INT_24_8_REV: return {8, 2};
    default: return {0, 0};
    }
}

uint32_t extensionComponents(GLenum format) {
    switch (format) {
    case GL_ALPHA_INTEGER_EXT:
    case GL_LUMINANCE_INTEGER_EXT: return 1;
    case GL_LUMINANCE_ALPHA_INTEGER_EXT:
    case GL_YCBCR_MESA:
    case GL_YCBCR_422_APPLE:
    case GL_RGB_422_APPLE:
    case GL_RGB_RAW_422_APPLE:
    case GL_YCRCB_422_SGIX:
    case GL_422_EXT:
    case GL_422_REV_EXT:
    case GL_422_AVERAGE_EXT:
    case GL_422_REV_AVERAGE_EXT:
    case GL_DUDV_ATI:
    case GL_HILO_NV:
    case GL_DSDT_NV: return 2;
    case GL_SRGB: // as a client format: EXT_sRGB
    case GL_YCRCB_444_SGIX:
    case GL_YCRCB_SGIX:
    case GL_DSDT_MAG_NV: return 3;
    case GL_ABGR_EXT:
    case GL_SRGB_ALPHA:
    case GL_CMYK_EXT:
    case GL_YCRCBA_SGIX:
    case GL_DSDT_MAG_VIB_NV: return 4;
    case GL_CMYKA_EXT: return 5;
    default: return 0;
    }
}

uint32_t scalarBytes(GLenum type) {
    switch (type) {
    case GL_BYTE:
    case GL_UNSIGNED_BYTE: return 1;
    case GL_SHORT:
    case GL_UNSIGNED_SHORT:
    case GL_HALF_FLOAT: // = ARB, NV, APPLE
    case GL_HALF_FLOAT_OES: return 2;
    case GL_INT:
    case GL_UNSIGNED_INT:
    case GL_FLOAT: return 4;
    default: return 0;
    }
}

// Luma of each pixel with the chroma of every second one: 16 bits per pixel, with types of their own.
bool isSubsampledPair(GLenum format) {
    return format == GL_YCBCR_MESA || format == GL_YCBCR_422_APPLE || format == GL_RGB_422_APPLE ||
           format == GL_RGB_RAW_422_APPLE;
}

bool isPairType(GLenum type) { return type == GL_UNSIGNED_SHORT_8_8_MESA || type == GL_UNSIGNED_SHORT_8_8_REV_MESA; }

// OpenGL ES accepts 2_10_10_10 for GL_RGB too (EXT_texture_type_2_10_10_10_REV).
bool fitsPacked(GLenum format, GLenum type, uint32_t channels) {
    const bool wantsPair = isPairType(type);
    if (wantsPair != isSubsampledPair(format)) return false;
    if (wantsPair) return true;
    // NV_read_depth uses the depth-stencil word for depth alone.
    if (channels == 2)
        return format == GL_DEPTH_STENCIL || (format == GL_DEPTH_COMPONENT && type == GL_UNSIGNED_INT_24_8);
    const uint32_t components = componentsOf(format);
    return components == channels || (type == GL_UNSIGNED_INT_2_10_10_10_REV && components == 3);
}

} // namespace

uint32_t componentsOf(GLenum format) {
    switch (format) {
    case GL_COLOR_INDEX:
    case GL_STENCIL_INDEX:
    case GL_DEPTH_COMPONENT:
    case GL_RED:
    case GL_GREEN:
    case GL_BLUE:
    case GL_ALPHA:
    case GL_LUMINANCE:
    case GL_INTENSITY:
    case GL_RED_INTEGER:
    case GL_GREEN_INTEGER:
    case GL_BLUE_INTEGER: return 1;
    case GL_LUMINANCE_ALPHA:
    case GL_RG:
    case GL_RG_INTEGER:
    case GL_DEPTH_STENCIL: return 2;
    case GL_RGB:
    case GL_BGR:
    case GL_RGB_INTEGER:
    case GL_BGR_INTEGER: return 3;
    case GL_RGBA:
    case GL_BGRA:
    case GL_RGBA_INTEGER:
    case GL_BGRA_INTEGER: return 4;
    default: return extensionComponents(format);
    }
}

uint32_t groupBytes(GLenum format, GLenum type) {
    const PackedType packed = packedType(type);
    if (packed.bytes != 0) return fitsPacked(format, type, packed.channels) ? packed.bytes : 0;
    if (isSubsampledPair(format) || format == GL_DEPTH_STENCIL) return 0;
    return componentsOf(format) * scalarBytes(type);
}

uint32_t swapUnitBytes(GLenum type) {
    if (type == GL_BITMAP) return 1;
    const uint32_t packedBytes = packedType(type).bytes;
    if (packedBytes == 8) return 4; // a float and a word of 24 and 8 bits
    return packedBytes != 0 ? packedBytes : scalarBytes(type);
}

} // namespace mural::sizes
