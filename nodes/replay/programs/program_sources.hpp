// Recipes: the inputs of a program's last link, for relinking it in another run. The node's half of program binaries
// (docs/reference/wire-format.md, "Recipes of programs"). One instance per share group. Names are this node's.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "gl_functions.hpp"

namespace mural {

struct ProgramSources {
    struct Shader {
        GLenum type = 0;
        std::string text;
    };
    struct Output {
        GLuint color = 0, index = 0;
    };
    bool separable = false;
    std::vector<Shader> shaders;
    std::map<std::string, Output> outputs; // explicit bindings
    GLenum varyingMode = 0;
    std::vector<std::string> varyings; // of transform feedback

    [[nodiscard]] std::vector<std::byte> toBytes() const;
    // Returns nothing for malformed bytes.
    static std::optional<ProgramSources> fromBytes(std::span<const std::byte> bytes);
};

class ProgramSourcesStore {
public:
    void source(GLuint shader, std::string text) { shaders_[shader].given = std::move(text); }
    // Call when the shader receives a SPIR-V module. Programs with it have no recipe.
    void forget(GLuint shader) { shaders_.erase(shader); }
    void compiled(const GlFunctions& gl, GLuint shader, bool withIncludes);
    void bindOutput(GLuint program, const char* name, const ProgramSources::Output& output) {
        programs_[program].next.outputs[name] = output;
    }
    void varyings(GLuint program, GLenum mode, std::vector<std::string> names);
    void separable(GLuint program, bool separable) { programs_[program].next.separable = separable; }
    void linked(const GlFunctions& gl, GLuint program);
    void linkedFrom(GLuint program, ProgramSources recipe);
    void deleted(const GlFunctions& gl, GLuint shaderOrProgram);
    // Returns the recipe of the last successful link; empty: none, or unsupported.
    [[nodiscard]] std::vector<std::byte> of(GLuint program) const;
    // Returns the same as a structure; null: none.
    [[nodiscard]] const ProgramSources* sourcesOf(GLuint program) const {
        const auto known = programs_.find(program);
        return known == programs_.end() || !known->second.last ? nullptr : &*known->second.last;
    }

private:
    struct Shader {
        GLenum type = 0;
        std::string given, compiled;
        bool withIncludes = false; // named strings (ARB_shading_language_include): the text alone is incomplete
    };
    struct Program {
        ProgramSources next;                // state for the next link
        std::optional<ProgramSources> last; // of the last successful link
    };
    std::unordered_map<GLuint, Shader> shaders_;
    std::unordered_map<GLuint, Program> programs_;
    std::set<GLuint> ending_; // deleted, but still attached or current
};

} // namespace mural
