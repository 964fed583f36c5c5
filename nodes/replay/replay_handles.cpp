// Textures and images without a binding (ARB_bindless_texture): the program's handles, which its own driver has dealt, are
// mapped to those of this node's wherever a command names them. What shaders take out of memory nobody sees: there a
// handle is right when both drivers deal the same (docs/decisions/0006-handles-of-textures.md).
#include <cinttypes>
#include <cstdio>
#include <vector>

#include "gl_opcodes.hpp"
#include "nodes/replay/replay.hpp"

namespace mural {

namespace {

bool isImageType(GLint type) { return type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY; }

} // namespace

// ---- what is dealt

void Replay::dealtHandle(HandleTable::Of of, uint64_t theirs, uint64_t ours) {
    if (!c_->shared || c_->shared->handles.set(of, theirs, ours)) return;
    char text[512];
    snprintf(text, sizeof text,
             "this node's driver deals other handles of textures than the program's (0x%" PRIx64 " for 0x%" PRIx64 "): what shaders take out of buffers, vertex arrays or "
             "whole numbers may be wrong on this node's tiles; let the program and its nodes use the same driver",
             ours, theirs);
    out_.log(text);
}

void Replay::glGetTextureHandleARB(GLuint texture, uint64_t result) {
    if (!gl.glGetTextureHandleARB) return (void)lacking(op::glGetTextureHandleARB);
    dealtHandle(HandleTable::Of::Texture, result, gl.glGetTextureHandleARB(name(Kind::Texture, texture)));
}
void Replay::glGetTextureSamplerHandleARB(GLuint texture, GLuint sampler, uint64_t result) {
    if (!gl.glGetTextureSamplerHandleARB) return (void)lacking(op::glGetTextureSamplerHandleARB);
    dealtHandle(HandleTable::Of::Texture, result, gl.glGetTextureSamplerHandleARB(name(Kind::Texture, texture), name(Kind::Sampler, sampler)));
}
void Replay::glGetImageHandleARB(GLuint texture, GLint level, GLboolean layered, GLint layer, GLenum format, uint64_t result) {
    if (!gl.glGetImageHandleARB) return (void)lacking(op::glGetImageHandleARB);
    dealtHandle(HandleTable::Of::Image, result, gl.glGetImageHandleARB(name(Kind::Texture, texture), level, layered, layer, format));
}

// ---- residency: of a handle that nobody has dealt it is an error, which the program has been told

void Replay::glMakeTextureHandleResidentARB(GLuint64 handle) {
    const uint64_t ours = c_->shared ? c_->shared->handles.find(HandleTable::Of::Texture, handle) : 0;
    if (ours && gl.glMakeTextureHandleResidentARB) gl.glMakeTextureHandleResidentARB(ours);
}
void Replay::glMakeTextureHandleNonResidentARB(GLuint64 handle) {
    const uint64_t ours = c_->shared ? c_->shared->handles.find(HandleTable::Of::Texture, handle) : 0;
    if (ours && gl.glMakeTextureHandleNonResidentARB) gl.glMakeTextureHandleNonResidentARB(ours);
}
void Replay::glMakeImageHandleResidentARB(GLuint64 handle, GLenum access) {
    const uint64_t ours = c_->shared ? c_->shared->handles.find(HandleTable::Of::Image, handle) : 0;
    if (!ours || !gl.glMakeImageHandleResidentARB) return;
    c_->writesMemory = c_->writesMemory || access != GL_READ_ONLY;
    gl.glMakeImageHandleResidentARB(ours, access);
}
void Replay::glMakeImageHandleNonResidentARB(GLuint64 handle) {
    const uint64_t ours = c_->shared ? c_->shared->handles.find(HandleTable::Of::Image, handle) : 0;
    if (ours && gl.glMakeImageHandleNonResidentARB) gl.glMakeImageHandleNonResidentARB(ours);
}

// ---- values

// By the type of the uniform of our program at our location; asked for only where handles differ.
HandleTable::Of Replay::handlesOfUniform(GLuint program, GLint location) const {
    GLint count = 0;
    if (program) gl.glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
    for (GLint i = 0; i < count; ++i) {
        GLchar text[512] = "";
        GLint size = 0;
        GLenum type = 0;
        gl.glGetActiveUniform(program, static_cast<GLuint>(i), sizeof text, nullptr, &size, &type, text);
        const GLint first = gl.glGetUniformLocation(program, text);
        if (first < 0 || location < first || location >= first + size) continue;
        return isImageType(static_cast<GLint>(type)) ? HandleTable::Of::Image : HandleTable::Of::Texture;
    }
    return HandleTable::Of::Texture;
}

// The values as this node's handles; the location is ours.
std::vector<GLuint64> Replay::handleValues(GLuint program, GLint location, const GLuint64* values, GLsizei count) const {
    std::vector<GLuint64> ours(static_cast<size_t>(count));
    std::memcpy(ours.data(), values, ours.size() * sizeof(GLuint64)); // records are aligned to 4 bytes
    if (!c_->shared || !c_->shared->handles.differ()) return ours;
    const HandleTable::Of of = handlesOfUniform(program, location);
    for (GLuint64& value : ours) value = c_->shared->handles.value(of, value);
    return ours;
}

void Replay::glUniformHandleui64ARB(GLint location, GLuint64 value) {
    if (!gl.glUniformHandleui64ARB) return (void)lacking(op::glUniformHandleui64ARB);
    const GLint at = uniformLocation(location);
    gl.glUniformHandleui64ARB(at, handleValues(name(Kind::Program, c_->program), at, &value, 1)[0]);
}
void Replay::glUniformHandleui64vARB(GLint location, GLsizei count, const Data& value) {
    if (!gl.glUniformHandleui64vARB) return (void)lacking(op::glUniformHandleui64vARB);
    if (count <= 0 || value.size() < size_t{8} * static_cast<size_t>(count)) return;
    const GLint at = uniformLocation(location);
    gl.glUniformHandleui64vARB(at, count, handleValues(name(Kind::Program, c_->program), at, value.as<GLuint64>(), count).data());
}
void Replay::glProgramUniformHandleui64ARB(GLuint program, GLint location, GLuint64 value) {
    if (!gl.glProgramUniformHandleui64ARB) return (void)lacking(op::glProgramUniformHandleui64ARB);
    const GLuint ours = name(Kind::Program, program);
    const GLint at = uniformLocation(program, location);
    gl.glProgramUniformHandleui64ARB(ours, at, handleValues(ours, at, &value, 1)[0]);
}
void Replay::glProgramUniformHandleui64vARB(GLuint program, GLint location, GLsizei count, const Data& values) {
    if (!gl.glProgramUniformHandleui64vARB) return (void)lacking(op::glProgramUniformHandleui64vARB);
    if (count <= 0 || values.size() < size_t{8} * static_cast<size_t>(count)) return;
    const GLuint ours = name(Kind::Program, program);
    const GLint at = uniformLocation(program, location);
    gl.glProgramUniformHandleui64vARB(ours, at, count, handleValues(ours, at, values.as<GLuint64>(), count).data());
}
// Which of both an attribute stands for, only the shader knows: most are textures.
void Replay::glVertexAttribL1ui64ARB(GLuint index, GLuint64EXT x) {
    if (!gl.glVertexAttribL1ui64ARB) return (void)lacking(op::glVertexAttribL1ui64ARB);
    gl.glVertexAttribL1ui64ARB(index, c_->shared ? c_->shared->handles.value(HandleTable::Of::Texture, x) : x);
}
void Replay::glVertexAttribL1ui64vARB(GLuint index, const Data& v) {
    GLuint64EXT x = 0;
    if (v.size() < sizeof x) return;
    std::memcpy(&x, v.pointer(), sizeof x);
    glVertexAttribL1ui64ARB(index, x);
}

} // namespace mural
