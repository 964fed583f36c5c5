// Where in a file something was said: line and column, from 1. 0: nowhere, it was made by a program.
#pragma once

#include <cstdint>

namespace mural::config {

struct SourcePosition {
    int32_t line = 0;
    int32_t column = 0;
    // Where a thing stands is no part of what it is: two configurations that say the same are equal.
    friend constexpr bool operator==(SourcePosition, SourcePosition) { return true; }
};

} // namespace mural::config
