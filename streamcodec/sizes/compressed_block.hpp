// Compressed images as blocks. The caller of glCompressedTex* passes imageSize, the size of the tight image. Blocks
// matter if GL_*_COMPRESSED_BLOCK_* select a part of a larger image in client memory (GL 4.6 §8.7), and for images read
// back.
#pragma once

#include <cstddef>
#include <cstdint>

#include "streamcodec/sizes/pixel_format.hpp"

namespace mural::sizes {

struct CompressedBlock {
    uint32_t width = 0, height = 0, depth = 0; // texels
    uint32_t bytes = 0;                        // 0: not a block format
    uint32_t minBlocks = 1;                    // minimum number of blocks per direction (PVRTC: 2)
};

// GL_PALETTE*_OES images consist of a palette and all levels, without blocks: bytes is 0, and imageSize is the only
// size.
CompressedBlock compressedBlock(GLenum internalformat);

// Bytes of the tight image. 0: empty or not a block format. SIZE_MAX: not addressable.
size_t compressedBytes(GLenum internalformat, GLsizei width, GLsizei height, GLsizei depth);

// rows and rowBytes refer to rows of blocks. Without GL_*_COMPRESSED_BLOCK_* the image is tight. The result works with
// spanBytes, packTight, unpackTight and tightBytes.
ImageLayout compressedLayoutOf(const PixelStore& store, GLenum internalformat, GLsizei width, GLsizei height,
                               GLsizei depth, int dims);

} // namespace mural::sizes
