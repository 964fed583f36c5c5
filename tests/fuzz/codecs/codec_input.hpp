// Input of a codec's fuzz target: format, width (2 bytes), height, then the bytes of a plane of that shape.
#pragma once

#include "compositor/codecs/codec.hpp"
#include "tests/fuzz/network/input_reader.hpp"

namespace mural::fuzz {

constexpr int32_t kMostColumns = 520; // more than two tiles
constexpr int32_t kMostRows = 140;
constexpr size_t kInputHeadBytes = 4;

inline compositor::PlaneShape readShape(InputReader& in) {
    const auto format = static_cast<compositor::PlaneFormat>(in.byte() % compositor::kPlaneFormats);
    const int32_t width = in.half() % kMostColumns + 1;
    return {format, width, in.byte() % kMostRows + 1};
}

} // namespace mural::fuzz
