// Two eyes' pictures, and both in one for who can show only that.
#pragma once

#include "nodes/output/picture.hpp"

namespace mural {

// Of one size.
struct EyePair {
    Picture left, right;
};

// Both whole, in one piece of memory: the left eye's above the right one's.
void stackEyes(const EyePair& eyes, OwnedPicture& into);
EyePair eyesOfStack(const Picture& stacked);

// One dimension is halved: the mean of two neighbours, rounded up; an odd last one stands alone. The left half is the left eye's.
void sideBySide(const EyePair& eyes, OwnedPicture& into);
// The upper half is the left eye's.
void topBottom(const EyePair& eyes, OwnedPicture& into);

} // namespace mural
