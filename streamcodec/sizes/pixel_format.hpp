// Images in client memory: bytes per pixel, and where the rows of an image lie under the pixel
// store state (GL 4.6 §8.4.4, §18.2.2). Images travel "tight": as alignment 1 and nothing else set
// describes them, in the machine's byte order, bitmap rows most significant bit first and padded
// with zero bits to whole bytes. All functions are pure and safe with any value of any argument.
#pragma once

#include <cstddef>
#include <cstdint>

#include <GL/gl.h>

namespace mural::sizes {

constexpr size_t kMaxBytes = PTRDIFF_MAX; // the largest size that still is an address difference

// Values per pixel of a client format; 0: not a format.
uint32_t componentsOf(GLenum format);

// Bytes per pixel. 0: GL takes no such pair (it then raises an error and touches no client memory),
// or the type is GL_BITMAP, which has no whole bytes.
uint32_t groupBytes(GLenum format, GLenum type);

// Bytes of what GL_*_SWAP_BYTES reverses: a value, or the whole of a packed pixel. 0: not a type.
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
    bool invert =
        false; // GL_PACK_INVERT_MESA, GL_PACK_REVERSE_ROW_ORDER_ANGLE: the first row is the highest
    GLint compressedBlockWidth = 0;
    GLint compressedBlockHeight = 0;
    GLint compressedBlockDepth = 0;
    GLint compressedBlockSize = 0;
};

// Where the rows of an image lie, relative to the pointer that GL gets. All sizes in bytes.
struct ImageLayout {
    bool known = false;    // false: GL touches nothing (invalid or empty image)
    bool bitmap = false;   // rows are bits: the first is bit `firstBit` of the row's first byte
    bool lsbFirst = false; // of a bitmap
    uint32_t firstBit = 0; // 0…7
    uint32_t width = 0;    // pixels
    uint32_t rows = 0;     // per image; rows of blocks when compressed
    uint32_t images = 0;
    uint32_t swapUnit =
        0; // client values of 2 or 4 bytes are in the other byte order; 0: they aren't
    size_t rowBytes = 0;       // of a tight row
    size_t clientRowBytes = 0; // from the first to the last byte of a client row that holds pixels
    ptrdiff_t rowStride = 0;   // negative when inverted
    size_t imageStride = 0;
    ptrdiff_t firstByte = 0; // of row 0 of image 0

    [[nodiscard]] ptrdiff_t rowOffset(uint32_t row, uint32_t image) const {
        return firstByte + static_cast<ptrdiff_t>(image) * static_cast<ptrdiff_t>(imageStride) +
               static_cast<ptrdiff_t>(row) * rowStride;
    }
};

// dims: of the command or texture target (1, 2, 3): GL_*_SKIP_IMAGES counts for 3 only,
// GL_*_SKIP_ROWS always. height and depth are 1 where the command has none; glPolygonStipple is a
// 32×32 GL_COLOR_INDEX, GL_BITMAP.
ImageLayout layoutOf(const PixelStore& store,
                     GLenum format,
                     GLenum type,
                     GLsizei width,
                     GLsizei height,
                     GLsizei depth,
                     int dims);

// Bytes of the tight image. 0: empty or unknown. SIZE_MAX: no memory can hold it.
size_t tightBytes(GLenum format, GLenum type, GLsizei width, GLsizei height, GLsizei depth);
size_t tightBytes(const ImageLayout& layout);

// Bytes from the pointer to the end of what GL reads or writes.
size_t spanBytes(const ImageLayout& layout);

// Client memory → tight. dst has tightBytes(layout).
void packTight(void* dst, const void* src, const ImageLayout& layout);

// Tight → client memory under the pack state: writes the pixels of the rows and not a bit more.
void unpackTight(void* dst, const void* tightSrc, const ImageLayout& layout);

} // namespace mural::sizes
