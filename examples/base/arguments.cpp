#include "examples/base/arguments.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>

namespace mural::examples {

bool Arguments::takeFlag(std::string_view name) {
    const auto found = std::find(words_.begin(), words_.end(), name);
    if (found == words_.end()) return false;
    words_.erase(found);
    return true;
}

std::optional<std::string> Arguments::takeText(std::string_view name) {
    const auto found = std::find(words_.begin(), words_.end(), name);
    if (found == words_.end()) return std::nullopt;
    if (found + 1 == words_.end()) {
        fail(std::string(name) + " needs a value");
        words_.erase(found);
        return std::nullopt;
    }
    std::string value = std::move(*(found + 1));
    words_.erase(found, found + 2);
    return value;
}

double Arguments::takeNumber(std::string_view name, double otherwise, double lowest, double highest) {
    const std::optional<std::string> text = takeText(name);
    if (!text) return otherwise;
    double value = 0;
    const auto [end, problem] = std::from_chars(text->data(), text->data() + text->size(), value);
    if (problem == std::errc{} && end == text->data() + text->size() && value >= lowest && value <= highest)
        return value;
    const auto shown = [](double number) {
        std::string words = std::to_string(number);
        words.erase(words.find_last_not_of('0') + 1);
        if (words.back() == '.') words.pop_back();
        return words;
    };
    fail(std::string(name) + " needs a number from " + shown(lowest) + " to " + shown(highest) + ", not \"" + *text +
         "\"");
    return otherwise;
}

Result<std::vector<std::string>> Arguments::finish() {
    for (const std::string& word : words_) {
        if (word.size() > 1 && word.front() == '-') fail("there is no option " + word);
    }
    if (!problem_.empty()) return Error{problem_ + "; --help lists the options"};
    return words_;
}

void Arguments::fail(const std::string& problem) {
    if (problem_.empty()) problem_ = problem;
}

Result<std::array<float, 3>> parseColour(std::string_view text) {
    uint32_t rgb = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), rgb, 16);
    if (text.size() != 6 || problem != std::errc{} || end != text.data() + text.size())
        return Error{"\"" + std::string(text) + "\" is no colour such as ff8000"};
    std::array<float, 3> colour{};
    for (size_t k = 0; k < 3; ++k) colour[k] = static_cast<float>(rgb >> (16 - 8 * k) & 0xff) / 255;
    return colour;
}

bool isHelpWanted(int argc, char** argv) {
    return argc == 2 && (std::string_view(argv[1]) == "--help" || std::string_view(argv[1]) == "-h");
}

} // namespace mural::examples
