#include "balancer/equalizers/parameters.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace mural::balance {

namespace {

std::string numberText(double value) {
    if (std::isinf(value)) return "inf";
    char text[32];
    const auto end = std::to_chars(std::begin(text), std::end(text), value);
    return {text, end.ptr};
}

std::vector<std::string_view> wordsOf(std::string_view text) {
    std::vector<std::string_view> words;
    while (true) {
        const size_t first = text.find_first_not_of(" \t,[]");
        if (first == std::string_view::npos) return words;
        text.remove_prefix(first);
        const size_t end = std::min(text.find_first_of(" \t,[]"), text.size());
        words.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
}

std::optional<double> numberOf(std::string_view word) {
    double value = 0;
    const auto end = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end.ec != std::errc{} || end.ptr != word.data() + word.size() || std::isnan(value)) return {};
    return value;
}

std::string allowed(const Parameter& p) {
    if (!p.words.empty()) {
        std::string text = p.name + " must be ";
        for (size_t i = 0; i < p.words.size(); ++i)
            text += (i == 0 ? "" : i + 1 == p.words.size() ? " or " : ", ") + p.words[i];
        return text;
    }
    const bool two = std::holds_alternative<PixelStep>(p.value);
    const std::string unit = p.unit.empty() ? "" : " " + p.unit;
    std::string limits = numberText(p.least) + (std::isinf(p.most) ? " or more" : " to " + numberText(p.most));
    return p.name + " must be " + (two ? "two numbers, each " : "") + limits + unit;
}

std::optional<ParameterValue> parse(const Parameter& p, std::string_view text) {
    const auto words = wordsOf(text);
    const bool two = std::holds_alternative<PixelStep>(p.value);
    if (words.size() != (two ? 2 : 1)) return {};
    if (!p.words.empty()) {
        if (std::find(p.words.begin(), p.words.end(), words[0]) == p.words.end()) return {};
        return std::string(words[0]);
    }
    double values[2] = {0, 0};
    for (size_t i = 0; i < words.size(); ++i) {
        const auto value = numberOf(words[i]);
        if (!value || *value < p.least || *value > p.most) return {};
        values[i] = *value;
    }
    if (two) return PixelStep{values[0], values[1]};
    return values[0];
}

} // namespace

void Parameters::addNumber(std::string name, double value, double least, double most, std::string unit) {
    const double inside = std::isnan(value) ? least : std::clamp(value, least, most);
    all_.push_back({std::move(name), inside, least, most, {}, std::move(unit)});
}

void Parameters::addPixels(std::string name, PixelStep value) {
    constexpr double kMost = 1 << 20;
    const PixelStep inside{std::clamp(value.x, 0., kMost), std::clamp(value.y, 0., kMost)};
    all_.push_back({std::move(name), inside, 0, kMost, {}, "px"});
}

void Parameters::addWord(std::string name, std::string value, std::vector<std::string> words) {
    all_.push_back({std::move(name), std::move(value), 0, 0, std::move(words), {}});
}

Result<void> Parameters::set(std::string_view name, std::string_view text) {
    for (Parameter& p : all_) {
        if (p.name != name) continue;
        auto value = parse(p, text);
        if (!value) return Error{allowed(p) + ", not \"" + std::string(text) + "\""};
        p.value = std::move(*value);
        ++version_;
        return {};
    }
    std::string known;
    for (const Parameter& p : all_) known += (known.empty() ? "" : ", ") + p.name;
    return Error{"there is no parameter \"" + std::string(name) +
                 (known.empty() ? "\"; this equalizer has none" : "\"; there are " + known)};
}

const Parameter* Parameters::find(std::string_view name) const {
    const auto found = std::find_if(all_.begin(), all_.end(), [&](const Parameter& p) { return p.name == name; });
    return found == all_.end() ? nullptr : &*found;
}

std::string textOf(const ParameterValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return numberText(*number);
    if (const auto* pixels = std::get_if<PixelStep>(&value)) return numberText(pixels->x) + " " + numberText(pixels->y);
    return std::get<std::string>(value);
}

} // namespace mural::balance
