// Converts the pixel store state to offsets. Sizes are checked for overflow: arguments may be a program's mistake or,
// on a render node, come from the network.
#include "streamcodec/sizes/pixel_format.hpp"

namespace mural::sizes {
namespace {

// A size with a sticky overflow flag.
struct Checked {
    size_t bytes;
    bool overflow = false;

    explicit Checked(size_t value) : bytes(value), overflow(value > kMaxBytes) {}

    Checked operator*(size_t factor) const {
        Checked product(0);
        product.overflow =
            __builtin_mul_overflow(bytes, factor, &product.bytes) || overflow || product.bytes > kMaxBytes;
        return product;
    }

    Checked operator+(const Checked& other) const {
        Checked sum(0);
        sum.overflow = __builtin_add_overflow(bytes, other.bytes, &sum.bytes) || overflow || other.overflow ||
                       sum.bytes > kMaxBytes;
        return sum;
    }
};

size_t positive(GLint value) { return value > 0 ? static_cast<size_t>(value) : 0; }
size_t orElse(GLint value, GLsizei other) { return positive(value > 0 ? value : other); }

size_t roundUp(size_t value, size_t step) { return (value + step - 1) / step * step; }

// GL accepts 1, 2, 4 and 8.
size_t alignmentOf(const PixelStore& store) { return store.alignment > 0 ? positive(store.alignment) : 1; }

// Bytes of `pixels` pixels, starting at bit `firstBit`.
size_t bytesOfPixels(size_t pixels, uint32_t group, size_t firstBit) {
    return group == 0 ? (firstBit + pixels + 7) / 8 : pixels * group;
}

// Only indices can be single bits: glBitmap, glPolygonStipple, glDrawPixels, glReadPixels.
bool isBitmap(GLenum format, GLenum type) {
    return type == GL_BITMAP && (format == GL_COLOR_INDEX || format == GL_STENCIL_INDEX);
}

void setSwap(ImageLayout& layout, const PixelStore& store, GLenum type) {
    const uint32_t unit = swapUnitBytes(type);
    layout.swapUnit = store.swapBytes && unit > 1 ? unit : 0;
}

// GL_PACK_INVERT_MESA: rows run downwards from the highest row of the image. As in Mesa, skipped rows precede it, so
// they shift the image downwards.
void invertRows(ImageLayout& layout, ptrdiff_t skipRows) {
    layout.firstByte += layout.rowStride * (static_cast<ptrdiff_t>(layout.rows) - 1 - 2 * skipRows);
    layout.rowStride = -layout.rowStride;
}

} // namespace

ImageLayout layoutOf(const PixelStore& store, GLenum format, GLenum type, GLsizei width, GLsizei height, GLsizei depth,
                     int dims) {
    ImageLayout layout;
    layout.bitmap = isBitmap(format, type);
    const uint32_t group = groupBytes(format, type);
    if ((group == 0 && !layout.bitmap) || width <= 0 || height <= 0 || depth <= 0) return layout;

    const size_t skipPixels = positive(store.skipPixels);
    layout.firstBit = layout.bitmap ? static_cast<uint32_t>(skipPixels % 8) : 0;
    layout.lsbFirst = layout.bitmap && store.lsbFirst;
    layout.width = static_cast<uint32_t>(width);
    layout.rows = static_cast<uint32_t>(height);
    layout.images = static_cast<uint32_t>(depth);
    layout.rowBytes = bytesOfPixels(layout.width, group, 0);
    layout.clientRowBytes = bytesOfPixels(layout.width, group, layout.firstBit);

    const size_t stride = roundUp(bytesOfPixels(orElse(store.rowLength, width), group, 0), alignmentOf(store));
    const Checked imageStride = Checked(stride) * orElse(store.imageHeight, height);
    const Checked first = imageStride * (dims >= 3 ? positive(store.skipImages) : 0) +
                          Checked(stride) * positive(store.skipRows) +
                          Checked(layout.bitmap ? skipPixels / 8 : skipPixels * group);
    const Checked end = first + imageStride * (layout.images - 1u) + Checked(stride) * (layout.rows - 1u) +
                        Checked(layout.clientRowBytes);
    if (end.overflow || (Checked(layout.rowBytes) * layout.rows * layout.images).overflow) return layout;

    layout.known = true;
    layout.rowStride = static_cast<ptrdiff_t>(stride);
    layout.imageStride = imageStride.bytes;
    layout.firstByte = static_cast<ptrdiff_t>(first.bytes);
    setSwap(layout, store, type);
    if (store.invert) invertRows(layout, static_cast<ptrdiff_t>(positive(store.skipRows)));
    return layout;
}

size_t tightBytes(GLenum format, GLenum type, GLsizei width, GLsizei height, GLsizei depth) {
    const uint32_t group = groupBytes(format, type);
    if ((group == 0 && !isBitmap(format, type)) || width <= 0 || height <= 0 || depth <= 0) return 0;
    const Checked size = Checked(bytesOfPixels(positive(width), group, 0)) * positive(height) * positive(depth);
    return size.overflow ? SIZE_MAX : size.bytes;
}

size_t tightBytes(const ImageLayout& layout) {
    return layout.known ? layout.rowBytes * layout.rows * layout.images : 0;
}

size_t spanBytes(const ImageLayout& layout) {
    if (!layout.known) return 0;
    const uint32_t highestRow = layout.rowStride < 0 ? 0 : layout.rows - 1;
    const ptrdiff_t end =
        layout.rowOffset(highestRow, layout.images - 1) + static_cast<ptrdiff_t>(layout.clientRowBytes);
    return end > 0 ? static_cast<size_t>(end) : 0;
}

} // namespace mural::sizes
