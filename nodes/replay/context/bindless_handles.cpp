// Bindless textures and images (ARB_bindless_texture). Commands' handles, which the program's driver has created, are
// mapped to this node's. Handles that shaders read from memory cannot be mapped: they work if both drivers number
// handles equally (docs/decisions/0006-handles-of-textures.md).
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "common/log/log.hpp"
#include "gl_opcodes.hpp"
#include "nodes/replay/engine/replay.hpp"

namespace mural {

namespace {

bool isImageType(GLint type) { return type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY; }

} // namespace

// ---- created handles

void Replay::addHandle(HandleTable::Of of, uint64_t appHandle, uint64_t nodeHandle) {
    if (!c_->shared || c_->shared->handles.set(of, appHandle, nodeHandle)) return;
    char text[512];
    snprintf(text, sizeof text,
             "texture handles of this node's driver differ from the program's (0x%" PRIx64 " for 0x%" PRIx64
             "): handles that shaders read from buffers, vertex arrays or integers may be wrong on this node's tiles; "
             "use the same driver for program and nodes",
             nodeHandle, appHandle);
    log::warning(log::Topic::Replay, text);
}

// ---- reuse of handle numbers. A driver frees a number after the last command that used it. On this node that may be
// earlier or later than in the program's process. A texture has one handle per sampler, and the samplers may be equal.
// Where drivers use the lowest free number, one of these handles has the wanted one.

// Lets the driver free deleted objects: zink does so when it reuses the memory of completed commands.
void Replay::settleDriver() {
    constexpr int kRounds = 6;
    constexpr GLsizeiptr kBytes = 16;
    if (!gl.glCopyBufferSubData || !gl.glFinish) return;
    GLuint buffers[2] = {};
    GLint before[2] = {};
    gl.glGetIntegerv(GL_COPY_READ_BUFFER_BINDING, &before[0]);
    gl.glGetIntegerv(GL_COPY_WRITE_BUFFER_BINDING, &before[1]);
    gl.glGenBuffers(2, buffers);
    const GLenum targets[2] = {GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER};
    for (int i = 0; i < 2; ++i) {
        gl.glBindBuffer(targets[i], buffers[i]);
        gl.glBufferData(targets[i], kBytes, nullptr, GL_STATIC_COPY);
    }
    for (int i = 0; i < kRounds; ++i) {
        gl.glCopyBufferSubData(targets[0], targets[1], 0, 0, kBytes);
        gl.glFinish();
    }
    for (int i = 0; i < 2; ++i) gl.glBindBuffer(targets[i], static_cast<GLuint>(before[i]));
    gl.glDeleteBuffers(2, buffers);
}

// Creates a sampler with the parameters of `sampler`, or without one, of the texture. 0: unsupported.
GLuint Replay::samplerLike(GLuint texture, GLuint sampler) {
    if (!gl.glGenSamplers || !gl.glSamplerParameteri || !gl.glGetSamplerParameterfv ||
        (!sampler && !gl.glGetTextureParameterfv))
        return 0;
    const auto get = [&](GLenum name, GLfloat* value) {
        if (sampler)
            gl.glGetSamplerParameterfv(sampler, name, value);
        else
            gl.glGetTextureParameterfv(texture, name, value);
    };
    GLuint made = 0;
    gl.glGenSamplers(1, &made);
    for (const GLenum name :
         {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER, GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R,
          GL_TEXTURE_COMPARE_MODE, GL_TEXTURE_COMPARE_FUNC, GL_TEXTURE_MIN_LOD, GL_TEXTURE_MAX_LOD, GL_TEXTURE_LOD_BIAS,
          GL_TEXTURE_MAX_ANISOTROPY, GL_TEXTURE_SRGB_DECODE_EXT, GL_TEXTURE_CUBE_MAP_SEAMLESS,
          GL_TEXTURE_REDUCTION_MODE_ARB}) {
        constexpr GLfloat kUnknown = -1e30f; // for drivers without it
        GLfloat value = kUnknown;
        get(name, &value);
        if (value != kUnknown) gl.glSamplerParameterf(made, name, value);
    }
    GLfloat border[4] = {};
    get(GL_TEXTURE_BORDER_COLOR, border); // handles allow four border colours, which are equal as integers
    gl.glSamplerParameterfv(made, GL_TEXTURE_BORDER_COLOR, border);
    return made;
}

// Obtains a handle with the wanted number by means of additional samplers. 0: impossible.
uint64_t Replay::equalHandle(GLuint texture, GLuint sampler, uint64_t wanted, GLuint& made) {
    constexpr size_t kMaxTries = 1024;
    if (!gl.glGetTextureSamplerHandleARB || !gl.glDeleteSamplers) return 0;
    for (int round = 0; round < 2; ++round) { // the second round runs after the driver is idle
        std::vector<GLuint> spare;
        for (uint64_t last = 0; last < wanted && spare.size() < kMaxTries;) {
            made = samplerLike(texture, sampler);
            if (!made) break;
            const uint64_t next = gl.glGetTextureSamplerHandleARB(texture, made);
            if (next == wanted) break;
            spare.push_back(std::exchange(made, 0));
            if (next <= last) break; // unordered, or no handle
            last = next;
        }
        gl.glDeleteSamplers(static_cast<GLsizei>(spare.size()), spare.data()); // frees their handles as well
        (void)isError();
        if (made) return wanted;
        if (round == 0) settleDriver();
    }
    return 0;
}

// Requests the program's handle from this driver. Until the first handle is freed, drivers number handles in request
// order.
void Replay::requestTextureHandle(GLuint texture, GLuint sampler, uint64_t appHandle) {
    if (!c_->shared) return;
    const auto known = c_->shared->textureHandles.find(appHandle);
    // a repeated request
    if (known != c_->shared->textureHandles.end() && known->second.texture == texture &&
        known->second.sampler == sampler)
        return;
    replay::ObtainedHandle obtained{texture, sampler, 0};
    uint64_t nodeHandle = c_->shared->handlesFreed ? equalHandle(texture, sampler, appHandle, obtained.made) : 0;
    if (!nodeHandle)
        nodeHandle = sampler ? gl.glGetTextureSamplerHandleARB(texture, sampler) : gl.glGetTextureHandleARB(texture);
    c_->shared->textureHandles[appHandle] = obtained;
    addHandle(HandleTable::Of::Texture, appHandle, nodeHandle);
}

// Deleting a texture or a sampler ends its handles.
void Replay::handlesGone(Kind kind, GLuint nodeName) {
    if (!c_->shared || c_->shared->textureHandles.empty()) return;
    std::erase_if(c_->shared->textureHandles, [&](const auto& entry) {
        const replay::ObtainedHandle& handle = entry.second;
        if ((kind == Kind::Texture ? handle.texture : handle.sampler) != nodeName) return false;
        if (handle.made) gl.glDeleteSamplers(1, &handle.made);
        c_->shared->handlesFreed = true;
        return true;
    });
}

void Replay::glGetTextureHandleARB(GLuint texture, uint64_t result) {
    if (!gl.glGetTextureHandleARB) return (void)lacking(op::glGetTextureHandleARB);
    requestTextureHandle(name(Kind::Texture, texture), 0, result);
}
void Replay::glGetTextureSamplerHandleARB(GLuint texture, GLuint sampler, uint64_t result) {
    if (!gl.glGetTextureSamplerHandleARB) return (void)lacking(op::glGetTextureSamplerHandleARB);
    requestTextureHandle(name(Kind::Texture, texture), name(Kind::Sampler, sampler), result);
}
void Replay::glGetImageHandleARB(GLuint texture, GLint level, GLboolean layered, GLint layer, GLenum format,
                                 uint64_t result) {
    if (!gl.glGetImageHandleARB) return (void)lacking(op::glGetImageHandleARB);
    addHandle(HandleTable::Of::Image, result,
              gl.glGetImageHandleARB(name(Kind::Texture, texture), level, layered, layer, format));
}

// ---- residency. An unknown handle is an error, which the program's own GL has reported.

void Replay::glMakeTextureHandleResidentARB(GLuint64 handle) {
    const uint64_t nodeHandle = c_->shared ? c_->shared->handles.find(HandleTable::Of::Texture, handle) : 0;
    if (nodeHandle && gl.glMakeTextureHandleResidentARB) gl.glMakeTextureHandleResidentARB(nodeHandle);
}
void Replay::glMakeTextureHandleNonResidentARB(GLuint64 handle) {
    const uint64_t nodeHandle = c_->shared ? c_->shared->handles.find(HandleTable::Of::Texture, handle) : 0;
    if (nodeHandle && gl.glMakeTextureHandleNonResidentARB) gl.glMakeTextureHandleNonResidentARB(nodeHandle);
}
void Replay::glMakeImageHandleResidentARB(GLuint64 handle, GLenum access) {
    const uint64_t nodeHandle = c_->shared ? c_->shared->handles.find(HandleTable::Of::Image, handle) : 0;
    if (!nodeHandle || !gl.glMakeImageHandleResidentARB) return;
    c_->writesMemory = c_->writesMemory || access != GL_READ_ONLY;
    gl.glMakeImageHandleResidentARB(nodeHandle, access);
}
void Replay::glMakeImageHandleNonResidentARB(GLuint64 handle) {
    const uint64_t nodeHandle = c_->shared ? c_->shared->handles.find(HandleTable::Of::Image, handle) : 0;
    if (nodeHandle && gl.glMakeImageHandleNonResidentARB) gl.glMakeImageHandleNonResidentARB(nodeHandle);
}

// ---- values

// The kind of handle, from the uniform's type. `program` and `location` are this node's. Queried only if handles
// differ.
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

// Converts values to this node's handles. The location is this node's.
std::vector<GLuint64> Replay::handleValues(GLuint program, GLint location, const GLuint64* values,
                                           GLsizei count) const {
    std::vector<GLuint64> nodeHandles(static_cast<size_t>(count));
    std::memcpy(nodeHandles.data(), values, nodeHandles.size() * sizeof(GLuint64)); // records are aligned to 4 bytes
    if (!c_->shared || !c_->shared->handles.differ()) return nodeHandles;
    const HandleTable::Of of = handlesOfUniform(program, location);
    for (GLuint64& value : nodeHandles) value = c_->shared->handles.value(of, value);
    return nodeHandles;
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
    gl.glUniformHandleui64vARB(at, count,
                               handleValues(name(Kind::Program, c_->program), at, value.as<GLuint64>(), count).data());
}
void Replay::glProgramUniformHandleui64ARB(GLuint program, GLint location, GLuint64 value) {
    if (!gl.glProgramUniformHandleui64ARB) return (void)lacking(op::glProgramUniformHandleui64ARB);
    const GLuint nodeName = name(Kind::Program, program);
    const GLint at = uniformLocation(program, location);
    gl.glProgramUniformHandleui64ARB(nodeName, at, handleValues(nodeName, at, &value, 1)[0]);
}
void Replay::glProgramUniformHandleui64vARB(GLuint program, GLint location, GLsizei count, const Data& values) {
    if (!gl.glProgramUniformHandleui64vARB) return (void)lacking(op::glProgramUniformHandleui64vARB);
    if (count <= 0 || values.size() < size_t{8} * static_cast<size_t>(count)) return;
    const GLuint nodeName = name(Kind::Program, program);
    const GLint at = uniformLocation(program, location);
    gl.glProgramUniformHandleui64vARB(nodeName, at, count,
                                      handleValues(nodeName, at, values.as<GLuint64>(), count).data());
}
// The kind of a handle in a vertex attribute depends on the shader and is unknown here. Most are textures.
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
