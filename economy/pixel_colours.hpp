// What colours of a pixel have in common, told once: pictures are brighter here and darker there more than they are of other colours, and in
// grey ones all three are the same. Green stays; of red and blue stays what they differ from it by. (Lossless formats of pictures do as much: QOI, WebP.)
// Of pixels of four bytes the second is green, and the fourth stays; they stay where they are. Of pixels of three all greens go first, then
// all reds, then all blues, then what belongs to no whole pixel.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::economy {

// `way`: kColoursOfFour or more. Both pieces have kPageBytes and are not the same.
void takeColoursApart(const std::byte* piece, uint8_t way, std::byte* apart);
void putColoursTogether(const std::byte* apart, uint8_t way, std::byte* piece);

} // namespace mural::economy
