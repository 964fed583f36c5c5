// The words of attribute values, and the preferred word per attribute kind where several have the same integer.
#pragma once

#include <string>
#include <string_view>

#include "balancer/config/eqc/words.hpp"

namespace mural::config {

struct AttributeWord {
    std::string_view word;
    int32_t value;
    bool takesNumber = false; // a number follows: CORE 2
    bool old = false;         // accepted, but written in another way
};

// Largest number after SOCKET and CORE. Larger numbers would collide with other attribute values.
inline constexpr int32_t kMaxCores = 60'000;

// Returns null for an unknown word.
const AttributeWord* findAttributeWord(std::string_view word);

std::string attributeText(int32_t value, AttributeKind kind);

} // namespace mural::config
