// Commands that copy out of a framebuffer. A node has only its tile of a window. The remaining pixels are first fetched
// from the other nodes and sent to all (kOpFillWindow).
#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/wrappers/copies.hpp"
#include "interposer/wrappers/validate_only_draws.hpp"
#include "interposer/context/context.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/readback/read_area.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"
#include "interposer/readback/window_colours.hpp"
#include "streamcodec/wire/control_records.hpp"

using namespace mural;

namespace {

// Returns the planes that a copy into a texture level reads. `query` queries the level's internal format. Errors of the
// query are dropped: the copy raises them again.
template <class Query> GLbitfield planesInto(ThreadState& t, Query&& query) {
    Session* s = Session::current();
    if (!t.context || !s || s->welcome().nodeCount < 2) return GL_COLOR_BUFFER_BIT;
    GLint format = 0;
    stashError(*t.context, driverError());
    query(&format);
    (void)driverError();
    return copies::planesOf(static_cast<GLenum>(format));
}

} // namespace

namespace mural::copies {

namespace {

// Requires that the read framebuffer of the nodes is the window.
void gatherNow(ThreadState& t, GLint x, GLint y, GLsizei w, GLsizei h, GLbitfield planes, bool forCopy,
               const char* by) {
    const Window* window = findWindowById(t.context->readWindow);
    if (!window) return;
    const int64_t x0 = x < 0 ? 0 : x, y0 = y < 0 ? 0 : y;
    const int64_t x1 = int64_t{x} + w < window->config.width ? int64_t{x} + w : window->config.width;
    const int64_t y1 = int64_t{y} + h < window->config.height ? int64_t{y} + h : window->config.height;
    if (x1 <= x0 || y1 <= y0) return;
    const auto gx = static_cast<GLint>(x0), gy = static_cast<GLint>(y0);
    const auto gw = static_cast<GLsizei>(x1 - x0), gh = static_cast<GLsizei>(y1 - y0);
    struct Plane {
        GLbitfield bit;
        GLenum format, type;
        uint32_t bits;
        uint32_t bytes;
    };
    const ColourReads colours = colourReadsOf(*t.context, *window);
    const Plane kinds[] = {{GL_COLOR_BUFFER_BIT, GL_RGBA, colours.type, 8, colours.pixelBytes},
                           {GL_DEPTH_BUFFER_BIT, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, window->config.depth, 4},
                           {GL_STENCIL_BUFFER_BIT, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, window->config.stencil, 1}};
    for (const Plane& p : kinds) {
        if (!(planes & p.bit) || p.bits == 0) continue;
        const bool resolves = p.bit == GL_COLOR_BUFFER_BIT && window->config.samples > 0;
        const void* pixels = requestPixels(t, gx, gy, gw, gh, p.format, p.type,
                                           wire::kPlainTransfer | (resolves ? wire::kResolved : 0), by);
        const uint32_t flags = (forCopy ? wire::kForCopy : 0) | (p.bit == GL_COLOR_BUFFER_BIT ? colours.fillFlag : 0);
        if (pixels)
            records::fillWindow(t, gx, gy, gw, gh, p.bit | flags,
                                DataArg::of(pixels, uint64_t(gw) * uint64_t(gh) * p.bytes));
    }
}

// During `gather` the nodes read the window instead of the object that the program has bound for reading.
template <class Gather> void readingWindow(ThreadState& t, Gather&& gather) {
    GLint object = 0;
    if (!readsWindow(*t.context) && gReal.glBindFramebuffer) gReal.glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &object);
    if (object) encode_glBindFramebuffer(t, GL_READ_FRAMEBUFFER, 0);
    gather();
    if (object) encode_glBindFramebuffer(t, GL_READ_FRAMEBUFFER, static_cast<GLuint>(object));
}

bool severalNodes(const ThreadState& t) {
    Session* s = Session::current();
    return t.context && s && s->alive() && s->welcome().nodeCount > 1;
}

} // namespace

void gather(ThreadState& t, GLint x, GLint y, GLsizei w, GLsizei h, GLbitfield planes, const char* by) {
    if (!severalNodes(t)) return;
    if (t.context->listPrimitive) return; // a list accepts no copies there
    if (t.context->compilingList)
        drawAll(t, by);
    else if (readsWindow(*t.context))
        gatherNow(t, x, y, w, h, planes, true, by);
}

