// Codec of the section of new pages. LZ4 compresses it like other sections. Zstandard compresses pictures separately:
// the number of filtered pieces (pixel_filter.hpp), and if any, the compressed sizes of front and planes, then both;
// then the rest, if any.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "streamcodec/delta/entropy/huffman_codec.hpp"
#include "streamcodec/delta/entropy/pixel_filter.hpp"
#include "streamcodec/delta/entropy/section_codec.hpp"

namespace mural::delta {

class PageCompressor {
public:
    // Same contract as SectionCompressor.
    bool compress(Coding coding, std::span<const std::byte> pages, std::vector<std::byte>& into);
    void prepare();

private:
    // Level 2 pays off for the rest: vertices and compressed texture formats become a fifth smaller than with level 1.
    // Bit masks become a sixth smaller with level 1 than with -1, in twice the time.
    SectionCompressor rest_{2}, fronts_{1}, planes_{1};
    HuffmanCompressor countedPlanes_; // of photographs
    PixelFilterEncoder splitter_;
    std::vector<std::byte> codedFront_, codedPlanes_;
};

class PageDecompressor {
public:
    bool decompress(Coding coding, std::span<const std::byte> bytes, std::span<std::byte> into);

private:
    bool decompressPixels(uint32_t pieces, std::span<const std::byte> bytes, std::span<std::byte> into);
    bool decompressPlanes(bool counted, std::span<const std::byte> planes);

    SectionDecompressor rest_, fronts_, planes_;
    HuffmanDecompressor countedPlanes_;
    PixelFilterDecoder joiner_;
    std::vector<std::byte> frontBytes_, planeBytes_, restBytes_;
};

} // namespace mural::delta
