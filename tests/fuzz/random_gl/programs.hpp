// Valid programs of all ages for the random calls.
#pragma once

#include <vector>

#include "tests/fuzz/random_gl/world.hpp"

namespace fuzz {

struct Source {
    GLenum stage;
    const char* text;
};

struct PoolProgram {
    const char* profiles; // as Recipe's
    std::vector<Source> sources;
    const char* captured = nullptr; // by transform feedback
    bool tessellates = false;
    bool counts = false; // its fragments, in storage block 0
};

const std::vector<PoolProgram>& programPool();
const char* const* arbPrograms(); // vertex, fragment, ended by nullptr

} // namespace fuzz
