#include "streamcodec/sizes/compressed_block.hpp"

#include "streamcodec/sizes/gl_enums.hpp"

namespace mural::sizes {
namespace {

// ASTC blocks have 16 bytes. The registry numbers their shapes consecutively (KHR 2D, OES 3D).
struct BlockShape {
    uint8_t width, height, depth;
};
constexpr BlockShape kAstc2d[] = {{4, 4, 1}, {5, 4, 1},  {5, 5, 1},  {6, 5, 1},  {6, 6, 1},   {8, 5, 1},   {8, 6, 1},
                                  {8, 8, 1}, {10, 5, 1}, {10, 6, 1}, {10, 8, 1}, {10, 10, 1}, {12, 10, 1}, {12, 12, 1}};
constexpr BlockShape kAstc3d[] = {{3, 3, 3}, {4, 3, 3}, {4, 4, 3}, {4, 4, 4}, {5, 4, 4},
                                  {5, 5, 4}, {5, 5, 5}, {6, 5, 5}, {6, 6, 5}, {6, 6, 6}};

template <size_t count>
bool astcBlock(const BlockShape (&shapes)[count], GLenum format, GLenum first, CompressedBlock& block) {
    const GLenum index = format - first;
    if (format < first || index >= count) return false;
    block = {shapes[index].width, shapes[index].height, shapes[index].depth, 16, 1};
    return true;
}

// Bytes per block of 4×4 texels, or 0.
uint32_t squareBlockBytes(GLenum internalformat) {
    switch (internalformat) {
    case GL_COMPRESSED_RGB_S3TC_DXT1_EXT:
    case GL_RGB_S3TC: // S3_s3tc: older names of the same blocks
    case GL_RGB4_S3TC:
    case GL_COMPRESSED_RGBA_S3TC_DXT1_EXT:
    case GL_COMPRESSED_SRGB_S3TC_DXT1_EXT:
    case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT:
    case GL_COMPRESSED_RED_RGTC1:
    case GL_COMPRESSED_SIGNED_RED_RGTC1:
    case GL_COMPRESSED_LUMINANCE_LATC1_EXT:
    case GL_COMPRESSED_SIGNED_LUMINANCE_LATC1_EXT:
    case GL_ETC1_RGB8_OES:
    case GL_COMPRESSED_R11_EAC:
    case GL_COMPRESSED_SIGNED_R11_EAC:
    case GL_COMPRESSED_RGB8_ETC2:
    case GL_COMPRESSED_SRGB8_ETC2:
    case GL_COMPRESSED_RGB8_PUNCHTHROUGH_ALPHA1_ETC2:
    case GL_COMPRESSED_SRGB8_PUNCHTHROUGH_ALPHA1_ETC2:
    case GL_ATC_RGB_AMD:
    case GL_3DC_X_AMD:
    case GL_COMPRESSED_RGBA_PVRTC_4BPPV2_IMG:
    case GL_COMPRESSED_SRGB_ALPHA_PVRTC_4BPPV2_IMG: return 8;
    case GL_COMPRESSED_RGBA_S3TC_DXT3_EXT:
    case GL_RGBA_S3TC:
    case GL_RGBA4_S3TC:
    case GL_RGBA_DXT5_S3TC:
    case GL_RGBA4_DXT5_S3TC:
    case GL_COMPRESSED_RGBA_S3TC_DXT5_EXT:
    case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT:
    case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT:
    case GL_COMPRESSED_RG_RGTC2:
    case GL_COMPRESSED_SIGNED_RG_RGTC2:
    case GL_COMPRESSED_LUMINANCE_ALPHA_LATC2_EXT:
    case GL_COMPRESSED_SIGNED_LUMINANCE_ALPHA_LATC2_EXT:
    case GL_COMPRESSED_LUMINANCE_ALPHA_3DC_ATI:
    case GL_COMPRESSED_RGBA_BPTC_UNORM:
    case GL_COMPRESSED_SRGB_ALPHA_BPTC_UNORM:
    case GL_COMPRESSED_RGB_BPTC_SIGNED_FLOAT:
    case GL_COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT:
    case GL_COMPRESSED_RG11_EAC:
    case GL_COMPRESSED_SIGNED_RG11_EAC:
    case GL_COMPRESSED_RGBA8_ETC2_EAC:
    case GL_COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:
    case GL_ATC_RGBA_EXPLICIT_ALPHA_AMD:
    case GL_ATC_RGBA_INTERPOLATED_ALPHA_AMD:
    case GL_3DC_XY_AMD: return 16;
    default: return 0;
    }
}

CompressedBlock otherBlock(GLenum internalformat) {
    switch (internalformat) {
    case GL_COMPRESSED_RGB_FXT1_3DFX:
    case GL_COMPRESSED_RGBA_FXT1_3DFX: return {8, 4, 1, 16, 1};
    case GL_COMPRESSED_RGB_PVRTC_4BPPV1_IMG:
    case GL_COMPRESSED_RGBA_PVRTC_4BPPV1_IMG:
    case GL_COMPRESSED_SRGB_PVRTC_4BPPV1_EXT:
    case GL_COMPRESSED_SRGB_ALPHA_PVRTC_4BPPV1_EXT: return {4, 4, 1, 8, 2};
    case GL_COMPRESSED_RGB_PVRTC_2BPPV1_IMG:
    case GL_COMPRESSED_RGBA_PVRTC_2BPPV1_IMG:
    case GL_COMPRESSED_SRGB_PVRTC_2BPPV1_EXT:
    case GL_COMPRESSED_SRGB_ALPHA_PVRTC_2BPPV1_EXT: return {8, 4, 1, 8, 2};
    case GL_COMPRESSED_RGBA_PVRTC_2BPPV2_IMG:
    case GL_COMPRESSED_SRGB_ALPHA_PVRTC_2BPPV2_IMG: return {8, 4, 1, 8, 1};
    default: return {};
    }
}

size_t blocksAlong(GLsizei texels, uint32_t block, uint32_t atLeast) {
    const size_t blocks = (static_cast<size_t>(texels) + block - 1) / block;
    return blocks < atLeast ? atLeast : blocks;
}

// a·b·c, saturated to SIZE_MAX.
size_t product(size_t a, size_t b, size_t c) {
    size_t ab = 0;
    size_t all = 0;
    if (__builtin_mul_overflow(a, b, &ab) || __builtin_mul_overflow(ab, c, &all) || all > kMaxBytes) return SIZE_MAX;
    return all;
}

// Products of up to three 31-bit program values and a row size fit.
__extension__ typedef unsigned __int128 Wide;

Wide wide(GLint value) { return value > 0 ? static_cast<Wide>(value) : 0; }

} // namespace

CompressedBlock compressedBlock(GLenum internalformat) {
    CompressedBlock block;
    if (astcBlock(kAstc2d, internalformat, GL_COMPRESSED_RGBA_ASTC_4x4_KHR, block) ||
        astcBlock(kAstc2d, internalformat, GL_COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR, block) ||
        astcBlock(kAstc3d, internalformat, GL_COMPRESSED_RGBA_ASTC_3x3x3_OES, block) ||
        astcBlock(kAstc3d, internalformat, GL_COMPRESSED_SRGB8_ALPHA8_ASTC_3x3x3_OES, block))
        return block;
    const uint32_t bytes = squareBlockBytes(internalformat);
    return bytes != 0 ? CompressedBlock{4, 4, 1, bytes, 1} : otherBlock(internalformat);
}

size_t compressedBytes(GLenum internalformat, GLsizei width, GLsizei height, GLsizei depth) {
    const CompressedBlock block = compressedBlock(internalformat);
    if (block.bytes == 0 || width <= 0 || height <= 0 || depth <= 0) return 0;
    return product(blocksAlong(width, block.width, block.minBlocks) * block.bytes,
                   blocksAlong(height, block.height, block.minBlocks), blocksAlong(depth, block.depth, 1));
}

ImageLayout compressedLayoutOf(const PixelStore& store, GLenum internalformat, GLsizei width, GLsizei height,
                               GLsizei depth, int dims) {
    ImageLayout layout;
    const CompressedBlock block = compressedBlock(internalformat);
    const size_t tight = compressedBytes(internalformat, width, height, depth);
    if (tight == 0 || tight == SIZE_MAX) return layout;
    layout.width = static_cast<uint32_t>(width);
    layout.rows = static_cast<uint32_t>(blocksAlong(height, block.height, block.minBlocks));
    layout.images = static_cast<uint32_t>(blocksAlong(depth, block.depth, 1));
    layout.rowBytes = layout.clientRowBytes = blocksAlong(width, block.width, block.minBlocks) * block.bytes;

    Wide stride = layout.rowBytes;
    Wide rowsPerImage = layout.rows;
    Wide first = 0;
    const Wide size = wide(store.compressedBlockSize);
    if (size != 0 && store.compressedBlockWidth > 0) {
        const Wide across = wide(store.compressedBlockWidth);
        if (store.rowLength > 0) stride = size * ((wide(store.rowLength) + across - 1) / across);
        first += wide(store.skipPixels) * size / across;
    }
    if (dims > 1 && size != 0 && store.compressedBlockHeight > 0) {
        const Wide down = wide(store.compressedBlockHeight);
        if (store.imageHeight > 0) rowsPerImage = (wide(store.imageHeight) + down - 1) / down;
        first += wide(store.skipRows) * stride / down;
    }
    if (dims > 2 && size != 0 && store.compressedBlockDepth > 0)
        first += wide(store.skipImages) * stride * rowsPerImage / wide(store.compressedBlockDepth);

    const Wide end = first + stride * rowsPerImage * (layout.images - 1) + stride * (layout.rows - 1) + layout.rowBytes;
    if (end > kMaxBytes || stride * rowsPerImage > kMaxBytes) return layout;
    layout.known = true;
    layout.rowStride = static_cast<ptrdiff_t>(stride);
    layout.imageStride = static_cast<size_t>(stride * rowsPerImage);
    layout.firstByte = static_cast<ptrdiff_t>(first);
    return layout;
}

} // namespace mural::sizes
