// The words of attribute values. Where several stand for one integer, how an attribute's kind writes it.
#pragma once

#include <string>
#include <string_view>

#include "balancer/config/text/words.hpp"

namespace mural::config {

struct AttributeWord {
    std::string_view word;
    int32_t value;
    bool takesNumber = false; // CORE 2
    bool old = false;         // understood, and written in another way
};

// The numbers of SOCKET and CORE; above, they would be other attribute values.
inline constexpr int32_t kMostCores = 60'000;

// Null when nothing is called so.
const AttributeWord* findAttributeWord(std::string_view word);

std::string attributeText(int32_t value, AttributeKind kind);

} // namespace mural::config
