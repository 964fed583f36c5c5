// Program binaries. A driver's binary is useless to other drivers. The interposer therefore requests the recipe of the
// program and stores it with the binary. It sends the recipe back when the program loads the binary.
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

// ---- inputs of a link, recorded before they reach GL

void Replay::glShaderSource(GLuint shader, GLsizei count, const Data& string) {
    StringList texts;
    if (!texts.parse(string, count) || texts.count() == 0) return;
    const GLuint nodeName = name(Kind::Program, shader);
    gl.glShaderSource(nodeName, count, texts.pointers(), texts.lengths());
    if (c_->shared) c_->shared->recipes.source(nodeName, texts.joined());
}
void Replay::glBindFragDataLocation(GLuint program, GLuint color, const Data& text) {
    const GLuint nodeName = name(Kind::Program, program);
    if (gl.glBindFragDataLocation) gl.glBindFragDataLocation(nodeName, color, text.as<GLchar>());
    if (c_->shared) c_->shared->recipes.bindOutput(nodeName, text.as<GLchar>(), {color, 0});
}
void Replay::glBindFragDataLocationIndexed(GLuint program, GLuint colorNumber, GLuint index, const Data& text) {
    const GLuint nodeName = name(Kind::Program, program);
    if (gl.glBindFragDataLocationIndexed)
        gl.glBindFragDataLocationIndexed(nodeName, colorNumber, index, text.as<GLchar>());
    if (c_->shared) c_->shared->recipes.bindOutput(nodeName, text.as<GLchar>(), {colorNumber, index});
}
void Replay::glTransformFeedbackVaryings(GLuint program, GLsizei count, const Data& varyings, GLenum bufferMode) {
    StringList texts;
    if (!texts.parse(varyings, count) || !gl.glTransformFeedbackVaryings) return;
    const GLuint nodeName = name(Kind::Program, program);
    gl.glTransformFeedbackVaryings(nodeName, count, texts.pointers(), bufferMode);
    if (c_->shared)
        c_->shared->recipes.varyings(nodeName, bufferMode, {texts.pointers(), texts.pointers() + texts.count()});
}
void Replay::glDeleteShader(GLuint shader) {
    if (!gl.glDeleteShader) return;
    const GLuint nodeName = name(Kind::Program, shader);
    gl.glDeleteShader(nodeName);
    if (c_->shared) c_->shared->recipes.deleted(gl, nodeName);
}
void Replay::glDeleteProgram(GLuint program) {
    if (!gl.glDeleteProgram) return;
    const GLuint nodeName = name(Kind::Program, program);
    gl.glDeleteProgram(nodeName);
    if (!c_->shared) return;
    c_->shared->recipes.deleted(gl, nodeName);
    c_->shared->primitiveIds.erase(nodeName); // drivers may reuse the name, on some nodes only
}
void Replay::glDeleteObjectARB(GLuint obj) {
    const GLuint nodeName = name(Kind::Program, obj);
    if (gl.glDeleteObjectARB) gl.glDeleteObjectARB(nodeName);
    if (!c_->shared) return;
    c_->shared->recipes.deleted(gl, nodeName);
    c_->shared->primitiveIds.erase(nodeName);
}

// ---- requests and replies

bool Replay::onRequestProgram(Args& in) {
    const auto request = in.get<uint32_t>(), program = in.get<uint32_t>();
    if (!in.ok()) return false;
    answerBytes(request, wire::ReplyKind::Bytes,
                c_->shared ? c_->shared->recipes.of(name(Kind::Program, program)) : std::vector<std::byte>{});
    return true;
}

bool Replay::onProgramRecipe(Args& in) {
    const auto program = in.get<uint32_t>();
    const Data bytes = in.data();
    if (!in.ok()) return false;
    if (!bound_ || !c_->shared || !gl.glGetAttachedShaders || !gl.glCreateShader) return true;
    const GLuint nodeName = name(Kind::Program, program);
    if (auto recipe = ProgramSources::fromBytes(bytes.span())) linkFrom(nodeName, std::move(*recipe));
    // the program is no longer linked
    else if (gl.glProgramBinary)
        gl.glProgramBinary(nodeName, GL_PROGRAM_BINARY_FORMAT_MESA, "", 0);
    onModules(nodeName);
    applyTileValues(); // it may be the current program
    return true;
}

// Links from the recipe's shaders, and restores the program's attached shaders.
void Replay::linkFrom(GLuint nodeName, ProgramSources recipe) {
    GLuint attached[64] = {};
    GLsizei count = 0;
    gl.glGetAttachedShaders(nodeName, 64, &count, attached);
    for (GLsizei i = 0; i < count; ++i) gl.glDetachShader(nodeName, attached[i]);
    std::vector<GLuint> made;
    for (const ProgramSources::Shader& s : recipe.shaders) {
        const GLuint shader = made.emplace_back(gl.glCreateShader(s.type));
        const GLchar* text = s.text.c_str();
        const auto length = static_cast<GLint>(s.text.size());
        gl.glShaderSource(shader, 1, &text, &length);
        compileShader(shader);
        gl.glAttachShader(nodeName, shader);
    }
    std::vector<const GLchar*> varyings;
    for (const std::string& v : recipe.varyings) varyings.push_back(v.c_str());
    if (gl.glTransformFeedbackVaryings && recipe.varyingMode)
        gl.glTransformFeedbackVaryings(nodeName, static_cast<GLsizei>(varyings.size()), varyings.data(),
                                       recipe.varyingMode);
    for (const auto& [text, output] : recipe.outputs) {
        if (gl.glBindFragDataLocationIndexed)
            gl.glBindFragDataLocationIndexed(nodeName, output.color, output.index, text.c_str());
        else if (gl.glBindFragDataLocation)
            gl.glBindFragDataLocation(nodeName, output.color, text.c_str());
    }
    if (gl.glProgramParameteri) gl.glProgramParameteri(nodeName, GL_PROGRAM_SEPARABLE, recipe.separable);
    c_->shared->tiled.setSeparable(nodeName, recipe.separable);
    linkProgram(nodeName);
    for (const GLuint shader : made) {
        gl.glDetachShader(nodeName, shader);
        gl.glDeleteShader(shader);
    }
    for (GLsizei i = 0; i < count; ++i) gl.glAttachShader(nodeName, attached[i]);
    c_->shared->recipes.linkedFrom(nodeName, std::move(recipe));
}

} // namespace mural
