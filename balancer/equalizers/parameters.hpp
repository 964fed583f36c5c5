// Named, typed and bounded parameters of an equalizer that can change while a session runs.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/base/result.hpp"

namespace mural::balance {

struct PixelStep {
    double x = 0;
    double y = 0;
    friend bool operator==(const PixelStep&, const PixelStep&) = default;
};

// A number, a pair of pixel counts, or one word of a list.
using ParameterValue = std::variant<double, PixelStep, std::string>;

struct Parameter {
    std::string name;
    ParameterValue value;
    double least = 0; // limits of numbers and of both pixel counts; inclusive
    double most = std::numeric_limits<double>::infinity();
    std::vector<std::string> words; // permitted words
    std::string unit;               // "Hz", "px"; empty: none
};

class Parameters {
public:
    // Values outside the limits are moved to the nearest limit.
    void addNumber(std::string name, double value, double least, double most, std::string unit = {});
    void addPixels(std::string name, PixelStep value);
    void addWord(std::string name, std::string value, std::vector<std::string> words);

    // Sets a parameter from text: "0.5", "16 16", "2D". The error names the permitted values; the value stays.
    Result<void> set(std::string_view name, std::string_view text);

    // Require that the parameter exists with this type.
    [[nodiscard]] double number(std::string_view name) const { return std::get<double>(find(name)->value); }
    [[nodiscard]] PixelStep pixels(std::string_view name) const { return std::get<PixelStep>(find(name)->value); }
    [[nodiscard]] const std::string& word(std::string_view name) const {
        return std::get<std::string>(find(name)->value);
    }
    [[nodiscard]] const Parameter* find(std::string_view name) const;
    [[nodiscard]] const std::vector<Parameter>& all() const { return all_; }
    [[nodiscard]] uint32_t version() const { return version_; } // changes with every change of a value

private:
    std::vector<Parameter> all_;
    uint32_t version_ = 0;
};

// Returns a value as set() accepts it.
std::string textOf(const ParameterValue& value);

} // namespace mural::balance
