// Hashes of what outputs show. Equal pixels have equal hashes on all machines. Pure.
#pragma once

#include <cstdint>
#include <span>

#include "nodes/output/picture.hpp"

namespace mural {

// Hash of the pictures of an output, in their order. Never 0.
[[nodiscard]] uint64_t hashOfPictures(std::span<const Picture> pictures);
// Hash of the part of a picture. An empty part has the hash of no pixels.
[[nodiscard]] uint64_t hashOfPart(const Picture& picture, const PixelViewport& part);

} // namespace mural
