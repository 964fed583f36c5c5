// GLSL programs whose shaders are rewritten for a tile: which text each shader object is compiled from,
// and the values of the uniforms that came in. One for all contexts that share. Names are this node's.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "gl_functions.hpp"
#include "nodes/replay/tiling.hpp"

namespace mural {

class TiledPrograms {
public:
    // Instead of glCompileShader: the text is kept and compiled when a link shows what it must be.
    void compile(const GlFunctions& gl, GLuint shader);
    // The shader holds a module now, or was compiled in another way: never rewritten.
    void forget(GLuint shader) { shaders_.erase(shader); }
    // Instead of glLinkProgram. What does not compile or link rewritten is linked as it was.
    void link(const GlFunctions& gl, GLuint program, const ShaderRewrites& rewrites, bool es);
    // Instead of glCreateShaderProgramv.
    GLuint create(const GlFunctions& gl, GLenum type, GLsizei count, const GLchar* const* texts, const ShaderRewrites& rewrites, bool es);
    // Makes `program`, which is current, have these values.
    void apply(const GlFunctions& gl, GLuint program, const TileValues& values);
    // The same for all that may be in pipelines.
    void applySeparable(const GlFunctions& gl, const TileValues& values);
    // GL_PROGRAM_SEPARABLE for the next link.
    void setSeparable(GLuint program, bool separable);

private:
    struct Shader {
        GLenum type = 0;
        std::string text;     // that the program has compiled
        std::string compiled; // that the object now holds; empty: not compiled yet
    };
    struct Program {
        GLint cull = -1, place = -1, move = -1; // locations
        bool separable = false;
        TileValues sent;              // zeros, as after a link
    };
    struct Part {
        GLuint shader;
        std::string wanted; // the rewritten text; empty: the program's own
        bool lastStage;     // by which rewriting
    };

    std::vector<Part> rewritten(const GlFunctions& gl, GLuint program, const ShaderRewrites& rewrites, bool es);
    bool holds(const GlFunctions& gl, GLuint shader, const std::string& text);
    bool linkParts(const GlFunctions& gl, GLuint program, std::vector<Part>& parts);
    void remember(const GlFunctions& gl, GLuint program, bool separable);

    std::unordered_map<GLuint, Shader> shaders_;
    std::unordered_map<GLuint, Program> programs_; // those with uniforms of ours
    std::unordered_map<GLuint, bool> separable_;
};

} // namespace mural
