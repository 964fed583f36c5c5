#include "tools/mural/run/option_values.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>

namespace mural::cli {

std::optional<int64_t> wholeNumber(std::string_view text, int64_t lowest, int64_t highest) {
    int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < lowest || value > highest) return {};
    return value;
}

std::optional<std::pair<int, int>> pairOf(std::string_view text, char separator, int lowest, int highest) {
    const auto at = text.find(separator);
    if (at == std::string_view::npos) return {};
    const auto first = wholeNumber(text.substr(0, at), lowest, highest);
    const auto second = wholeNumber(text.substr(at + 1), lowest, highest);
    if (!first || !second) return {};
    return std::pair(static_cast<int>(*first), static_cast<int>(*second));
}

std::vector<std::string> listOf(const std::string& text) {
    std::vector<std::string> parts;
    size_t at = 0;
    while (at <= text.size()) {
        const size_t end = std::min(text.find(',', at), text.size());
        parts.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return parts;
}

Error badValue(std::string_view option, std::string_view value, std::string_view wanted) {
    return Error{fmt::format("{} \"{}\": {}", option, value, wanted)};
}

Result<void> readNumber(std::string_view option, const OptionText& text, int64_t lowest, int64_t highest,
                        int64_t& into) {
    if (!text) return {};
    const auto value = wholeNumber(*text, lowest, highest);
    if (!value && highest >= INT32_MAX)
        return badValue(option, *text, fmt::format("must be a whole number, at least {}", lowest));
    if (!value) return badValue(option, *text, fmt::format("must be a whole number from {} to {}", lowest, highest));
    into = *value;
    return {};
}

std::optional<double> realNumber(std::string_view text, double lowest, double highest) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool read = error == std::errc() && end == text.data() + text.size();
    return read && value >= lowest && value <= highest ? std::optional(value) : std::nullopt;
}

Result<void> readReal(std::string_view option, const OptionText& text, double lowest, double& into) {
    if (!text) return {};
    const auto value = realNumber(*text, lowest, 1e9);
    if (!value)
        return badValue(option, *text,
                        fmt::format("must be a number, at least {}, in the program's units, such as 0.5", lowest));
    into = *value;
    return {};
}

Result<void> readCount(std::string_view option, const OptionText& text, int highest, int& into) {
    int64_t value = into;
    if (auto r = readNumber(option, text, 1, highest, value); !r) return r;
    into = static_cast<int>(value);
    return {};
}

} // namespace mural::cli
