// Valid programs of all GL versions for the random calls.
#pragma once

#include <vector>

#include "tests/fuzz/random_gl/world.hpp"

namespace fuzz {

struct Source {
    GLenum stage;
    const char* text;
};

struct PoolProgram {
    const char* profiles; // as in Recipe
    std::vector<Source> sources;
    const char* captured = nullptr; // varying of the transform feedback
    bool tessellates = false;
    bool counts = false; // counts its fragments in storage block 0
};

const std::vector<PoolProgram>& programPool();
const char* const* arbPrograms(); // vertex, fragment, ended by nullptr

} // namespace fuzz
