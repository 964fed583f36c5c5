#include "tools/mural/accuracy/measured_error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace mural::cli {

void MeasuredError::add(const MeasuredError& o) {
    pixels += o.pixels;
    differing += o.differing;
    largest = std::max(largest, o.largest);
    squares += o.squares;
    components += o.components;
}

void MeasuredError::addValue(double difference) {
    largest = std::max(largest, std::abs(difference));
    squares += difference * difference;
    ++components;
}

double MeasuredError::rootMeanSquare() const {
    return components > 0 ? std::sqrt(squares / static_cast<double>(components)) : 0;
}

std::optional<double> MeasuredError::psnr() const {
    if (squares <= 0) return {};
    return 20 * std::log10(255 / rootMeanSquare());
}

MeasuredError errorOf(const Picture& expected, const Picture& actual) {
    const bool same = expected.width == actual.width && expected.height == actual.height;
    MeasuredError error;
    for (int y = 0; y < expected.height; ++y)
        for (int x = 0; x < expected.width; ++x) {
            bool differs = false;
            for (int c = 0; c < 3; ++c) {
                const int at = 4 * x + c;
                const int d =
                    same ? std::to_integer<int>(expected.row(y)[at]) - std::to_integer<int>(actual.row(y)[at]) : 255;
                error.addValue(d);
                differs = differs || d != 0;
            }
            ++error.pixels;
            error.differing += differs;
        }
    return error;
}

bool Bound::holds(const MeasuredError& e) const {
    if (e.pixels == 0) return false; // nothing was compared
    if (differingShare && e.differingShare() > *differingShare) return false;
    if (largest && e.largest > *largest) return false;
    const auto reached = e.psnr();
    return !psnr || !reached || *reached >= *psnr;
}

std::string Bound::text() const {
    std::string text;
    const auto add = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
    if (differingShare)
        add(*differingShare > 0 ? fmt::format("≤ {:g} % differ", 100 * *differingShare) : std::string("equal"));
    if (largest) add(fmt::format("≤ {:g} of 255", *largest));
    if (psnr) add(fmt::format("≥ {:g} dB", *psnr));
    return text.empty() ? "none" : text;
}

} // namespace mural::cli
