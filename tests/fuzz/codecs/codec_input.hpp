// Input of a codec's fuzz target: format, width (2 bytes), height, then the bytes of a plane of that shape.
#pragma once

#include "compositor/codecs/codec.hpp"
#include "tests/fuzz/network/input_reader.hpp"

namespace mural::fuzz {

constexpr int32_t kMaxColumns = 520; // more than two tiles
constexpr int32_t kMaxRows = 140;
constexpr size_t kInputHeadBytes = 4;

inline compositor::PlaneShape readShape(InputReader& in) {
    const auto format = static_cast<compositor::PlaneFormat>(in.byte() % compositor::kPlaneFormats);
    const int32_t width = in.half() % kMaxColumns + 1;
    return {format, width, in.byte() % kMaxRows + 1};
}

} // namespace mural::fuzz
