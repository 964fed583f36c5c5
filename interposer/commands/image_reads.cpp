#include "interposer/commands/image_reads.hpp"

#include <cstring>

#include "interposer/asking.hpp"
#include "interposer/mapped_buffers.hpp"
#include "interposer/own_records.hpp"
#include "interposer/pixel_store.hpp"
#include "interposer/session.hpp"

namespace mural::image_reads {

namespace {

// Part of the bound pack buffer, as the program's own context has it.
void packBytes(const Context& c, GLintptr offset, GLsizeiptr bytes, void* into) {
    if (c.api == wire::Api::Desktop) return gReal.glGetBufferSubData(GL_PIXEL_PACK_BUFFER, offset, bytes, into);
    if (const void* mapped = gReal.glMapBufferRange(GL_PIXEL_PACK_BUFFER, offset, bytes, GL_MAP_READ_BIT)) std::memcpy(into, mapped, static_cast<size_t>(bytes));
    gReal.glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
}

constexpr Target kTargets[] = {{GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D}, {GL_TEXTURE_CUBE_MAP, GL_TEXTURE_BINDING_CUBE_MAP}, {GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BINDING_2D_ARRAY},
                               {GL_TEXTURE_3D, GL_TEXTURE_BINDING_3D}, {GL_TEXTURE_CUBE_MAP_ARRAY, GL_TEXTURE_BINDING_CUBE_MAP_ARRAY}, {GL_TEXTURE_1D, GL_TEXTURE_BINDING_1D},
                               {GL_TEXTURE_1D_ARRAY, GL_TEXTURE_BINDING_1D_ARRAY}, {GL_TEXTURE_RECTANGLE, GL_TEXTURE_BINDING_RECTANGLE}};

// The target of a texture. Drivers tell it in core contexts only (Mesa), but let it be bound to no other.
GLenum targetOf(Context& c, GLuint texture) {
    GLint told = 0;
    if (c.core && gReal.glGetTextureParameteriv) gReal.glGetTextureParameteriv(texture, GL_TEXTURE_TARGET, &told);
    if (told) return static_cast<GLenum>(told);
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

bool capturing(const ThreadState& t) {
    Session* s = Session::current();
    return t.context && s && s->alive();
}

void deliver(ThreadState& t, const void* tight, void* pixels, const sizes::ImageLayout& layout) {
    if (!packBufferBound(*t.context)) {
        if (pixels) sizes::unpackTight(pixels, tight, layout);
        return;
    }
    const size_t span = sizes::spanBytes(layout);
    void* whole = scratchMemory(t, span);
    if (!whole) return;
    const auto offset = reinterpret_cast<GLintptr>(pixels);
    packBytes(*t.context, offset, static_cast<GLsizeiptr>(span), whole); // bytes between the rows stay
    sizes::unpackTight(whole, tight, layout);
    GLint buffer = 0;
    gReal.glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &buffer);
    if (t.context->version < (t.context->api == wire::Api::Desktop ? 31 : 30)) {
        gReal.glBufferSubData(GL_PIXEL_PACK_BUFFER, offset, static_cast<GLsizeiptr>(span), whole);
    } else {
        writeOwnCopy(t, static_cast<GLuint>(buffer), static_cast<uint64_t>(offset), whole, span);
    }
    records::bufferBytes(t, static_cast<GLuint>(buffer), static_cast<uint64_t>(offset), DataArg::of(whole, span));
}

void tellPackBuffer(ThreadState& t, const void* offset, size_t bytes) {
    void* const written = bytes ? scratchMemory(t, bytes) : nullptr;
    if (!written) return;
    packBytes(*t.context, reinterpret_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), written);
    GLint buffer = 0;
    gReal.glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &buffer);
    records::bufferBytes(t, static_cast<GLuint>(buffer), reinterpret_cast<uint64_t>(offset), DataArg::of(written, bytes));
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
    Level size = levelOf([=](GLenum pname, GLint* value) { gReal.glGetTextureLevelParameteriv(texture, level, pname, value); });
    target = targetOf(c, texture);
    if (target == GL_TEXTURE_CUBE_MAP) size.depth = 6;
    return size;
}

void keepPart(std::byte* image, const Level& size, const Level& from, const Level& part, size_t groupBytes) {
    const size_t rowBytes = groupBytes * static_cast<size_t>(part.width);
    std::byte* out = image;
    for (GLint z = 0; z < part.depth; ++z) {
        for (GLint y = 0; y < part.height; ++y, out += rowBytes) {
            const size_t row = (static_cast<size_t>(from.depth + z) * static_cast<size_t>(size.height) + static_cast<size_t>(from.height + y)) * static_cast<size_t>(size.width);
            std::memmove(out, image + (row + static_cast<size_t>(from.width)) * groupBytes, rowBytes);
        }
    }
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
