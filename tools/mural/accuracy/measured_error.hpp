// How far pixels are from those of a reference, and what was promised.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "nodes/output/picture.hpp"

namespace mural::cli {

// Over any number of pictures. Values are of 255.
struct MeasuredError {
    int64_t pixels = 0;
    int64_t differing = 0; // pixels with any difference
    double largest = 0;    // of one colour component
    double squares = 0;    // of all components' differences, added up
    int64_t components = 0;

    void add(const MeasuredError& other);
    void addValue(double difference); // of one component; pixels are counted by the caller
    [[nodiscard]] double rootMeanSquare() const;
    // Decibels; none where nothing differs.
    [[nodiscard]] std::optional<double> psnr() const;
    [[nodiscard]] double differingShare() const { return pixels > 0 ? static_cast<double>(differing) / static_cast<double>(pixels) : 0; }
};

// Colour of 8 bits; pictures of one size. Where sizes differ, all of `expected` counts as wrong.
[[nodiscard]] MeasuredError errorOf(const Picture& expected, const Picture& actual);

// What must hold; what is not given is not promised.
struct Bound {
    std::optional<double> differingShare;
    std::optional<double> largest;
    std::optional<double> psnr; // at least

    static Bound exact() { return {0.0, {}, {}}; }
    [[nodiscard]] bool holds(const MeasuredError& error) const;
    [[nodiscard]] std::string text() const; // "equal", "≤ 0.25 % differ, ≥ 50 dB"; "none"
};

} // namespace mural::cli
