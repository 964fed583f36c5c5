// State queries with packed results. The program's own context answers; the nodes' copy of a bound pack buffer receives
// the same bytes.
#include "custom_wrappers.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/wrappers/image_reads.hpp"
#include "interposer/memory/pixel_store.hpp"
#include "interposer/encode/session.hpp"

using namespace mural;
using namespace mural::image_reads;

namespace {

// span() returns the number of bytes that the query writes.
template <class Local, class Span> void packed(const void* values, Local&& local, Span&& span, const char* by) {
    ThreadState& t = *tThread;
    if (!capturing(t) || !packBufferBound(*t.context)) return local();
    if (packsHere(t, local, by)) sendPackBuffer(t, values, span());
}

template <class Value, class Local>
void pixelMap(GLenum map, const Value* values, Local&& local, const char* by = __builtin_FUNCTION()) {
    packed(
        values, local,
        [=] {
            GLint count = 0;
            gReal.glGetIntegerv(GL_PIXEL_MAP_I_TO_I_SIZE + (map - GL_PIXEL_MAP_I_TO_I), &count);
            return static_cast<size_t>(count) * sizeof(Value);
        },
        by);
}

template <class Local> void stipple(const void* pattern, Local&& local, const char* by = __builtin_FUNCTION()) {
    packed(
        pattern, local,
        [] {
            return sizes::spanBytes(
                sizes::layoutOf(packStore(*tThread->context), GL_COLOR_INDEX, GL_BITMAP, 32, 32, 1, 2));
        },
        by);
}

} // namespace

extern "C" {

void mural_glGetPixelMapfv(GLenum map, GLfloat* values) {
    pixelMap(map, values, [=] { gReal.glGetPixelMapfv(map, values); });
}
void mural_glGetPixelMapuiv(GLenum map, GLuint* values) {
    pixelMap(map, values, [=] { gReal.glGetPixelMapuiv(map, values); });
}
void mural_glGetPixelMapusv(GLenum map, GLushort* values) {
    pixelMap(map, values, [=] { gReal.glGetPixelMapusv(map, values); });
}
void mural_glGetnPixelMapfvARB(GLenum map, GLsizei bufSize, GLfloat* values) {
    pixelMap(map, values, [=] { gReal.glGetnPixelMapfvARB(map, bufSize, values); });
}
void mural_glGetnPixelMapuivARB(GLenum map, GLsizei bufSize, GLuint* values) {
    pixelMap(map, values, [=] { gReal.glGetnPixelMapuivARB(map, bufSize, values); });
}
void mural_glGetnPixelMapusvARB(GLenum map, GLsizei bufSize, GLushort* values) {
    pixelMap(map, values, [=] { gReal.glGetnPixelMapusvARB(map, bufSize, values); });
}
void mural_glGetPolygonStipple(GLubyte* mask) {
    stipple(mask, [=] { gReal.glGetPolygonStipple(mask); });
}
void mural_glGetnPolygonStippleARB(GLsizei bufSize, GLubyte* pattern) {
    stipple(pattern, [=] { gReal.glGetnPolygonStippleARB(bufSize, pattern); });
}

} // extern "C"
