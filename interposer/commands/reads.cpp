// Pixels and texture images: drawn on the nodes, so read from the nodes.
#include <cstring>

#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/commands/quiet.hpp"
#include "interposer/asking.hpp"
#include "interposer/context.hpp"
#include "interposer/mapped_buffers.hpp"
#include "interposer/own_records.hpp"
#include "interposer/pixel_store.hpp"
#include "interposer/read_area.hpp"
#include "interposer/real_gl.hpp"
#include "interposer/session.hpp"

using namespace mural;

namespace {

bool capturing(const ThreadState& t) {
    Session* s = Session::current();
    return t.context && s && s->alive();
}

// A pixmap is drawn by the program's own GL too, and drivers let it have one buffer whatever its configuration
// says: what is in it is known here. A bound pack buffer is the nodes' as well.
bool readsOwnPixmap(Context& c) {
    if (!c.drawsPixmap || c.readWindow != c.drawWindow || packBufferBound(c)) return false;
    return readsWindow(c);
}
// Part of the bound pack buffer, as the program's own context has it.
void packBytes(const Context& c, GLintptr offset, GLsizeiptr bytes, void* into) {
    if (c.api == wire::Api::Desktop) return gReal.glGetBufferSubData(GL_PIXEL_PACK_BUFFER, offset, bytes, into);
    if (const void* mapped = gReal.glMapBufferRange(GL_PIXEL_PACK_BUFFER, offset, bytes, GL_MAP_READ_BIT)) std::memcpy(into, mapped, static_cast<size_t>(bytes));
    gReal.glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
}

// Writes tight pixels where the pack state puts them: client memory, or the bound pack buffer (the
// program's own and the nodes').
void deliver(ThreadState& t, const void* tight, void* pixels, const sizes::ImageLayout& layout) {
    if (!packBufferBound(*t.context)) {
        sizes::unpackTight(pixels, tight, layout);
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

// Drivers look at that only when there is something to read.
bool outOfPackBuffer(Context& c, GLsizei width, GLsizei height, GLenum format, GLenum type, const void* offset) {
    if (!packBufferBound(c) || width == 0 || height == 0) return false;
    const sizes::ImageLayout layout = sizes::layoutOf(packStore(c), format, type, width, height, 1, 2);
    return layout.known && !quiet::withinBuffer(GL_PIXEL_PACK_BUFFER, GL_PIXEL_PACK_BUFFER_BINDING, reinterpret_cast<uint64_t>(offset), sizes::spanBytes(layout));
}

void readPixels(ThreadState& t, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type, void* pixels, const char* by = __builtin_FUNCTION()) {
    Context& c = *t.context;
    if (readsOwnPixmap(c)) {
        gReal.glReadPixels(x, y, width, height, format, type, pixels);
        return;
    }
    ReadArea clip{x, y, width, height};
    if (!cutToReadFramebuffer(c, format, type, clip)) return;
    const void* tight = askPixels(t, clip.x, clip.y, clip.w, clip.h, format, type, false, by);
    if (!tight) {
        gReal.glReadPixels(x, y, width, height, format, type, pixels); // alone by now
        return;
    }
    sizes::PixelStore store = packStore(c);
    if (store.rowLength == 0) store.rowLength = width; // rows keep their distance when clipped
    store.skipPixels += clip.x - x;
    store.skipRows += clip.y - y;
    const sizes::ImageLayout layout = sizes::layoutOf(store, format, type, clip.w, clip.h, 1, 2);
    if (layout.known) deliver(t, tight, pixels, layout);
}

struct Level {
    GLint width = 0, height = 0, depth = 0;
};

int imageDimensions(GLenum target) {
    switch (target) {
    case GL_TEXTURE_1D: return 1;
    case GL_TEXTURE_3D:
    case GL_TEXTURE_2D_ARRAY:
    case GL_TEXTURE_CUBE_MAP_ARRAY: return 3;
    default: return 2;
    }
}

struct Target {
    GLenum target, binding;
};
constexpr Target kTargets[] = {{GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D}, {GL_TEXTURE_CUBE_MAP, GL_TEXTURE_BINDING_CUBE_MAP}, {GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BINDING_2D_ARRAY},
                               {GL_TEXTURE_3D, GL_TEXTURE_BINDING_3D}, {GL_TEXTURE_CUBE_MAP_ARRAY, GL_TEXTURE_BINDING_CUBE_MAP_ARRAY}, {GL_TEXTURE_1D, GL_TEXTURE_BINDING_1D},
                               {GL_TEXTURE_1D_ARRAY, GL_TEXTURE_BINDING_1D_ARRAY}, {GL_TEXTURE_RECTANGLE, GL_TEXTURE_BINDING_RECTANGLE}};

GLint boundTo(const Target& t) {
    GLint texture = 0;
    gReal.glGetIntegerv(t.binding, &texture);
    return texture;
}

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

// ask(pname, &value) asks the driver.
template <class Ask> Level levelOf(Ask&& ask) {
    Level size;
    ask(GL_TEXTURE_WIDTH, &size.width);
    ask(GL_TEXTURE_HEIGHT, &size.height);
    ask(GL_TEXTURE_DEPTH, &size.depth);
    return size;
}

// A cube map's level is its six faces.
Level levelOf(Context& c, GLuint texture, GLint level, GLenum& target) {
    Level size = levelOf([=](GLenum pname, GLint* value) { gReal.glGetTextureLevelParameteriv(texture, level, pname, value); });
    target = targetOf(c, texture);
    if (target == GL_TEXTURE_CUBE_MAP) size.depth = 6;
    return size;
}

// Of an image by name: a cube map's faces are images one behind the other.
int dimensionsByName(GLenum target) { return target == GL_TEXTURE_CUBE_MAP ? 3 : imageDimensions(target); }

// Moves a part of a tight image to its beginning, where it is tight itself.
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

void readTexture(ThreadState& t, bool byName, GLuint which, GLint level, GLenum format, GLenum type, void* pixels, const Level& size, int dimensions, const char* by = __builtin_FUNCTION()) {
    const size_t bytes = sizes::tightBytes(format, type, size.width, size.height, size.depth);
    const void* tight = bytes ? askTexImage(t, byName, which, level, format, type, bytes, by) : nullptr;
    if (!tight) return;
    const sizes::ImageLayout layout = sizes::layoutOf(packStore(*t.context), format, type, size.width, size.height, size.depth, dimensions);
    if (layout.known) deliver(t, tight, pixels, layout);
}

} // namespace

extern "C" {

void mural_glReadPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type, void* pixels) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return gReal.glReadPixels(x, y, width, height, format, type, pixels);
    const bool isError = width < 0 || height < 0 || outOfPackBuffer(*t.context, width, height, format, type, pixels);
    const bool valid = raisesNothing(*t.context, [&] { gReal.glReadPixels(x, y, isError ? width : 0, isError ? height : 0, format, type, pixels); });
    if (valid) readPixels(t, x, y, width, height, format, type, pixels);
}

void mural_glReadnPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type, GLsizei bufSize, void* data) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return gReal.glReadnPixels(x, y, width, height, format, type, bufSize, data);
    // The driver's own read tells whether bufSize is enough; its pixels are written over.
    const bool valid = raisesNothing(*t.context, [&] { gReal.glReadnPixels(x, y, width, height, format, type, bufSize, data); });
    if (valid) readPixels(t, x, y, width, height, format, type, data);
}

