// packTight and unpackTight compared with the specification's formulae, value by value and bit by bit.
#include <gtest/gtest.h>

#include <cstring>

#include "streamcodec/sizes/gl_enums.hpp"
#include "tests/streamcodec/sizes_random.hpp"

namespace mural::sizes {
namespace {

struct Shape {
    GLenum format, type;
    size_t components, elementBytes; // as in GL 4.6 §8.4.4.1: n and s (packed: 1 and the word)
};

// elementBytes 0: bits.
const Shape kShapes[] = {
    {GL_RGB, GL_UNSIGNED_BYTE, 3, 1},
    {GL_RED, GL_UNSIGNED_BYTE, 1, 1},
    {GL_RG, GL_SHORT, 2, 2},
    {GL_RGB, GL_HALF_FLOAT, 3, 2},
    {GL_BGRA, GL_FLOAT, 4, 4},
    {GL_RGB_INTEGER, GL_UNSIGNED_INT, 3, 4},
    {GL_RGB, GL_UNSIGNED_BYTE_3_3_2, 1, 1},
    {GL_RGB, GL_UNSIGNED_SHORT_5_6_5, 1, 2},
    {GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, 1, 4},
    {GL_RGB, GL_UNSIGNED_INT_5_9_9_9_REV, 1, 4},
    {GL_YCBCR_MESA, GL_UNSIGNED_SHORT_8_8_MESA, 1, 2},
    // two words of four bytes
    {GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, 2, 4},
    {GL_CMYKA_EXT, GL_UNSIGNED_BYTE, 5, 1},
    {GL_COLOR_INDEX, GL_BITMAP, 1, 0},
    {GL_STENCIL_INDEX, GL_BITMAP, 1, 0},
};

// The specification's row length k in elements, times the element size.
size_t rowStrideBySpec(const Shape& shape, const PixelStore& store, size_t width) {
    const auto a = static_cast<size_t>(store.alignment);
    const size_t l = store.rowLength > 0 ? static_cast<size_t>(store.rowLength) : width;
    if (shape.elementBytes == 0) return a * ((l + 8 * a - 1) / (8 * a));
    const size_t s = shape.elementBytes;
    const size_t n = shape.components;
    if (s >= a) return n * l * s;
    return a / s * ((s * n * l + a - 1) / a) * s;
}

// Copies one pixel between client memory and the tight image.
struct Reference {
    const Shape& shape;
    const PixelStore& store;
    size_t width, height, depth;
    int dims;

    size_t rowStart(size_t row, size_t image) const {
        const size_t stride = rowStrideBySpec(shape, store, width);
        const size_t imageHeight = store.imageHeight > 0 ? static_cast<size_t>(store.imageHeight) : height;
        const size_t skipImages = dims == 3 ? static_cast<size_t>(store.skipImages) : 0;
        return (skipImages + image) * imageHeight * stride + (static_cast<size_t>(store.skipRows) + row) * stride;
    }

    template <class Visit> void eachPixel(const Visit& visit) const {
        for (size_t image = 0; image < depth; ++image)
            for (size_t row = 0; row < height; ++row)
                for (size_t x = 0; x < width; ++x) visit(x, row, image);
    }

    size_t clientBit(size_t x, size_t row, size_t image) const {
        const size_t pixel = static_cast<size_t>(store.skipPixels) + x;
        const size_t inByte = store.lsbFirst ? pixel % 8 : 7 - pixel % 8;
        return (rowStart(row, image) + pixel / 8) * 8 + inByte;
    }
    size_t tightBit(size_t x, size_t row, size_t image) const {
        return ((image * height + row) * ((width + 7) / 8) + x / 8) * 8 + 7 - x % 8;
    }

