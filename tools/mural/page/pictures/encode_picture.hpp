// Encodes pictures of the head for browsers. Thread-safe.
#pragma once

#include <cstdint>
#include <string>

#include "common/base/result.hpp"
#include "nodes/output/picture.hpp"

namespace mural::page {

enum class ChromaOf { Half, All }; // 4:2:0, 4:4:4

// Requires Bgra8. quality: 1 to 100.
Result<std::string> encodeJpeg(const Picture& picture, int quality, ChromaOf chroma);
// Lossless, without alpha. Requires Bgra8.
Result<std::string> encodePng(const Picture& picture);
// pixels: rows from the top, each 0xAARRGGBB with colours multiplied by alpha, as XFIXES has them.
Result<std::string> encodeCursorPng(const uint32_t* pixels, int width, int height);

} // namespace mural::page
