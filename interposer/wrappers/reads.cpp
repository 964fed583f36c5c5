// Reads of pixels and texture images. The nodes draw them, so the nodes answer.
#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/wrappers/validate_only_draws.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/wrappers/image_reads.hpp"
#include "interposer/context/context.hpp"
#include "interposer/memory/mapped_buffers.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/memory/pixel_store.hpp"
#include "interposer/readback/read_area.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"
#include "interposer/context/window_size.hpp"

using namespace mural;
using namespace mural::image_reads;

namespace {

// The program's own GL draws pixmaps, too, so it can read them locally. Drivers may give a pixmap a single buffer,
// whatever its configuration says. A bound pack buffer belongs to the nodes as well.
bool readsOwnPixmap(Context& c) {
    if (!c.drawsPixmap || c.readWindow != c.drawWindow || packBufferBound(c)) return false;
    return readsWindow(c);
}
// Drivers check the pack buffer only if there is something to read.
bool outOfPackBuffer(Context& c, GLsizei width, GLsizei height, GLenum format, GLenum type, const void* offset) {
    if (!packBufferBound(c) || width == 0 || height == 0) return false;
    const sizes::ImageLayout layout = sizes::layoutOf(packStore(c), format, type, width, height, 1, 2);
    return layout.known && !quiet::withinBuffer(GL_PIXEL_PACK_BUFFER, GL_PIXEL_PACK_BUFFER_BINDING,
                                                reinterpret_cast<uint64_t>(offset), sizes::spanBytes(layout));
}

void readPixels(ThreadState& t, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type,
                void* pixels, const char* by = __builtin_FUNCTION()) {
    Context& c = *t.context;
    if (readsOwnPixmap(c)) {
        gReal.glReadPixels(x, y, width, height, format, type, pixels);
        return;
    }
    ReadArea clip{x, y, width, height};
    const bool reads = cutToReadFramebuffer(c, format, type, clip);
    beforeAwaitedReading(t); // Mesa clips the rectangle first, and then resizes its buffers
    if (!reads) return;
    sizes::PixelStore store = packStore(c);
    if (store.rowLength == 0) store.rowLength = width; // clipped rows keep their stride
    store.skipPixels += clip.x - x;
    store.skipRows += clip.y - y;
    const sizes::ImageLayout layout = sizes::layoutOf(store, format, type, clip.w, clip.h, 1, 2);
    if (packBufferBound(c)) {
        if (layout.known && deferPixels(t, clip, format, type, {reinterpret_cast<uint64_t>(pixels), layout}, by))
            return;
        settleBound(t, GL_PIXEL_PACK_BUFFER, by);
    }
    const void* tight = requestPixels(t, clip.x, clip.y, clip.w, clip.h, format, type, 0, by);
    if (!tight) {
        // the nodes cannot answer; without a session an error is raised
        if (capturing(t)) gReal.glReadPixels(x, y, width, height, format, type, pixels);
        return;
    }
    if (layout.known) deliver(t, tight, pixels, layout);
}

void readTexture(ThreadState& t, bool byName, GLuint which, GLint level, GLenum format, GLenum type, void* pixels,
                 const Level& size, int dimensions, const char* by = __builtin_FUNCTION()) {
    const size_t bytes = sizes::tightBytes(format, type, size.width, size.height, size.depth);
    const sizes::ImageLayout layout =
        sizes::layoutOf(packStore(*t.context), format, type, size.width, size.height, size.depth, dimensions);
    requestAndDeliver(t, {byName, which, level, format, type, bytes}, pixels, layout, by);
}

// Executes the driver's own call first. It raises errors, and returns data in case the nodes have no reply.
template <class Local>
void readBound(GLenum target, GLint level, GLenum format, GLenum type, void* pixels, Local&& local,
               const char* by = __builtin_FUNCTION()) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return local();
    if (!packsAhead(t, local)) return;
    const Level size =
        levelOf([=](GLenum pname, GLint* value) { gReal.glGetTexLevelParameteriv(target, level, pname, value); });
    readTexture(t, false, target, level, format, type, pixels, size, imageDimensions(target), by);
}

} // namespace

extern "C" {

void mural_glReadPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type, void* pixels) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return gReal.glReadPixels(x, y, width, height, format, type, pixels);
    const bool isError = width < 0 || height < 0 || outOfPackBuffer(*t.context, width, height, format, type, pixels);
    const bool valid = raisesNothing(
        *t.context, [&] { gReal.glReadPixels(x, y, isError ? width : 0, isError ? height : 0, format, type, pixels); });
    if (valid) readPixels(t, x, y, width, height, format, type, pixels);
}

