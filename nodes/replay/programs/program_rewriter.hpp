// GLSL programs with shaders rewritten for a tile: the text from which each shader object is compiled, and the values
// of the added uniforms. One instance per share group. Names are this node's.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "gl_functions.hpp"
#include "nodes/replay/programs/tiling.hpp"

namespace mural {

class ProgramRewriter {
public:
    // Replaces glCompileShader: stores the text and compiles it when a link determines the rewriting.
    void compile(const GlFunctions& gl, GLuint shader);
    // Call when the shader receives a SPIR-V module or is compiled by another command. It is then never rewritten.
    void forget(GLuint shader) { shaders_.erase(shader); }
    // Replaces glLinkProgram. Links the original shaders if the rewritten ones do not compile or link.
    void link(const GlFunctions& gl, GLuint program, const ShaderRewrites& rewrites, bool es);
    // Replaces glCreateShaderProgramv.
    GLuint create(const GlFunctions& gl, GLenum type, GLsizei count, const GLchar* const* texts,
                  const ShaderRewrites& rewrites, bool es);
    // Sets the uniforms of `program`, which must be current.
    void apply(const GlFunctions& gl, GLuint program, const TileValues& values);
    // Sets the uniforms in all separable programs.
    void applySeparable(const GlFunctions& gl, const TileValues& values);
    // GL_PROGRAM_SEPARABLE for the next link.
    void setSeparable(GLuint program, bool separable);

private:
    struct Shader {
        GLenum type = 0;
        std::string text;     // the program's source
        std::string compiled; // the compiled source; empty: not compiled yet
    };
    struct Program {
        GLint cull = -1, place = -1, move = -1; // uniform locations
        bool separable = false;
        TileValues sent; // zeros, as after a link
    };
    struct Part {
        GLuint shader;
        std::string wanted; // the rewritten text; empty: the original
        bool lastStage;     // rewritten as the last stage
    };

    std::vector<Part> rewritten(const GlFunctions& gl, GLuint program, const ShaderRewrites& rewrites, bool es);
    bool compiles(const GlFunctions& gl, GLuint shader, const std::string& text);
    bool linkParts(const GlFunctions& gl, GLuint program, std::vector<Part>& parts);
    void remember(const GlFunctions& gl, GLuint program, bool separable);

    std::unordered_map<GLuint, Shader> shaders_;
    std::unordered_map<GLuint, Program> programs_; // programs with added uniforms
    std::unordered_map<GLuint, bool> separable_;
};

} // namespace mural
