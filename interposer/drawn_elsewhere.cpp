#include "interposer/drawn_elsewhere.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <cstdlib>
#include <cstring>

#include "interposer/asking.hpp"
#include "interposer/bypass.hpp"
#include "interposer/context.hpp"
#include "interposer/real_gl.hpp"
#include "interposer/session.hpp"

namespace mural {

namespace {

// State is proof at once. A picture is proof only when it stays: new memory may hold anything.
constexpr int kEmptyFrames = 3;

// With no call of the program's in the stream, every state must be as it was at first.
bool stateChanged(const Context& c) {
    GLint program = 0, buffer = 0, texture = 0;
    GLfloat clear[4] = {};
    gReal.glGetFloatv(GL_COLOR_CLEAR_VALUE, clear);
    gReal.glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture);
    if (c.version >= 20) gReal.glGetIntegerv(GL_CURRENT_PROGRAM, &program);
    if (c.version >= 20) gReal.glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &buffer);
    bool enabled = false;
    for (const GLenum what : {GL_DEPTH_TEST, GL_BLEND, GL_CULL_FACE, GL_SCISSOR_TEST}) enabled = enabled || gReal.glIsEnabled(what);
    return program || buffer || texture || enabled || clear[0] != 0 || clear[1] != 0 || clear[2] != 0 || clear[3] != 0;
}

// Whether the back buffer holds more than one colour, by its lines in the middle of 16 parts.
bool hasPicture(const Window& w) {
    const auto width = static_cast<GLsizei>(w.config.width), height = static_cast<GLsizei>(w.config.height);
    auto* line = static_cast<uint32_t*>(std::calloc(w.config.width, 4));
    if (!line) return false;
    bool first = true, several = false;
    uint32_t colour = 0;
    for (GLsizei i = 0; i < 16 && !several; ++i) {
        gReal.glReadPixels(0, height * (2 * i + 1) / 32, width, 1, GL_RGBA, GL_UNSIGNED_BYTE, line);
        if (first) colour = line[0];
        first = false;
        for (GLsizei x = 0; x < width; ++x) several = several || line[x] != colour;
    }
    std::free(line);
    return several;
}

} // namespace

void noteCalls(ThreadState& t) {
    if (t.context && t.cursor != t.context->quietSince) t.context->called = true;
}

void watchFromHere(ThreadState& t) {
    if (!t.context->called) t.context->quietSince = t.cursor;
}

bool drawnElsewhere(ThreadState& t, const Window& w) {
    Context& c = *t.context;
    noteCalls(t);
    if (c.called || c.drawWindow != w.id || !w.config.width) return false;
    const bool proof = stateChanged(c) || (++c.emptyFrames >= kEmptyFrames && hasPicture(w));
    takeError(c);
    if (!proof) return false;
    const char* library = loadedOwnGl();
    sayBypass("the program shows pictures, but its GL calls go past Mural%s%s: its window shows its own picture from now on. "
              "Try --front preload", library ? ", by " : "", library ? library : "");
    return true;
}

} // namespace mural
