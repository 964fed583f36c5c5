#include "balancer/config/eqc/value_writer.hpp"

#include <charconv>

namespace mural::config {

namespace {

template <class... T> std::string bracketed(const T&... values) {
    std::string text = "[";
    ((text += " " + valueText(values)), ...);
    return text + " ]";
}

uint32_t unsignedOf(int32_t value) { return static_cast<uint32_t>(value); }

} // namespace

std::string numberText(double value) {
    char text[400]; // longest output: 323 zeros after the point, then 17 digits
    const auto [end, error] = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed);
    return {text, error == std::errc{} ? end : text};
}

std::string valueText(const std::string& value) { return "\"" + value + "\""; }
std::string valueText(char value) { return std::string("'") + value + "'"; }
std::string valueText(const Viewport& v) { return bracketed(v.x, v.y, v.w, v.h); }
std::string valueText(const Vector3& v) { return bracketed(v.x, v.y, v.z); }
std::string valueText(const Degrees2& v) { return bracketed(v.x, v.y); }
std::string valueText(const Range& r) { return bracketed(r.start, r.end); }
std::string valueText(const Zoom& z) { return bracketed(z.x, z.y); }
std::string valueText(const PixelKernel& k) {
    return bracketed(unsignedOf(k.x), unsignedOf(k.y), unsignedOf(k.w), unsignedOf(k.h));
}
std::string valueText(const SubPixel& s) { return bracketed(unsignedOf(s.index), unsignedOf(s.size)); }
std::string valueText(const Bezel& b) { return bracketed(b.left, b.right, b.bottom, b.top); }

std::string valueText(const Reference& value) {
    return std::visit([](const auto& v) { return valueText(v); }, value);
}

std::string valueText(const LayoutReference& value) {
    if (const auto* name = std::get_if<std::string>(&value)) return valueText(*name);
    if (const auto* index = std::get_if<uint32_t>(&value)) return valueText(*index);
    return "OFF";
}

std::string valueText(const ChannelReference& value) {
    if (const auto* name = std::get_if<std::string>(&value)) return valueText(*name);
    std::string text = "(";
    for (const auto& [step, reference] : std::get<ChannelPath>(value).steps)
        text += " " + valueText(step) + " " + valueText(reference);
    return text + " )";
}

} // namespace mural::config
