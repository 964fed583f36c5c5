// Numbers that test programs take from the environment.
#pragma once

#include <cstdlib>

namespace programs {

inline int numberOf(const char* name, int otherwise) {
    const char* const text = std::getenv(name);
    return text ? std::atoi(text) : otherwise;
}

} // namespace programs
