// Page commitment of sparse textures and buffers. Uncommitted memory is undefined, so a node may commit more than the
// program: with other page sizes it commits all overlapping pages and releases none. This costs memory only.
#include <algorithm>

#include "common/log/log.hpp"
#include "gl_opcodes.hpp"
#include "nodes/replay/engine/replay.hpp"

namespace mural {

namespace {

// Extends [from, from + size) to multiples of `step`, but not beyond `maximum`.
template <class T, class S> void enlarge(T& from, S& size, int64_t step, int64_t maximum) {
    if (step <= 0) return;
    const int64_t end = (int64_t{from} + size + step - 1) / step * step;
    from = static_cast<T>(from / step * step);
    size = static_cast<S>(std::min(end, std::max<int64_t>(maximum, from)) - from);
}

} // namespace

bool Replay::isError() {
    bool found = false;
    constexpr int kMaxErrors = 8; // a lost context reports errors forever
    for (int i = 0; i < kMaxErrors && gl.glGetError && gl.glGetError() != GL_NO_ERROR; ++i) found = true;
    return found;
}

// Extends the box to this driver's pages of the texture (0: the bound one). Returns false without sparse pages.
bool Replay::enlargeToPages(GLenum target, GLuint texture, PageBox& box) {
    if (!gl.glGetInternalformativ || !gl.glGetTexLevelParameteriv || (texture && !gl.glGetTextureLevelParameteriv))
        return false;
    const auto ofTexture = [&](GLenum name) {
        GLint value = 0;
        if (texture)
            gl.glGetTextureParameteriv(texture, name, &value);
        else
            gl.glGetTexParameteriv(target, name, &value);
        return value;
    };
    const auto ofLevel = [&](GLenum name) {
        GLint value = 0;
        if (texture)
            gl.glGetTextureLevelParameteriv(texture, box.level, name, &value);
        else
            gl.glGetTexLevelParameteriv(target == GL_TEXTURE_CUBE_MAP ? GL_TEXTURE_CUBE_MAP_POSITIVE_X : target,
                                        box.level, name, &value);
        return value;
    };
    if (texture) target = static_cast<GLenum>(ofTexture(GL_TEXTURE_TARGET));
    const auto format = static_cast<GLenum>(ofLevel(GL_TEXTURE_INTERNAL_FORMAT));
    const GLint index = ofTexture(GL_VIRTUAL_PAGE_SIZE_INDEX_ARB);
    const auto pageSize = [&](GLenum name) {
        constexpr GLsizei kMaxSizes = 16;
        GLint sizes[kMaxSizes] = {};
        gl.glGetInternalformativ(target, format, name, kMaxSizes, sizes);
        return index >= 0 && index < kMaxSizes ? sizes[index] : 0;
    };
    const GLint width = pageSize(GL_VIRTUAL_PAGE_SIZE_X_ARB), height = pageSize(GL_VIRTUAL_PAGE_SIZE_Y_ARB),
                depth = pageSize(GL_VIRTUAL_PAGE_SIZE_Z_ARB);
    if (width <= 0 || height <= 0 || depth <= 0) return false;
    enlarge(box.x, box.width, width, ofLevel(GL_TEXTURE_WIDTH));
    enlarge(box.y, box.height, height, ofLevel(GL_TEXTURE_HEIGHT));
    // otherwise separate layers
    if (target == GL_TEXTURE_3D) enlarge(box.z, box.depth, depth, ofLevel(GL_TEXTURE_DEPTH));
    return true;
}

void Replay::commitPages(GLenum target, GLuint texture, const PageBox& box, bool commits,
                         const std::function<void(const PageBox&)>& call) {
    (void)isError();
    call(box);
    if (!isError() || !commits) return;
    PageBox aligned = box;
    const bool known = enlargeToPages(target, texture, aligned);
    if (known) call(aligned);
    if ((!isError() && known) || pagesReported_) return;
    pagesReported_ = true;
    log::warning(
        log::Topic::Replay,
        "this node's driver cannot commit pages of a sparse texture; their contents are missing on this node's "
        "tiles; use the same driver for program and nodes");
}

void Replay::glTexPageCommitmentARB(GLenum target, GLint level, GLint x, GLint y, GLint z, GLsizei w, GLsizei h,
                                    GLsizei d, GLboolean commit) {
    if (!gl.glTexPageCommitmentARB) return (void)lacking(op::glTexPageCommitmentARB);
    commitPages(target, 0, {level, x, y, z, w, h, d}, commit, [&](const PageBox& b) {
        gl.glTexPageCommitmentARB(target, b.level, b.x, b.y, b.z, b.width, b.height, b.depth, commit);
    });
}
void Replay::glTexturePageCommitmentEXT(GLuint texture, GLint level, GLint x, GLint y, GLint z, GLsizei w, GLsizei h,
                                        GLsizei d, GLboolean commit) {
    if (!gl.glTexturePageCommitmentEXT) return (void)lacking(op::glTexturePageCommitmentEXT);
    const GLuint nodeName = name(Kind::Texture, texture);
    commitPages(0, nodeName, {level, x, y, z, w, h, d}, commit, [&](const PageBox& b) {
        gl.glTexturePageCommitmentEXT(nodeName, b.level, b.x, b.y, b.z, b.width, b.height, b.depth, commit);
    });
}

// bufferBytes() is called only if page sizes differ.
void Replay::commitBuffer(uint64_t offset, uint64_t sizeBytes, bool commits,
                          const std::function<uint64_t()>& bufferBytes,
                          const std::function<void(uint64_t, uint64_t)>& call) {
    GLint page = 0;
    gl.glGetIntegerv(GL_SPARSE_BUFFER_PAGE_SIZE_ARB, &page);
    const uint64_t step = page > 0 ? static_cast<uint64_t>(page) : 1;
    if (offset % step == 0 && sizeBytes % step == 0) return call(offset, sizeBytes);
    const uint64_t whole = bufferBytes();
    if (offset > whole || sizeBytes > whole - offset) return; // an error in GL
    const bool fits = offset % step == 0 && offset + sizeBytes == whole;
    if (!commits && !fits) return;
    const uint64_t from = offset / step * step, end = std::min((offset + sizeBytes + step - 1) / step * step, whole);
    call(from, end - from);
}

void Replay::glBufferPageCommitmentARB(GLenum target, GLintptr offset, GLsizeiptr size, GLboolean commit) {
    if (!gl.glBufferPageCommitmentARB) return (void)lacking(op::glBufferPageCommitmentARB);
    if (offset < 0 || size < 0) return;
    const auto bytes = [&] {
        GLint64 all = 0;
        if (gl.glGetBufferParameteri64v) gl.glGetBufferParameteri64v(target, GL_BUFFER_SIZE, &all);
        return static_cast<uint64_t>(all);
    };
    commitBuffer(
        static_cast<uint64_t>(offset), static_cast<uint64_t>(size), commit, bytes, [&](uint64_t from, uint64_t count) {
            gl.glBufferPageCommitmentARB(target, static_cast<GLintptr>(from), static_cast<GLsizeiptr>(count), commit);
        });
}
void Replay::glNamedBufferPageCommitmentARB(GLuint buffer, GLintptr offset, GLsizeiptr size, GLboolean commit) {
    const auto call =
        gl.glNamedBufferPageCommitmentARB ? gl.glNamedBufferPageCommitmentARB : gl.glNamedBufferPageCommitmentEXT;
    if (!call) return (void)lacking(op::glNamedBufferPageCommitmentARB);
    if (offset < 0 || size < 0) return;
    const GLuint nodeName = name(Kind::Buffer, buffer);
    const auto bytes = [&] {
        GLint64 all = 0;
        if (gl.glGetNamedBufferParameteri64v) gl.glGetNamedBufferParameteri64v(nodeName, GL_BUFFER_SIZE, &all);
        return static_cast<uint64_t>(all);
    };
    commitBuffer(static_cast<uint64_t>(offset), static_cast<uint64_t>(size), commit, bytes,
                 [&](uint64_t from, uint64_t count) {
                     call(nodeName, static_cast<GLintptr>(from), static_cast<GLsizeiptr>(count), commit);
                 });
}
void Replay::glNamedBufferPageCommitmentEXT(GLuint buffer, GLintptr offset, GLsizeiptr size, GLboolean commit) {
    glNamedBufferPageCommitmentARB(buffer, offset, size, commit);
}

} // namespace mural