void mural_glReadnPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type, GLsizei bufSize,
                         void* data) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return gReal.glReadnPixels(x, y, width, height, format, type, bufSize, data);
    // The driver's own read checks bufSize. Its pixels are overwritten.
    const bool valid = packsAhead(t, [&] { gReal.glReadnPixels(x, y, width, height, format, type, bufSize, data); });
    if (valid) readPixels(t, x, y, width, height, format, type, data);
}

void mural_glGetTexImage(GLenum target, GLint level, GLenum format, GLenum type, void* pixels) {
    readBound(target, level, format, type, pixels, [=] { gReal.glGetTexImage(target, level, format, type, pixels); });
}
void mural_glGetnTexImage(GLenum target, GLint level, GLenum format, GLenum type, GLsizei bufSize, void* pixels) {
    readBound(target, level, format, type, pixels,
              [=] { gReal.glGetnTexImage(target, level, format, type, bufSize, pixels); });
}
void mural_glGetnTexImageARB(GLenum target, GLint level, GLenum format, GLenum type, GLsizei bufSize, void* img) {
    readBound(target, level, format, type, img,
              [=] { gReal.glGetnTexImageARB(target, level, format, type, bufSize, img); });
}

void mural_glGetTextureImage(GLuint texture, GLint level, GLenum format, GLenum type, GLsizei bufSize, void* pixels) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return gReal.glGetTextureImage(texture, level, format, type, bufSize, pixels);
    if (!packsAhead(t, [&] { gReal.glGetTextureImage(texture, level, format, type, bufSize, pixels); })) return;
    GLenum target = 0;
    const Level size = levelOf(*t.context, texture, level, target);
    readTexture(t, true, texture, level, format, type, pixels, size, dimensionsByName(target));
}

void mural_glGetTextureImageEXT(GLuint texture, GLenum target, GLint level, GLenum format, GLenum type, void* pixels) {
    ThreadState& t = *tThread;
    const auto local = [&] { gReal.glGetTextureImageEXT(texture, target, level, format, type, pixels); };
    if (!capturing(t) || t.context->compilingList) return local();
    if (!packsAhead(t, local)) return;
    const Level size = levelOf([&](GLenum pname, GLint* value) {
        gReal.glGetTextureLevelParameterivEXT(texture, target, level, pname, value);
    });
    whileBound(t, target, texture, [&] {
        readTexture(t, false, target, level, format, type, pixels, size, imageDimensions(target),
                    "glGetTextureImageEXT");
    });
}

void mural_glGetMultiTexImageEXT(GLenum texunit, GLenum target, GLint level, GLenum format, GLenum type, void* pixels) {
    ThreadState& t = *tThread;
    const auto local = [&] { gReal.glGetMultiTexImageEXT(texunit, target, level, format, type, pixels); };
    if (!capturing(t) || t.context->compilingList) return local();
    if (!packsAhead(t, local)) return;
    const Level size = levelOf([&](GLenum pname, GLint* value) {
        gReal.glGetMultiTexLevelParameterivEXT(texunit, target, level, pname, value);
    });
    whileActive(t, texunit, [&] {
        readTexture(t, false, target, level, format, type, pixels, size, imageDimensions(target),
                    "glGetMultiTexImageEXT");
    });
}

// Reads a part: requests the whole level and copies the part out of it.
void mural_glGetTextureSubImage(GLuint texture, GLint level, GLint xoffset, GLint yoffset, GLint zoffset, GLsizei width,
                                GLsizei height, GLsizei depth, GLenum format, GLenum type, GLsizei bufSize,
                                void* pixels) {
    ThreadState& t = *tThread;
    const auto local = [&] {
        gReal.glGetTextureSubImage(texture, level, xoffset, yoffset, zoffset, width, height, depth, format, type,
                                   bufSize, pixels);
    };
    if (!capturing(t)) return local();
    if (!packsAhead(t, local)) return;
    if (width <= 0 || height <= 0 || depth <= 0) return;
    GLenum target = 0;
    const Level size = levelOf(*t.context, texture, level, target);
    const size_t whole = sizes::tightBytes(format, type, size.width, size.height, size.depth);
    const sizes::ImageLayout layout =
        sizes::layoutOf(packStore(*t.context), format, type, width, height, depth, dimensionsByName(target));
    const ImagePart part{size, {xoffset, yoffset, zoffset}, {width, height, depth}, sizes::groupBytes(format, type)};
    requestAndDeliver(t, {true, texture, level, format, type, whole, part}, pixels, layout, __func__);
}

} // extern "C"
