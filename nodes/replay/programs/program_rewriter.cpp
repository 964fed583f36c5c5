#include "nodes/replay/programs/program_rewriter.hpp"

#include <algorithm>

#include "nodes/replay/programs/attached_shaders.hpp"
#include "nodes/shaders/cull_distances.hpp"
#include "nodes/shaders/frag_coord.hpp"
#include "nodes/shaders/moved_position.hpp"

namespace mural {

namespace {

std::string sourceOf(const GlFunctions& gl, GLuint shader) {
    GLint length = 0;
    gl.glGetShaderiv(shader, GL_SHADER_SOURCE_LENGTH, &length);
    if (length <= 1) return {};
    std::string text(static_cast<size_t>(length), '\0');
    GLsizei written = 0;
    gl.glGetShaderSource(shader, length, &written, text.data());
    text.resize(static_cast<size_t>(std::clamp(written, 0, length - 1)));
    return text;
}

void setSource(const GlFunctions& gl, GLuint shader, const std::string& text) {
    const GLchar* pointer = text.c_str();
    const auto length = static_cast<GLint>(text.size());
    gl.glShaderSource(shader, 1, &pointer, &length);
}

shaders::FragmentReads fragmentReads(const ShaderRewrites& rewrites) {
    return {rewrites.windowCoordinates, rewrites.windowDerivatives, rewrites.windowGradients};
}

bool linked(const GlFunctions& gl, GLuint program) {
    GLint status = 0;
    gl.glGetProgramiv(program, GL_LINK_STATUS, &status);
    return status != 0;
}

} // namespace

void ProgramRewriter::compile(const GlFunctions& gl, GLuint shader) {
    GLint type = 0;
    gl.glGetShaderiv(shader, GL_SHADER_TYPE, &type);
    Shader& s = shaders_[shader];
    s.type = static_cast<GLenum>(type);
    s.text = sourceOf(gl, shader);
    s.compiled.clear();
    if (s.text.empty()) gl.glCompileShader(shader); // without a text the driver raises the program's error
}

// Compiles `shader` from `text` unless it already is. Keeps the source that the program has set.
bool ProgramRewriter::compiles(const GlFunctions& gl, GLuint shader, const std::string& text) {
    Shader& s = shaders_[shader];
    if (s.compiled != text) {
        const std::string now = sourceOf(gl, shader);
        if (now != text) setSource(gl, shader, text);
        gl.glCompileShader(shader);
        if (now != text) setSource(gl, shader, now);
        s.compiled = text;
    }
    GLint status = 0;
    gl.glGetShaderiv(shader, GL_COMPILE_STATUS, &status);
    return status != 0;
}

std::vector<ProgramRewriter::Part> ProgramRewriter::rewritten(const GlFunctions& gl, GLuint program,
                                                              const ShaderRewrites& rewrites, bool es) {
    std::vector<Part> parts;
    GLenum last = 0; // in pipeline order
    const auto place = [](GLenum type) {
        return type == GL_GEOMETRY_SHADER          ? 3
               : type == GL_TESS_EVALUATION_SHADER ? 2
               : type == GL_VERTEX_SHADER          ? 1
                                                   : 0;
    };
    for (const GLuint shader : attachedShaders(gl, program)) {
        const auto it = shaders_.find(shader);
        if (it == shaders_.end() || it->second.text.empty()) continue;
        parts.push_back({shader, {}, false});
        if (place(it->second.type) > place(last)) last = it->second.type;
        if (it->second.type == GL_FRAGMENT_SHADER)
            parts.back().wanted = shaders::withWindowOffset(it->second.text, fragmentReads(rewrites), es).value_or("");
    }
    const auto separable = separable_.find(program);
    // The stage after a separable one may be in another program, which must declare the same block.
    if (!(rewrites.cull || rewrites.moved) || !last || (separable != separable_.end() && separable->second))
        return parts;
    std::vector<std::string> texts;
    for (const Part& p : parts) {
        if (shaders_[p.shader].type == last) texts.push_back(shaders_[p.shader].text);
    }
    const auto stage = last == GL_VERTEX_SHADER     ? shaders::LastStage::Vertex
                       : last == GL_GEOMETRY_SHADER ? shaders::LastStage::Geometry
                                                    : shaders::LastStage::TessEvaluation;
    const auto patched =
        rewrites.moved ? shaders::withMovedPosition(texts, stage, es) : shaders::withCullDistances(texts, stage, es);
    size_t next = 0;
    for (Part& p : parts) {
        if (!patched || shaders_[p.shader].type != last) continue;
        p.lastStage = (*patched)[next] != texts[next];
        if (p.lastStage) p.wanted = (*patched)[next];
        ++next;
    }
    return parts;
}

// Returns false if a rewritten shader prevents linking.
bool ProgramRewriter::linkParts(const GlFunctions& gl, GLuint program, std::vector<Part>& parts) {
    bool any = false, compiled = true;
    for (const Part& p : parts) {
        const bool ok = compiles(gl, p.shader, p.wanted.empty() ? shaders_[p.shader].text : p.wanted);
        any = any || !p.wanted.empty();
        compiled = compiled && (ok || p.wanted.empty());
    }
    if (!compiled) return false;
    gl.glLinkProgram(program);
    return !any || linked(gl, program);
}

void ProgramRewriter::link(const GlFunctions& gl, GLuint program, const ShaderRewrites& rewrites, bool es) {
    programs_.erase(program);
    std::vector<Part> parts = rewritten(gl, program, rewrites, es);
    if (!linkParts(gl, program, parts)) {
        const bool both = std::any_of(parts.begin(), parts.end(), [](const Part& p) { return p.lastStage; });
        for (Part& p : parts) {
            if (p.lastStage || !both) p.wanted.clear();
        }
        if (!linkParts(gl, program, parts)) { // also without the rewritten coordinates
            for (Part& p : parts) p.wanted.clear();
            linkParts(gl, program, parts);
        }
    }
    const bool any = std::any_of(parts.begin(), parts.end(), [](const Part& p) { return !p.wanted.empty(); });
    const auto separable = separable_.find(program);
    if (any) remember(gl, program, separable != separable_.end() && separable->second);
}

void ProgramRewriter::remember(const GlFunctions& gl, GLuint program, bool separable) {
    Program p;
    p.cull = gl.glGetUniformLocation(program, shaders::kCullUniform);
    p.place = gl.glGetUniformLocation(program, shaders::kPlaceUniform);
    p.move = gl.glGetUniformLocation(program, shaders::kMoveUniform);
    p.separable = separable;
    if (p.cull >= 0 || p.place >= 0 || p.move >= 0) programs_[program] = p;
}

GLuint ProgramRewriter::create(const GlFunctions& gl, GLenum type, GLsizei count, const GLchar* const* texts,
                               const ShaderRewrites& rewrites, bool es) {
    if (rewrites.place() && type == GL_FRAGMENT_SHADER) {
        std::string all;
        for (GLsizei i = 0; i < count; ++i) all += texts[i];
        if (const auto patched = shaders::withWindowOffset(all, fragmentReads(rewrites), es)) {
            const GLchar* text = patched->c_str();
            const GLuint program = gl.glCreateShaderProgramv(type, 1, &text);
            if (program && linked(gl, program)) {
                remember(gl, program, true);
                return program;
            }
            gl.glDeleteProgram(program);
        }
    }
    const GLuint program = gl.glCreateShaderProgramv(type, count, texts);
    programs_.erase(program);
    return program;
}

void ProgramRewriter::apply(const GlFunctions& gl, GLuint program, const TileValues& values) {
    const auto it = programs_.find(program);
    if (it == programs_.end()) return;
    Program& p = it->second;
    if (p.cull >= 0 && p.sent.cull != values.cull) gl.glUniform4fv(p.cull, 2, values.cull.data());
    if (p.place >= 0 && p.sent.place != values.place) gl.glUniform4fv(p.place, 2, values.place.data());
    if (p.move >= 0 && p.sent.move != values.move)
        gl.glUniform4fv(p.move, static_cast<GLsizei>(values.move.size() / 4), values.move.data());
    p.sent = values;
}

void ProgramRewriter::applySeparable(const GlFunctions& gl, const TileValues& values) {
    if (!gl.glProgramUniform4fv) return;
    for (auto& [program, p] : programs_) {
        if (!p.separable) continue;
        if (p.place >= 0 && p.sent.place != values.place)
            gl.glProgramUniform4fv(program, p.place, 2, values.place.data());
        p.sent.place = values.place;
    }
}

void ProgramRewriter::setSeparable(GLuint program, bool separable) { separable_[program] = separable; }

} // namespace mural
