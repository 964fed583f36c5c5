// Encodes pictures of the head for browsers. Thread-safe.
#pragma once

#include <string>

#include "common/base/result.hpp"
#include "nodes/output/picture.hpp"

namespace mural::page {

enum class ChromaOf { Half, All }; // 4:2:0, 4:4:4

// Requires Bgra8. quality: 1 to 100.
Result<std::string> encodeJpeg(const Picture& picture, int quality, ChromaOf chroma);
// Lossless, without alpha. Requires Bgra8.
Result<std::string> encodePng(const Picture& picture);

} // namespace mural::page
