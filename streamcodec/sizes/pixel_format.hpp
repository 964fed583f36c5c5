// Images in client memory: bytes per pixel, and the offsets of rows under the pixel store state (GL 4.6 §8.4.4,
// §18.2.2). Images are sent in the tight form: alignment 1, all other state default, native byte order; bitmap rows
// with the most significant bit first and zero padding to whole bytes. All functions are pure and accept any argument.
#pragma once

#include <cstddef>
#include <cstdint>

#include <GL/gl.h>

namespace mural::sizes {

constexpr size_t kMaxBytes = PTRDIFF_MAX; // the largest valid address difference

// Components per pixel of a client format; 0: not a format.
uint32_t componentsOf(GLenum format);

// Bytes per pixel. 0: an invalid pair, for which GL raises an error without accessing client memory; or GL_BITMAP,
// which has no whole bytes.
uint32_t groupBytes(GLenum format, GLenum type);

// Bytes of the unit that GL_*_SWAP_BYTES reverses: a component, or a packed pixel. 0: not a type.
uint32_t swapUnitBytes(GLenum type);

// The glPixelStore state of one direction.
struct PixelStore {
    GLint alignment = 4;
    GLint rowLength = 0;
    GLint skipRows = 0;
    GLint skipPixels = 0;
    GLint imageHeight = 0;
    GLint skipImages = 0;
    bool swapBytes = false;
    bool lsbFirst = false;
    bool invert = false; // GL_PACK_INVERT_MESA, GL_PACK_REVERSE_ROW_ORDER_ANGLE: the first row is the highest
    GLint compressedBlockWidth = 0;
    GLint compressedBlockHeight = 0;
    GLint compressedBlockDepth = 0;
    GLint compressedBlockSize = 0;
};

// The rows of an image relative to the pointer passed to GL. All sizes in bytes.
struct ImageLayout {
    bool known = false;    // false: GL accesses nothing (invalid or empty image)
    bool bitmap = false;   // rows are bits: the first is bit `firstBit` of the row's first byte
    bool lsbFirst = false; // of a bitmap
    uint32_t firstBit = 0; // 0…7
    uint32_t width = 0;    // pixels
    uint32_t rows = 0;     // per image; rows of blocks if compressed
    uint32_t images = 0;
    uint32_t swapUnit = 0;     // client values of 2 or 4 bytes need a byte swap; 0: none
    size_t rowBytes = 0;       // of a tight row
    size_t clientRowBytes = 0; // from the first to the last byte with pixels in a client row
    ptrdiff_t rowStride = 0;   // negative if inverted
    size_t imageStride = 0;
    ptrdiff_t firstByte = 0; // of row 0 of image 0

    [[nodiscard]] ptrdiff_t rowOffset(uint32_t row, uint32_t image) const {
        return firstByte + static_cast<ptrdiff_t>(image) * static_cast<ptrdiff_t>(imageStride) +
               static_cast<ptrdiff_t>(row) * rowStride;
    }
};

// dims: of the command or texture target (1, 2, 3). GL_*_SKIP_IMAGES applies to 3 only, GL_*_SKIP_ROWS always. height
// and depth are 1 for commands without them. glPolygonStipple is a 32×32 image with GL_COLOR_INDEX, GL_BITMAP.
ImageLayout layoutOf(const PixelStore& store, GLenum format, GLenum type, GLsizei width, GLsizei height, GLsizei depth,
                     int dims);

// Bytes of the tight image. 0: empty or unknown. SIZE_MAX: not addressable.
size_t tightBytes(GLenum format, GLenum type, GLsizei width, GLsizei height, GLsizei depth);
size_t tightBytes(const ImageLayout& layout);

// Bytes from the pointer to the end of GL's accesses.
size_t spanBytes(const ImageLayout& layout);

// Client memory → tight. dst has tightBytes(layout).
void packTight(void* dst, const void* src, const ImageLayout& layout);

// Tight → client memory under the pack state. Writes the pixels of the rows and no other bit.
void unpackTight(void* dst, const void* tightSrc, const ImageLayout& layout);

} // namespace mural::sizes
