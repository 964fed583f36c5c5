// Input of the fuzz target of packed pictures: the codec of both ends (1 byte), then messages. A message is the window
// (1 byte), width, height and size in bytes (2 each), and the bytes.
#pragma once

#include "tests/fuzz/network/input_reader.hpp"

namespace mural::fuzz {

inline constexpr const char* kWanted[] = {"auto", "lossy", "zstd", "jpeg-70"};
constexpr int32_t kMaxColumns = 600; // three tiles
constexpr int32_t kMaxRows = 150;
constexpr int kMaxWindows = 3;

} // namespace mural::fuzz