    // Visits pairs (byte of the client, byte of the tight image).
    template <class Visit> void eachByte(const Visit& visit) const {
        const size_t s = shape.elementBytes;
        const size_t n = shape.components;
        eachPixel([&](size_t x, size_t row, size_t image) {
            for (size_t value = 0; value < n; ++value)
                for (size_t b = 0; b < s; ++b) {
                    const size_t client =
                        rowStart(row, image) + (static_cast<size_t>(store.skipPixels) + x) * n * s + value * s + b;
                    const size_t tight =
                        ((image * height + row) * width + x) * n * s + value * s + (store.swapBytes ? s - 1 - b : b);
                    visit(client, tight);
                }
        });
    }

    size_t tightSize() const {
        return depth * height *
               (shape.elementBytes == 0 ? (width + 7) / 8 : width * shape.components * shape.elementBytes);
    }
    size_t span() const {
        size_t end = 0;
        if (shape.elementBytes != 0)
            eachByte([&](size_t client, size_t) { end = std::max(end, client + 1); });
        else
            eachPixel(
                [&](size_t x, size_t row, size_t image) { end = std::max(end, clientBit(x, row, image) / 8 + 1); });
        return end;
    }
};

bool bitAt(const std::vector<uint8_t>& bytes, size_t bit) { return (bytes[bit / 8] >> bit % 8 & 1) != 0; }
void setBit(std::vector<uint8_t>& bytes, size_t bit, bool on) {
    bytes[bit / 8] = static_cast<uint8_t>((bytes[bit / 8] & ~(1 << bit % 8)) | (on ? 1 << bit % 8 : 0));
}

std::vector<uint8_t> packedByReference(const Reference& r, const std::vector<uint8_t>& client) {
    std::vector<uint8_t> tight(r.tightSize(), 0);
    if (r.shape.elementBytes == 0)
        r.eachPixel([&](size_t x, size_t row, size_t image) {
            setBit(tight, r.tightBit(x, row, image), bitAt(client, r.clientBit(x, row, image)));
        });
    else
        r.eachByte([&](size_t from, size_t to) { tight[to] = client[from]; });
    return tight;
}

std::vector<uint8_t> unpackedByReference(const Reference& r, std::vector<uint8_t> client,
                                         const std::vector<uint8_t>& tight) {
    if (r.shape.elementBytes == 0)
        r.eachPixel([&](size_t x, size_t row, size_t image) {
            setBit(client, r.clientBit(x, row, image), bitAt(tight, r.tightBit(x, row, image)));
        });
    else
        r.eachByte([&](size_t to, size_t from) { client[to] = tight[from]; });
    return client;
}

void compareOnce(Random& random, const Shape& shape) {
    const int dims = random.between(1, 3);
    const int width = random.between(1, 37);
    const int height = dims > 1 ? random.between(1, 9) : 1;
    const int depth = dims > 2 ? random.between(1, 4) : 1;
    PixelStore store = random.store(width, height);
    if (random.oneIn(8)) store.rowLength = random.between(1, width); // rows may overlap: both sides proceed row by row
    SCOPED_TRACE(describe(store) + " size " + std::to_string(width) + "x" + std::to_string(height) + "x" +
                 std::to_string(depth) + " dims " + std::to_string(dims));
    const Reference reference{
        shape, store, static_cast<size_t>(width), static_cast<size_t>(height), static_cast<size_t>(depth), dims};

    const ImageLayout layout = layoutOf(store, shape.format, shape.type, width, height, depth, dims);
    ASSERT_TRUE(layout.known);
    ASSERT_EQ(spanBytes(layout), reference.span());
    ASSERT_EQ(tightBytes(layout), reference.tightSize());
    ASSERT_EQ(tightBytes(shape.format, shape.type, width, height, depth), reference.tightSize());

    const std::vector<uint8_t> client = random.bytes(reference.span());
    std::vector<uint8_t> tight(reference.tightSize(), 0x5a);
    packTight(tight.data(), client.data(), layout);
    ASSERT_EQ(tight, packedByReference(reference, client));

    const std::vector<uint8_t> picture = random.bytes(reference.tightSize());
    std::vector<uint8_t> target = client;
    unpackTight(target.data(), picture.data(), layout);
    ASSERT_EQ(target, unpackedByReference(reference, client, picture));
}

TEST(SizesImageCopy, agreesWithTheSpecification) {
    const uint32_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    for (const Shape& shape : kShapes) {
        for (int i = 0; i < 300; ++i) {
            compareOnce(random, shape);
            if (HasFatalFailure()) return;
        }
    }
}

TEST(SizesImageCopy, outputsBitmapsMostSignificantBitFirst) {
    PixelStore store;
    store.alignment = 1;
    store.skipPixels = 3;
    const uint8_t msb[] = {0b10110101, 0b11000000};
    uint8_t tight[1] = {};
    packTight(tight, msb, layoutOf(store, GL_COLOR_INDEX, GL_BITMAP, 7, 1, 1, 2));
    EXPECT_EQ(tight[0],
              0b10101110); // 10101 of the first byte, 11 of the second, one bit of padding
    store.lsbFirst = true;
    const uint8_t lsb[] = {0b10101101, 0b00000011};
    packTight(tight, lsb, layoutOf(store, GL_COLOR_INDEX, GL_BITMAP, 7, 1, 1, 2));
    EXPECT_EQ(tight[0], 0b10101110);
}

TEST(SizesImageCopy, preservesAdjacentBitsOfBitmaps) {
    PixelStore store;
    store.alignment = 1;
    store.skipPixels = 2;
    uint8_t client[] = {0xff, 0xff};
    const uint8_t zeros[] = {0};
    unpackTight(client, zeros, layoutOf(store, GL_COLOR_INDEX, GL_BITMAP, 7, 1, 1, 2));
    EXPECT_EQ(client[0], 0b11000000);
    EXPECT_EQ(client[1], 0b01111111);
}

TEST(SizesImageCopy, accessesNothingForEmptyUnknownAndImpossibleImages) {
    const PixelStore store;
    for (const ImageLayout& layout :
         {layoutOf(store, GL_RGBA, GL_FLOAT, 0, 5, 1, 2), layoutOf(store, GL_RGBA, GL_FLOAT, 5, -1, 1, 2),
          layoutOf(store, GL_RGBA, 0x1234, 5, 5, 1, 2), layoutOf(store, GL_RED, GL_BITMAP, 5, 5, 1, 2),
          layoutOf(store, GL_RGBA, GL_FLOAT, INT32_MAX, INT32_MAX, INT32_MAX, 3)}) {
        EXPECT_FALSE(layout.known);
        EXPECT_EQ(spanBytes(layout), 0u);
        EXPECT_EQ(tightBytes(layout), 0u);
        packTight(nullptr, nullptr, layout);
        unpackTight(nullptr, nullptr, layout);
    }
    EXPECT_EQ(tightBytes(GL_RGBA, GL_FLOAT, INT32_MAX, INT32_MAX, INT32_MAX), SIZE_MAX);
    EXPECT_EQ(tightBytes(GL_RGBA, GL_FLOAT, -1, 1, 1), 0u);
}

TEST(SizesImageCopy, doesNotWrapHugeSkips) {
    PixelStore store;
    store.rowLength = INT32_MAX;
    store.imageHeight = INT32_MAX;
    store.skipImages = INT32_MAX;
    EXPECT_FALSE(layoutOf(store, GL_RGBA, GL_FLOAT, 1, 1, 1, 3).known);
    store.imageHeight = 0;
    store.skipImages = 0;
    store.skipRows = INT32_MAX;
    const ImageLayout layout = layoutOf(store, GL_RED, GL_UNSIGNED_BYTE, 1, 1, 1, 2);
    ASSERT_TRUE(layout.known);
    EXPECT_EQ(layout.firstByte, ptrdiff_t{INT32_MAX} * (ptrdiff_t{INT32_MAX} + 1));
}

} // namespace
} // namespace mural::sizes
