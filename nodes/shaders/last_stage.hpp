// Code that runs after each vertex of the last stage before the rasteriser: behind main(), or before each
// EmitVertex of a geometry shader.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nodes/shaders/glsl_tokens.hpp"

namespace mural::shaders {

enum class LastStage { Vertex, TessEvaluation, Geometry };

struct VertexCode {
    // Per text of the stage that holds main(); `sized`: some text of the stage sets gl_PointSize.
    std::function<std::string(const GlslText&)> declarations;
    std::function<std::string(const GlslText&, bool sized)> body;
    std::function<void(const GlslText&, TextEdits&)> more; // further edits; may be empty
    std::function<bool(const GlslText&)> allowed;          // false: the stage stays as it is
};

// es: in an ES context. `sources`: all texts of that stage, of which one holds main(). The same number comes back;
// nothing when the stage must stay as it is (not allowed, several streams, names that only macros give).
std::optional<std::vector<std::string>> withVertexCode(const std::vector<std::string>& sources, LastStage stage, bool es, const VertexCode& code);

} // namespace mural::shaders
