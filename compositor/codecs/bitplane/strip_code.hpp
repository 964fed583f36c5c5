// Encodes and decodes one strip, with the widest vectors of this machine, and as a word-by-word reference.
#pragma once

#include "compositor/codecs/bitplane/bitplane_format.hpp"

namespace mural::compositor::bitplane {

// Returns the number of bytes written. Requires kStripBoundBytes + kSlackBytes in `into`.
size_t encodeStrip(const StripSource& source, const StripKind& kind, std::byte* into);
size_t encodeStripScalar(const StripSource& source, const StripKind& kind, std::byte* into);

// target.above is row -1 of the picture; zeros in the first strip, which finishFirstStrip() completes.
void decodeStrip(const ParsedStrip& strip, const StripKind& kind, const StripTarget& target);
void decodeStripScalar(const ParsedStrip& strip, const StripKind& kind, const StripTarget& target);

// Completes the first strip of a tile, whose row 0 holds differences to the word `leftWords` before: sums them, and
// adds the sums to all four rows.
void finishFirstStrip(const StripTarget& target, Arithmetic arithmetic, unsigned leftWords);

} // namespace mural::compositor::bitplane
