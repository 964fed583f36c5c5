#include "interposer/wrappers/image_reads.hpp"

#include <cstring>

#include "interposer/readback/node_requests.hpp"
#include "interposer/memory/mapped_buffers.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/memory/pixel_store.hpp"
#include "interposer/encode/session.hpp"

namespace mural::image_reads {

namespace {

constexpr Target kTargets[] = {{GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
                               {GL_TEXTURE_CUBE_MAP, GL_TEXTURE_BINDING_CUBE_MAP},
                               {GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BINDING_2D_ARRAY},
                               {GL_TEXTURE_3D, GL_TEXTURE_BINDING_3D},
                               {GL_TEXTURE_CUBE_MAP_ARRAY, GL_TEXTURE_BINDING_CUBE_MAP_ARRAY},
                               {GL_TEXTURE_1D, GL_TEXTURE_BINDING_1D},
                               {GL_TEXTURE_1D_ARRAY, GL_TEXTURE_BINDING_1D_ARRAY},
                               {GL_TEXTURE_RECTANGLE, GL_TEXTURE_BINDING_RECTANGLE}};

// The target of a texture. Mesa's query exists in core contexts only; elsewhere trial bindings find the target.
GLenum targetOf(Context& c, GLuint texture) {
    GLint named = 0;
    if (c.core && gReal.glGetTextureParameteriv) gReal.glGetTextureParameteriv(texture, GL_TEXTURE_TARGET, &named);
    if (named) return static_cast<GLenum>(named);
    stashError(c, driverError());
    for (const Target& t : kTargets) {
        const GLint before = boundTo(t);
        gReal.glBindTexture(t.target, texture);
        if (driverError() != GL_NO_ERROR) continue;
        gReal.glBindTexture(t.target, static_cast<GLuint>(before));
        return t.target;
    }
    return GL_TEXTURE_2D;
}

} // namespace

void deliver(ThreadState& t, const void* tight, void* pixels, const sizes::ImageLayout& layout) {
    if (!packBufferBound(*t.context)) {
        if (pixels) sizes::unpackTight(pixels, tight, layout);
        return;
    }
    const size_t span = sizes::spanBytes(layout);
    void* whole = scratchMemory(t, span);
    if (!whole) return;
    const GLuint buffer = boundPackBuffer();
    const auto offset = reinterpret_cast<uint64_t>(pixels);
    if (!readOwnCopy(t, buffer, offset, whole, span)) std::memset(whole, 0, span); // preserves bytes between rows
    sizes::unpackTight(whole, tight, layout);
    writeOwnCopy(t, buffer, offset, whole, span);
    records::bufferBytes(t, buffer, offset, DataArg::of(whole, span));
}

void requestAndDeliver(ThreadState& t, const ImageQuestion& q, void* pixels, const sizes::ImageLayout& layout,
                       const char* by) {
    if (q.sizeBytes == 0) return;
    const bool defers = layout.known && packBufferBound(*t.context) &&
                        deferTexImage(t, q.byName, q.targetOrTexture, q.level, q.format, q.type, q.sizeBytes,
                                      {reinterpret_cast<uint64_t>(pixels), layout, q.part}, by);
    if (defers) return;
    settleBound(t, GL_PIXEL_PACK_BUFFER, by);
    void* const image = requestTexImage(t, q.byName, q.targetOrTexture, q.level, q.format, q.type, q.sizeBytes, by);
    if (!image || !layout.known) return;
    keepPart(static_cast<std::byte*>(image), q.part);
    deliver(t, image, pixels, layout);
}

void sendPackBuffer(ThreadState& t, const void* offset, size_t bytes) {
    void* const written = bytes ? scratchMemory(t, bytes) : nullptr;
    const GLuint buffer = boundPackBuffer();
    const auto at = reinterpret_cast<uint64_t>(offset);
    if (written && readOwnCopy(t, buffer, at, written, bytes))
        records::bufferBytes(t, buffer, at, DataArg::of(written, bytes));
}

int imageDimensions(GLenum target) {
    switch (target) {
    case GL_TEXTURE_1D: return 1;
    case GL_TEXTURE_3D:
    case GL_TEXTURE_2D_ARRAY:
    case GL_TEXTURE_CUBE_MAP_ARRAY: return 3;
    default: return 2;
    }
}

int dimensionsByName(GLenum target) { return target == GL_TEXTURE_CUBE_MAP ? 3 : imageDimensions(target); }

Level levelOf(Context& c, GLuint texture, GLint level, GLenum& target) {
    Level size =
        levelOf([=](GLenum pname, GLint* value) { gReal.glGetTextureLevelParameteriv(texture, level, pname, value); });
    target = targetOf(c, texture);
    if (target == GL_TEXTURE_CUBE_MAP) size.depth = 6;
    return size;
}

const Target* targetWithImages(GLenum target) {
    for (const Target& t : kTargets) {
        if (t.target == target) return &t;
    }
    return nullptr;
}

GLint boundTo(const Target& t) {
    GLint texture = 0;
    gReal.glGetIntegerv(t.binding, &texture);
    return texture;
}

} // namespace mural::image_reads
