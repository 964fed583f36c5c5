// Parses the values of command line options: numbers, pairs, lists, choices. An error names the option, its value and
// the values that it accepts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/result.hpp"

namespace mural::cli {

using OptionText = std::optional<std::string>; // empty: the option was not given

// Parse the whole text. Empty: no number, or out of range.
[[nodiscard]] std::optional<int64_t> wholeNumber(std::string_view text, int64_t lowest, int64_t highest);
[[nodiscard]] std::optional<double> realNumber(std::string_view text, double lowest, double highest);

// Parses two numbers, such as 2x2.
[[nodiscard]] std::optional<std::pair<int, int>> pairOf(std::string_view text, char separator, int lowest, int highest);

// Splits at commas.
[[nodiscard]] std::vector<std::string> listOf(const std::string& text);

// `wanted`: describes the accepted values, such as "must be a file".
[[nodiscard]] Error badValue(std::string_view option, std::string_view value, std::string_view wanted);

// Read an option into `into`, which stays unchanged without the option.
Result<void> readNumber(std::string_view option, const OptionText& text, int64_t lowest, int64_t highest,
                        int64_t& into);
Result<void> readCount(std::string_view option, const OptionText& text, int highest, int& into); // from 1
Result<void> readReal(std::string_view option, const OptionText& text, double lowest, double& into);

template <class E> struct Choice {
    const char* name;
    E value;
};

// Reads one of several names, as the other functions do.
template <class E, size_t N>
Result<void> choose(std::string_view option, const OptionText& text, const Choice<E> (&choices)[N], E& into) {
    if (!text) return {};
    std::string names;
    for (const auto& choice : choices) {
        if (*text == choice.name) {
            into = choice.value;
            return {};
        }
        names += names.empty() ? "" : ", ";
        names += choice.name;
    }
    return badValue(option, *text, "must be one of " + names);
}

} // namespace mural::cli
