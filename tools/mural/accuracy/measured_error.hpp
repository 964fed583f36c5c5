// Differences between pixels and a reference, and bounds for them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "nodes/output/picture.hpp"

namespace mural::cli {

// Accumulated over any number of pictures. Values are relative to 255.
struct MeasuredError {
    int64_t pixels = 0;
    int64_t differing = 0; // pixels with any difference
    double largest = 0;    // of one colour component
    double squares = 0;    // sum over all components
    int64_t components = 0;

    void add(const MeasuredError& other);
    void addValue(double difference); // one component; the caller counts pixels
    [[nodiscard]] double rootMeanSquare() const;
    // In decibels; empty without differences.
    [[nodiscard]] std::optional<double> psnr() const;
    [[nodiscard]] double differingShare() const {
        return pixels > 0 ? static_cast<double>(differing) / static_cast<double>(pixels) : 0;
    }
};

// Compares 8-bit colours. For different sizes every pixel of `expected` counts as wrong.
[[nodiscard]] MeasuredError errorOf(const Picture& expected, const Picture& actual);

// Bounds; an empty member has no bound.
struct Bound {
    std::optional<double> differingShare;
    std::optional<double> largest;
    std::optional<double> psnr; // minimum

    static Bound exact() { return {0.0, {}, {}}; }
    [[nodiscard]] bool holds(const MeasuredError& error) const;
    [[nodiscard]] std::string text() const; // "equal", "≤ 0.25 % differ, ≥ 50 dB"; "none"
};

} // namespace mural::cli