// The driver's own answer comes first: it gives the errors, and the content where nodes have none.
void mural_glGetTexImage(GLenum target, GLint level, GLenum format, GLenum type, void* pixels) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return gReal.glGetTexImage(target, level, format, type, pixels);
    if (!raisesNothing(*t.context, [&] { gReal.glGetTexImage(target, level, format, type, pixels); })) return;
    const Level size = levelOf([=](GLenum pname, GLint* value) { gReal.glGetTexLevelParameteriv(target, level, pname, value); });
    readTexture(t, false, target, level, format, type, pixels, size, imageDimensions(target));
}

void mural_glGetnTexImage(GLenum target, GLint level, GLenum format, GLenum type, GLsizei bufSize, void* pixels) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return gReal.glGetnTexImage(target, level, format, type, bufSize, pixels);
    if (raisesNothing(*t.context, [&] { gReal.glGetnTexImage(target, level, format, type, bufSize, pixels); }))
        mural_glGetTexImage(target, level, format, type, pixels);
}

void mural_glGetTextureImage(GLuint texture, GLint level, GLenum format, GLenum type, GLsizei bufSize, void* pixels) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return gReal.glGetTextureImage(texture, level, format, type, bufSize, pixels);
    if (!raisesNothing(*t.context, [&] { gReal.glGetTextureImage(texture, level, format, type, bufSize, pixels); })) return;
    GLenum target = 0;
    const Level size = levelOf(*t.context, texture, level, target);
    readTexture(t, true, texture, level, format, type, pixels, size, dimensionsByName(target));
}

