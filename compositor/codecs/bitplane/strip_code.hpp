// Encoding and decoding of one strip, with the widest vectors of this machine; and as the format reads, word by word.
#pragma once

#include "compositor/codecs/bitplane/bitplane_format.hpp"

namespace mural::compositor::bitplane {

// Returns the bytes written; `into` has kStripBoundBytes + kSlackBytes.
size_t encodeStrip(const StripSource& source, const StripKind& kind, std::byte* into);
size_t encodeStripScalar(const StripSource& source, const StripKind& kind, std::byte* into);

// target.above is row -1 of the picture; in the first strip it holds zeros, and finishFirstStrip does the rest.
void decodeStrip(const ParsedStrip& strip, const StripKind& kind, const StripTarget& target);
void decodeStripScalar(const ParsedStrip& strip, const StripKind& kind, const StripTarget& target);

// The first strip of a tile: row 0 holds differences to the word `leftWords` before. Adds them up, and what that changes to
// all four rows.
void finishFirstStrip(const StripTarget& target, Arithmetic arithmetic, unsigned leftWords);

} // namespace mural::compositor::bitplane
