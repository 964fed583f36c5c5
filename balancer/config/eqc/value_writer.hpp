// Writes field values as text that reads back as the same value.
#pragma once

#include "balancer/config/config.hpp"
#include "balancer/config/eqc/words.hpp"

namespace mural::config {

// Returns the shortest digits that read back as the same number, without an exponent, which the format lacks.
std::string numberText(double value);

std::string valueText(const std::string& value);
std::string valueText(char value);
inline std::string valueText(double value) { return numberText(value); }
inline std::string valueText(uint32_t value) { return std::to_string(value); }
std::string valueText(const Viewport& value);
std::string valueText(const Vector3& value);
std::string valueText(const Degrees2& value);
std::string valueText(const Range& value);
std::string valueText(const Zoom& value);
std::string valueText(const PixelKernel& value);
std::string valueText(const SubPixel& value);
std::string valueText(const Bezel& value);
std::string valueText(const Reference& value);
std::string valueText(const LayoutReference& value);
std::string valueText(const ChannelReference& value);

template <class E>
requires std::is_enum_v<E> std::string valueText(E value) { return std::string(wordOf(value)); }

template <class E> std::string valueText(const EnumSet<E>& value) {
    std::string text = "[";
    for (const auto& s : spellings(E{})) {
        if (value.has(s.value) && wordOf(s.value) == s.word) text += " " + std::string(s.word);
    }
    return text + " ]";
}

} // namespace mural::config
