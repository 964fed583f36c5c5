#include "interposer/diagnostics/bypass_detector.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <cstdlib>
#include <cstring>

#include "interposer/readback/node_requests.hpp"
#include "interposer/readback/back_buffer.hpp"
#include "interposer/diagnostics/bypass.hpp"
#include "interposer/context/context.hpp"
#include "interposer/entry/loaded_gl.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"

namespace mural {

namespace {

// A state change proves draws past the library at once. A picture proves them only if it persists, because fresh memory
// may contain anything.
constexpr int kEmptyFrames = 3;

// If the stream contains no call of the program, every state must have its initial value.
bool stateChanged(const Context& c) {
    GLint program = 0, buffer = 0, texture = 0;
    GLfloat clear[4] = {};
    gReal.glGetFloatv(GL_COLOR_CLEAR_VALUE, clear);
    gReal.glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture);
    if (c.version >= 20) gReal.glGetIntegerv(GL_CURRENT_PROGRAM, &program);
    if (c.version >= 20) gReal.glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &buffer);
    bool enabled = false;
    for (const GLenum what : {GL_DEPTH_TEST, GL_BLEND, GL_CULL_FACE, GL_SCISSOR_TEST})
        enabled = enabled || gReal.glIsEnabled(what);
    driverError(); // from a query that this version lacks
    return program || buffer || texture || enabled || clear[0] != 0 || clear[1] != 0 || clear[2] != 0 || clear[3] != 0;
}

// Whether the back buffer has more than one colour, sampled on the middle lines of 16 parts.
bool hasPicture(Context& c, const Window& w) {
    const BackBufferRead read(c, w, BackBufferRead::Where::Here);
    if (!read.ready()) return false;
    const auto width = static_cast<GLsizei>(w.config.width), height = static_cast<GLsizei>(w.config.height);
    auto* line = static_cast<uint32_t*>(std::calloc(w.config.width, 4));
    if (!line) return false;
    bool first = true, several = false;
    uint32_t colour = 0;
    for (GLsizei i = 0; i < 16 && !several; ++i) {
        read.pixels(0, height * (2 * i + 1) / 32, width, 1, line);
        if (first) colour = line[0];
        first = false;
        for (GLsizei x = 0; x < width; ++x) several = several || line[x] != colour;
    }
    std::free(line);
    return several;
}

void reportPartialBypass() {
    char libraries[700];
    const bool any = librariesPastUs(libraries, sizeof libraries);
    reportBypass(
        "some GL calls of the program bypass Mural (through names of %s): its own window shows the picture from "
        "now on. Try LD_PRELOAD=libGL.so.1, which resolves GLVND's names before those of a linked library",
        any ? libraries : "its driver");
}

} // namespace

void recordCalls(ThreadState& t) {
    if (t.context && t.cursor != t.context->quietSince) t.context->called = true;
}

void watchFromHere(ThreadState& t) {
    if (!t.context->called) t.context->quietSince = t.cursor;
}

bool bypassesCapture(ThreadState& t, Window& w) {
    Context& c = *t.context;
    recordCalls(t);
    const bool changed = backBufferChanged(t, w);
    if (c.called) {
        w.drawnInPart = changed;
        if (changed) reportPartialBypass();
        return changed;
    }
    if (c.drawWindow != w.id || !w.config.width) return false;
    const bool proof = changed || stateChanged(c) || (++c.emptyFrames >= kEmptyFrames && hasPicture(c, w));
    if (!proof) return false;
    const char* library = loadedOwnGl();
    reportBypass("the GL calls of the program bypass Mural%s%s: its own window shows the picture from now on. Try "
                 "--capture-via preload",
                 library ? ", by " : "", library ? library : "");
    return true;
}

} // namespace mural
