// The pictures of two eyes, and single pictures that contain both.
#pragma once

#include "nodes/output/picture.hpp"

namespace mural {

// Pictures of equal size.
struct EyePair {
    Picture left, right;
};

// Both eyes at full size in one buffer, the left eye above the right one.
void stackEyes(const EyePair& eyes, OwnedPicture& into);
EyePair eyesOfStack(const Picture& stacked);

// Halves the width: the mean of two neighbours, rounded up; an odd last column is copied. The left half is the left
// eye.
void sideBySide(const EyePair& eyes, OwnedPicture& into);
// Halves the height. The upper half is the left eye.
void topBottom(const EyePair& eyes, OwnedPicture& into);

} // namespace mural
