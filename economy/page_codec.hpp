// The section of new pages. By LZ4 as other sections; by Zstandard what is like pictures apart from the rest: a number, how many pieces are
// (pixel_pieces.hpp). If any, compressed sizes of front and planes, then these. Then the rest, if any.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "economy/counted_codec.hpp"
#include "economy/pixel_pieces.hpp"
#include "economy/section_codec.hpp"

namespace mural::economy {

class PageCompressor {
public:
    // As SectionCompressor has them.
    bool compress(Coding coding, std::span<const std::byte> pages, std::vector<std::byte>& into);
    void prepare();

private:
    // Of what is no picture the better level pays: vertices and pictures in formats of the card become a fifth smaller by 2 than by 1.
    // Bits of masks become a sixth smaller by 1 than by -1, in twice the time.
    SectionCompressor rest_{2}, fronts_{1}, planes_{1};
    CountedCompressor countedPlanes_; // of photographs
    PixelSplitter splitter_;
    std::vector<std::byte> codedFront_, codedPlanes_;
};

class PageDecompressor {
public:
    bool decompress(Coding coding, std::span<const std::byte> bytes, std::span<std::byte> into);

private:
    bool decompressPixels(uint32_t pieces, std::span<const std::byte> bytes, std::span<std::byte> into);
    bool decompressPlanes(bool counted, std::span<const std::byte> planes);

    SectionDecompressor rest_, fronts_, planes_;
    CountedDecompressor countedPlanes_;
    PixelJoiner joiner_;
    std::vector<std::byte> frontBytes_, planeBytes_, restBytes_;
};

} // namespace mural::economy