// Within a multisampled window, drivers copy all samples. A node has only the samples that it has drawn itself.
void gatherForPixels(ThreadState& t, GLint x, GLint y, GLsizei w, GLsizei h, GLbitfield planes, const char* by) {
    if (!severalNodes(t)) return;
    const Window* const read = readsWindow(*t.context) ? findWindowById(t.context->readWindow) : nullptr;
    GLint drawn = 0;
    if (read && read->config.samples > 0) gReal.glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &drawn);
    if (read && read->config.samples > 0 && drawn == 0 && !t.context->compilingList)
        drawAll(t, by);
    else
        gather(t, x, y, w, h, planes, by);
}

void gatherNamed(ThreadState& t, GLint x, GLint y, GLsizei w, GLsizei h, GLbitfield planes, const char* by) {
    if (severalNodes(t)) readingWindow(t, [&] { gatherNow(t, x, y, w, h, planes, true, by); });
}

void drawAll(ThreadState& t, const char* by) {
    if (!severalNodes(t) || t.context->group->allDrawn) return;
    t.context->group->allDrawn = true;
    records::drawAll(t);
    const Window* window = findWindowById(t.context->readWindow);
    if (!window) return;
    // sends the pictures drawn by other nodes so far
    constexpr GLbitfield kAll = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
    const auto width = static_cast<GLsizei>(window->config.width), height = static_cast<GLsizei>(window->config.height);
    readingWindow(t, [&] { gatherNow(t, 0, 0, width, height, kAll, false, by); });
}

GLbitfield planesOf(GLenum internalFormat) {
    switch (internalFormat) {
    case GL_DEPTH_COMPONENT:
    case GL_DEPTH_COMPONENT16:
    case GL_DEPTH_COMPONENT24:
    case GL_DEPTH_COMPONENT32:
    case GL_DEPTH_COMPONENT32F: return GL_DEPTH_BUFFER_BIT;
    case GL_DEPTH_STENCIL:
    case GL_DEPTH24_STENCIL8:
    case GL_DEPTH32F_STENCIL8: return GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
    default: return GL_COLOR_BUFFER_BIT;
    }
}
GLbitfield planesOfBound(ThreadState& t, GLenum target, GLint level) {
    if (!gReal.glGetTexLevelParameteriv) return GL_COLOR_BUFFER_BIT;
    return planesInto(
        t, [=](GLint* format) { gReal.glGetTexLevelParameteriv(target, level, GL_TEXTURE_INTERNAL_FORMAT, format); });
}
GLbitfield planesOfTexture(ThreadState& t, GLuint texture, GLint level) {
    return planesInto(t, [=](GLint* format) {
        gReal.glGetTextureLevelParameteriv(texture, level, GL_TEXTURE_INTERNAL_FORMAT, format);
    });
}
GLbitfield planesOfTextureTarget(ThreadState& t, GLuint texture, GLenum target, GLint level) {
    return planesInto(t, [=](GLint* format) {
        gReal.glGetTextureLevelParameterivEXT(texture, target, level, GL_TEXTURE_INTERNAL_FORMAT, format);
    });
}
GLbitfield planesOfUnit(ThreadState& t, GLenum unit, GLenum target, GLint level) {
    return planesInto(t, [=](GLint* format) {
        gReal.glGetMultiTexLevelParameterivEXT(unit, target, level, GL_TEXTURE_INTERNAL_FORMAT, format);
    });
}

} // namespace mural::copies

