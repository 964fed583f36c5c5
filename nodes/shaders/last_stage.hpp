// Inserts code after each vertex of the last stage before the rasteriser: after main(), or before each EmitVertex of a
// geometry shader.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nodes/shaders/glsl_tokens.hpp"

namespace mural::shaders {

enum class LastStage { Vertex, TessEvaluation, Geometry };

struct VertexCode {
    // Called for the text with main(). `sized`: some text of the stage writes gl_PointSize.
    std::function<std::string(const GlslText&)> declarations;
    std::function<std::string(const GlslText&, bool sized)> body;
    std::function<void(const GlslText&, TextEdits&)> more; // further edits; may be empty
    std::function<bool(const GlslText&)> allowed;          // false: do not change the stage
};

// es: in an ES context. `sources`: all texts of the stage; one contains main(). Returns as many texts, or nothing if
// the stage must not change (not allowed, several streams, names from macros).
std::optional<std::vector<std::string>> withVertexCode(const std::vector<std::string>& sources, LastStage stage,
                                                       bool es, const VertexCode& code);

} // namespace mural::shaders
