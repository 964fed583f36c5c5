// Levels of textures where a framebuffer has every nth pixel of the window only: GL chooses them by the distance to the next pixel that is drawn, which
// is n times as far. Lookups by desktop GLSL get the gradients of the window's pixels instead.
// Source: OpenGL 4.6, 8.14.1 (scale factor and level-of-detail); GL_ARB_shader_texture_lod.
#pragma once

#include <string>

#include "nodes/shaders/glsl_tokens.hpp"

namespace mural::shaders {

struct TextureLookups {
    std::string declarations; // functions to be declared, which read kPlaceUniform; empty: nothing is looked up
    std::string extension;    // that they need; empty: none
};

// Replaces the names of lookups in `edits`; those that choose no level, or have gradients, stay. ending: of the functions' names.
// Of ES texts, whose samplers have precisions that a function would have to know, none.
TextureLookups withWindowGradients(const GlslText& text, const std::string& ending, TextEdits& edits);

} // namespace mural::shaders
