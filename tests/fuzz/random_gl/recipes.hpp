// Recipes: sequences of calls that belong together, which single random calls rarely form.
#pragma once

#include <span>

#include "tests/fuzz/random_gl/world.hpp"

namespace fuzz {

struct Recipe {
    const char* name;
    void (*cook)(World&);
    const char* profiles; // subset of c(ompat), k (core), 1 (ES 1), 3 (ES 3)
    int weight;
};

std::span<const Recipe> drawRecipes();
std::span<const Recipe> fixedRecipes();
std::span<const Recipe> imageRecipes();
std::span<const Recipe> objectRecipes();
std::span<const Recipe> programRecipes();

void calm(World& w);  // sets state in which a draw is visible
void begin(World& w); // prepares a context: arrays with valid pointers, and a defined picture
void clearAll(World& w);
void pointAll(World& w, bool buffered); // gives memory to every enabled vertex array
void useAnyProgram(World& w);           // uses a program of the pool, with random uniforms
// before lists: Mesa draws line loops and strips in them that geometry shaders do not accept
void useNoGeometryShader(World& w);
void barrier(World& w); // makes shader writes visible to all reads; otherwise results are undefined
// false: no vertex shader where one is required; undefined, and affects Mesa's later draws
bool drawsAnything(World& w);
void drawBuffered(World& w);                 // draws with the current program from arrays in a buffer
GLuint makeTexture(World& w, GLenum target); // fills all levels; stays bound
GLenum anyTarget(World& w);
void observePixels(World& w, int x, int y, int width, int height, GLenum format, GLenum type);
void observeTargets(World& w); // reads colour, and depth and stencil where readable
void dumpState(World& w);      // reads all state of glGet* and all objects' contents

} // namespace fuzz
