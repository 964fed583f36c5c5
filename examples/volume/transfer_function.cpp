#include "examples/volume/transfer_function.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "examples/base/arguments.hpp"

namespace mural::examples {
namespace {

struct Preset {
    std::string_view name, points;
};
// Points for volumes whose values span their window.
constexpr std::array kPresets{
    Preset{"grey", "0.08:000000:0,1:ffffff:0.25"},
    Preset{"brain", "0.12:000000:0,0.25:7a4030:0.01,0.45:d08070:0.04,0.62:f0d8c0:0.25,1:ffffff:0.5"},
    Preset{"bone", "0.22:000000:0,0.27:c07850:0.02,0.31:c07850:0.01,0.36:e8d8b8:0.2,0.6:ffffff:0.6"},
    Preset{"labels", "0.001:000000:0,0.004:e0a060:0.1,0.01:60a0e0:0.2,0.1:60e080:0.2,1:ffffff:0.3"},
};

Error problemOf(std::string_view point) {
    return Error{"\"" + std::string(point.substr(0, 40)) +
                 "\" is no point of a transfer function such as 0.5:ffcc99:0.3; the names are " + transferPresets()};
}

bool parseNumber(std::string_view word, float& value) {
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    return problem == std::errc{} && end == word.data() + word.size();
}

bool parsePoint(std::string_view text, TransferPoint& point) {
    const size_t colour = text.find(':');
    const size_t opacity = colour == std::string_view::npos ? colour : text.find(':', colour + 1);
    if (opacity == std::string_view::npos || opacity - colour != 7) return false;
    if (!parseNumber(text.substr(0, colour), point.value) || !parseNumber(text.substr(opacity + 1), point.opacity))
        return false;
    const Result<std::array<float, 3>> rgb = parseColour(text.substr(colour + 1, 6));
    if (!rgb) return false;
    point.colour = rgb.value();
    const auto isFraction = [](float x) { return x >= 0 && x <= 1; };
    return isFraction(point.value) && isFraction(point.opacity);
}

uint8_t toByte(float fraction) { return static_cast<uint8_t>(std::lround(std::clamp(fraction, 0.f, 1.f) * 255)); }

} // namespace

TransferTable TransferFunction::table() const {
    TransferTable table{};
    if (points.empty()) return table;
    size_t after = 0; // the first point above the value
    for (size_t entry = 0; entry < kTransferEntries; ++entry) {
        const float value = static_cast<float>(entry) / (kTransferEntries - 1);
        while (after < points.size() && points[after].value <= value) ++after;
        const TransferPoint& a = points[after > 0 ? after - 1 : 0];
        const TransferPoint& b = points[std::min(after, points.size() - 1)];
        const float width = b.value - a.value;
        const float t = width > 0 ? std::clamp((value - a.value) / width, 0.f, 1.f) : 0;
        for (size_t k = 0; k < 3; ++k) table[4 * entry + k] = toByte(a.colour[k] + t * (b.colour[k] - a.colour[k]));
        table[4 * entry + 3] = toByte(a.opacity + t * (b.opacity - a.opacity));
    }
    return table;
}

Result<TransferFunction> parseTransferFunction(std::string_view text) {
    for (const Preset& preset : kPresets) {
        if (preset.name == text) text = preset.points;
    }
    TransferFunction function;
    while (true) {
        const std::string_view word = text.substr(0, text.find(','));
        TransferPoint point;
        if (!parsePoint(word, point)) return problemOf(word);
        if (!function.points.empty() && point.value < function.points.back().value)
            return Error{"the point \"" + std::string(word) + "\" has a smaller value than the point before it"};
        function.points.push_back(point);
        if (word.size() == text.size()) return function;
        text.remove_prefix(word.size() + 1);
    }
}

std::string transferPresets() {
    std::string names;
    for (const Preset& preset : kPresets) names += (names.empty() ? "" : ", ") + std::string(preset.name);
    return names;
}

} // namespace mural::examples
