// Compressed images as blocks. The caller of glCompressedTex* gives imageSize, the size of the
// tight image; blocks matter where GL_*_COMPRESSED_BLOCK_* describe a part of a larger image in
// client memory (GL 4.6 §8.7), and for images read back.
#pragma once

#include <cstddef>
#include <cstdint>

#include "streamcodec/sizes/pixel_format.hpp"

namespace mural::sizes {

struct CompressedBlock {
    uint32_t width = 0, height = 0, depth = 0; // texels
    uint32_t bytes = 0;                        // 0: not a format that is made of blocks
    uint32_t minBlocks = 1; // an image has at least so many across and down (PVRTC: 2)
};

// GL_PALETTE*_OES images are a palette and all levels, without blocks: bytes is 0, imageSize is all
// there is.
CompressedBlock compressedBlock(GLenum internalformat);

// Bytes of the tight image. 0: empty or not a block format. SIZE_MAX: no memory can hold it.
size_t compressedBytes(GLenum internalformat, GLsizei width, GLsizei height, GLsizei depth);

// rows and rowBytes are rows of blocks; without GL_*_COMPRESSED_BLOCK_* the image is tight. For
// spanBytes, packTight, unpackTight and tightBytes as with other images.
ImageLayout compressedLayoutOf(const PixelStore& store,
                               GLenum internalformat,
                               GLsizei width,
                               GLsizei height,
                               GLsizei depth,
                               int dims);

} // namespace mural::sizes