extern "C" {

void mural_glCopyPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum type) {
    ThreadState& t = *tThread;
    const GLbitfield planes = type == GL_COLOR     ? GL_COLOR_BUFFER_BIT
                              : type == GL_DEPTH   ? GL_DEPTH_BUFFER_BIT
                              : type == GL_STENCIL ? GL_STENCIL_BUFFER_BIT
                                                   : GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
    copies::gatherForPixels(t, x, y, width, height, planes);
    encode_glCopyPixels(t, x, y, width, height, type);
    if (t.drawLocally || width < 0 || height < 0)
        gReal.glCopyPixels(x, y, width, height, type);
    else
        gReal.glCopyPixels(x, y, 0, 0, type);
}
void mural_glBlitFramebuffer(GLint srcX0, GLint srcY0, GLint srcX1, GLint srcY1, GLint dstX0, GLint dstY0, GLint dstX1,
                             GLint dstY1, GLbitfield mask, GLenum filter) {
    ThreadState& t = *tThread;
    const GLint x = srcX0 < srcX1 ? srcX0 : srcX1, y = srcY0 < srcY1 ? srcY0 : srcY1;
    const GLint w = srcX0 < srcX1 ? srcX1 - srcX0 : srcX0 - srcX1, h = srcY0 < srcY1 ? srcY1 - srcY0 : srcY0 - srcY1;
    copies::gather(t, x - 1, y - 1, w + 2, h + 2, mask); // linear filters read one pixel further
    encode_glBlitFramebuffer(t, srcX0, srcY0, srcX1, srcY1, dstX0, dstY0, dstX1, dstY1, mask, filter);
    if (t.drawLocally)
        return gReal.glBlitFramebuffer(srcX0, srcY0, srcX1, srcY1, dstX0, dstY0, dstX1, dstY1, mask, filter);
    quiet::blit({srcX0, srcY0, srcX1, srcY1}, {dstX0, dstY0, dstX1, dstY1},
                [&](const quiet::Area& from, const quiet::Area& to) {
                    gReal.glBlitFramebuffer(from.x0, from.y0, from.x1, from.y1, to.x0, to.y0, to.x1, to.y1, mask,
                                            filter);
                });
}
void mural_glBlitNamedFramebuffer(GLuint readFramebuffer, GLuint drawFramebuffer, GLint srcX0, GLint srcY0, GLint srcX1,
                                  GLint srcY1, GLint dstX0, GLint dstY0, GLint dstX1, GLint dstY1, GLbitfield mask,
                                  GLenum filter) {
    ThreadState& t = *tThread;
    if (readFramebuffer == 0) {
        const GLint x = srcX0 < srcX1 ? srcX0 : srcX1, y = srcY0 < srcY1 ? srcY0 : srcY1;
        const GLint w = srcX0 < srcX1 ? srcX1 - srcX0 : srcX0 - srcX1,
                    h = srcY0 < srcY1 ? srcY1 - srcY0 : srcY0 - srcY1;
        copies::gatherNamed(t, x - 1, y - 1, w + 2, h + 2, mask);
    }
    encode_glBlitNamedFramebuffer(t, readFramebuffer, drawFramebuffer, srcX0, srcY0, srcX1, srcY1, dstX0, dstY0, dstX1,
                                  dstY1, mask, filter);
    if (t.drawLocally)
        return gReal.glBlitNamedFramebuffer(readFramebuffer, drawFramebuffer, srcX0, srcY0, srcX1, srcY1, dstX0, dstY0,
                                            dstX1, dstY1, mask, filter);
    quiet::blit({srcX0, srcY0, srcX1, srcY1}, {dstX0, dstY0, dstX1, dstY1},
                [&](const quiet::Area& from, const quiet::Area& to) {
                    gReal.glBlitNamedFramebuffer(readFramebuffer, drawFramebuffer, from.x0, from.y0, from.x1, from.y1,
                                                 to.x0, to.y0, to.x1, to.y1, mask, filter);
                });
}
void mural_glBitmap(GLsizei width, GLsizei height, GLfloat xorig, GLfloat yorig, GLfloat xmove, GLfloat ymove,
                    const GLubyte* bitmap) {
    ThreadState& t = *tThread;
    buffersRead(t);
    encode_glBitmap(t, width, height, xorig, yorig, xmove, ymove,
                    imageSource(t, bitmap, GL_COLOR_INDEX, GL_BITMAP, width, height, 1, 2));
    // The raster position also moves in the program's own context, because an empty bitmap moves it as well.
    if (t.context && t.context->compilingList) {
        t.context->group->listsMoveRaster = true;
        t.context->group->listMovesRaster.set(t.context->compiledList, true);
    }
    const bool isError = width < 0 || height < 0;
    if (t.drawLocally || isError)
        gReal.glBitmap(width, height, xorig, yorig, xmove, ymove, bitmap);
    else
        gReal.glBitmap(0, 0, 0, 0, xmove, ymove, nullptr);
}

} // extern "C"
