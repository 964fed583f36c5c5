// Reduces pictures for viewers: each pixel is the mean of the pixels that it covers. Pure.
#pragma once

#include <cstddef>
#include <cstdint>

#include "nodes/output/picture.hpp"

namespace mural {

struct ReducedSize {
    int width = 0, height = 0;
};

// Returns the largest size within the limits that has the proportions of the source. Never enlarges.
[[nodiscard]] ReducedSize reducedSize(int width, int height, int maxWidth, int maxHeight);

// Writes the reduced picture, in rows without gaps. Requires Bgra8, and a size of at most that of the source.
void reducePicture(const Picture& source, ReducedSize size, std::byte* to);

} // namespace mural
