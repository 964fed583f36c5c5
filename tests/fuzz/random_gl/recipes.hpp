// Several calls that make sense together: what random single calls hardly ever get right.
#pragma once

#include <span>

#include "tests/fuzz/random_gl/world.hpp"

namespace fuzz {

struct Recipe {
    const char* name;
    void (*cook)(World&);
    const char* profiles; // of c(ompat), k (core), 1 (ES 1), 3 (ES 3)
    int weight;
};

std::span<const Recipe> drawRecipes();
std::span<const Recipe> fixedRecipes();
std::span<const Recipe> imageRecipes();
std::span<const Recipe> objectRecipes();
std::span<const Recipe> programRecipes();

void calm(World& w);                 // state in which a draw shows something
void begin(World& w);                // of a context: arrays that point somewhere, a picture without chance in it
void clearAll(World& w);
void pointAll(World& w, bool buffered); // every vertex array of what is bound: none that is enabled lacks memory
void useAnyProgram(World& w);        // one of the pool's, with random uniforms
void useNoGeometryShader(World& w);  // before lists: Mesa draws line loops and strips of theirs that it does not take
void barrier(World& w);              // what shaders have written is there for all that reads: without it nothing is sure
bool drawsAnything(World& w);        // false: no vertex shader, where there is no other way. Undefined, and Mesa draws otherwise after it
void drawBuffered(World& w);         // with the current program, from arrays in a buffer
GLuint makeTexture(World& w, GLenum target); // with all its levels' contents; stays bound
GLenum anyTarget(World& w);
void observePixels(World& w, int x, int y, int width, int height, GLenum format, GLenum type);
void observeTargets(World& w);       // the picture: colour, and depth and stencil where they can be read
void dumpState(World& w);            // all that glGet* says, all objects' contents

} // namespace fuzz
