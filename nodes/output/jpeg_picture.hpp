// Pictures as JPEG, for the way from a node's windows to the head. Thread-safe.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "nodes/output/picture.hpp"

namespace mural {

// Requires Bgra8. Keeps all of the colour. quality: 1 to 100. Empty: out of memory.
[[nodiscard]] std::vector<std::byte> jpegOf(const Picture& picture, int quality);
// Decodes into a picture of this size. Returns false for anything but a JPEG of that size.
bool pictureOfJpeg(std::span<const std::byte> jpeg, int width, int height, OwnedPicture& into);

} // namespace mural
