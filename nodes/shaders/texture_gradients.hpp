// Texture levels for framebuffers with every nth pixel. GL selects levels by the distance to the next drawn pixel,
// which is n times too large. Rewritten desktop GLSL passes the gradients of window pixels to lookups. Source: OpenGL
// 4.6, 8.14.1 (scale factor and level-of-detail); GL_ARB_shader_texture_lod.
#pragma once

#include <string>

#include "nodes/shaders/glsl_tokens.hpp"

namespace mural::shaders {

struct TextureLookups {
    std::string declarations; // added functions, which read kPlaceUniform; empty: no lookups
    std::string extension;    // required extension; empty: none
};

// Replaces the names of lookups in `edits`, except lookups without level selection or with explicit gradients. ending:
// the suffix of added names. ES texts are not rewritten: functions would have to declare their samplers' precisions.
TextureLookups withWindowGradients(const GlslText& text, const std::string& ending, TextEdits& edits);

} // namespace mural::shaders
