// Input of the fuzz target of packed pictures: which codec both ends want (1 byte), then messages: window (1 byte), width, height and bytes (2 each), the bytes.
#pragma once

#include "tests/fuzz/network/input_reader.hpp"

namespace mural::fuzz {

inline constexpr const char* kWanted[] = {"auto", "lossy", "zstd", "jpeg-70"};
constexpr int32_t kMostColumns = 600; // three tiles
constexpr int32_t kMostRows = 150;
constexpr int kMostWindows = 3;

} // namespace mural::fuzz