// EXT_direct_state_access: the nodes read what is bound, so the texture is bound there as long as this takes.
void mural_glGetTextureImageEXT(GLuint texture, GLenum target, GLint level, GLenum format, GLenum type, void* pixels) {
    ThreadState& t = *tThread;
    const auto local = [&] { gReal.glGetTextureImageEXT(texture, target, level, format, type, pixels); };
    if (!capturing(t) || t.context->compilingList) return local();
    if (!raisesNothing(*t.context, local)) return;
    const bool isFace = target >= GL_TEXTURE_CUBE_MAP_POSITIVE_X && target <= GL_TEXTURE_CUBE_MAP_NEGATIVE_Z;
    const GLenum bindTarget = isFace ? GL_TEXTURE_CUBE_MAP : target;
    const Level size = levelOf([&](GLenum pname, GLint* value) { gReal.glGetTextureLevelParameterivEXT(texture, target, level, pname, value); });
    for (const Target& kind : kTargets) {
        if (kind.target != bindTarget) continue;
        encode_glBindTexture(t, bindTarget, texture);
        readTexture(t, false, target, level, format, type, pixels, size, imageDimensions(target));
        encode_glBindTexture(t, bindTarget, static_cast<GLuint>(boundTo(kind)));
    }
}

void mural_glGetMultiTexImageEXT(GLenum texunit, GLenum target, GLint level, GLenum format, GLenum type, void* pixels) {
    ThreadState& t = *tThread;
    const auto local = [&] { gReal.glGetMultiTexImageEXT(texunit, target, level, format, type, pixels); };
    if (!capturing(t) || t.context->compilingList) return local();
    if (!raisesNothing(*t.context, local)) return;
    const Level size = levelOf([&](GLenum pname, GLint* value) { gReal.glGetMultiTexLevelParameterivEXT(texunit, target, level, pname, value); });
    GLint unit = 0;
    gReal.glGetIntegerv(GL_ACTIVE_TEXTURE, &unit);
    encode_glActiveTexture(t, texunit);
    readTexture(t, false, target, level, format, type, pixels, size, imageDimensions(target));
    encode_glActiveTexture(t, static_cast<GLenum>(unit));
}

// A part: the whole level is asked for, the part copied out of it.
void mural_glGetTextureSubImage(GLuint texture, GLint level, GLint xoffset, GLint yoffset, GLint zoffset, GLsizei width, GLsizei height, GLsizei depth, GLenum format, GLenum type, GLsizei bufSize, void* pixels) {
    ThreadState& t = *tThread;
    const auto local = [&] { gReal.glGetTextureSubImage(texture, level, xoffset, yoffset, zoffset, width, height, depth, format, type, bufSize, pixels); };
    if (!capturing(t)) return local();
    if (!raisesNothing(*t.context, local)) return;
    if (width <= 0 || height <= 0 || depth <= 0) return;
    GLenum target = 0;
    const Level size = levelOf(*t.context, texture, level, target);
    const size_t whole = sizes::tightBytes(format, type, size.width, size.height, size.depth);
    auto* tight = static_cast<std::byte*>(whole ? askTexImage(t, true, texture, level, format, type, whole) : nullptr);
    if (!tight) return;
    keepPart(tight, size, {xoffset, yoffset, zoffset}, {width, height, depth}, sizes::groupBytes(format, type));
    const sizes::ImageLayout layout = sizes::layoutOf(packStore(*t.context), format, type, width, height, depth, dimensionsByName(target));
    if (layout.known) deliver(t, tight, pixels, layout);
}

} // extern "C"
