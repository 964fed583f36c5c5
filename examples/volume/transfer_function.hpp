// Transfer functions: colour and opacity of each value of a volume.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"

namespace mural::examples {

// A point of the function. Components are from 0 to 1.
struct TransferPoint {
    float value = 0; // position in the range of the volume's values
    std::array<float, 3> colour{};
    float opacity = 0; // of a path as long as the smallest distance between voxels

    template <class Visit> void fields(Visit& visit) { visit(value, colour, opacity); }
    friend bool operator==(const TransferPoint&, const TransferPoint&) = default;
};

constexpr size_t kTransferEntries = 256;
using TransferTable = std::array<uint8_t, kTransferEntries * 4>; // red, green, blue, opacity; not premultiplied

struct TransferFunction {
    std::vector<TransferPoint> points; // by increasing value

    // Returns the function at evenly spaced values, linear between its points and constant outside of them. A function
    // without points is invisible.
    [[nodiscard]] TransferTable table() const;

    template <class Visit> void fields(Visit& visit) { visit(points); }
    friend bool operator==(const TransferFunction&, const TransferFunction&) = default;
};

// Returns the function that a text states: a name of transferPresets(), or points such as "0.2:ffcc99:0,0.5:ffffff:0.3"
// (value, colour, opacity). Error: the point, the problem.
Result<TransferFunction> parseTransferFunction(std::string_view text);
// The names of the built-in functions, separated by commas.
std::string transferPresets();

} // namespace mural::examples
