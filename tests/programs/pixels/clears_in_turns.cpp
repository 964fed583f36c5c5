// Frames that begin with different clears in one window: a whole clear, several, clears that only appear whole, partial
// ones, none. The drawn contents affect the next frame or not. Pixels, depths and samples are read and copied in
// between. From frame 24 on the front buffer is drawn into; from frame 30 on the picture accumulates.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <cstdlib>
#include <vector>

using namespace programs;

namespace {

constexpr int kFrontFrom = 24, kAccumFrom = 30;
constexpr int kCopied = 60; // pixels per side

struct State {
    GLuint texture = 0, query = 0, clears = 0, draws = 0; // the last two are display lists
};
State state;

void values(int frame) {
    glClearColor(0.1F * float(frame % 7), 0.07F * float(frame % 11), 0.3F, 1);
    glClearDepth(frame % 3 == 0 ? 1 : 0.9);
    glClearStencil(frame % 4);
}

constexpr GLbitfield kAll = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;

void triangles(int frame, int count) {
    Sequence numbers(unsigned(frame) + 90);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 3 * count; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex3f(numbers.unit() * 2 - 1, numbers.unit() * 2 - 1, numbers.unit() * 2 - 1);
    }
    glEnd();
}

void whole(int) { glClear(kAll); }
void one(int) {
    glClear(GL_DEPTH_BUFFER_BIT);
    glClear(GL_STENCIL_BUFFER_BIT);
    glClear(GL_COLOR_BUFFER_BIT);
}
void withDrawsBetween(int frame) {
    glClear(GL_COLOR_BUFFER_BIT);
    triangles(frame + 5, 2);
    glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}
void twice(int frame) {
    glClear(kAll);
    triangles(frame + 3, 6);
    values(frame + 1);
    glClear(kAll);
}
void withoutStencil(int) { glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT); }
void coloursOnly(int) { glClear(GL_COLOR_BUFFER_BIT); }
void nothing(int) {}
void within(int) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(20, 15, 150, 90);
    glClear(kAll);
    glDisable(GL_SCISSOR_TEST);
}
void masked(int) {
    glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_FALSE);
    glStencilMask(2);
    glClear(kAll);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glStencilMask(~0U);
}
void refused(int) { // each of these clears nothing
    glClear(kAll | 1U);
    glBegin(GL_LINES);
    glClear(kAll);
    glEnd();
    while (glGetError() != GL_NO_ERROR) {}
    GLuint hits[8] = {};
    glSelectBuffer(8, hits);
    glRenderMode(GL_SELECT);
    glClear(kAll);
    glRenderMode(GL_RENDER);
}
void inList(int) { glCallList(state.clears); }
void byBuffers(int frame) {
    const GLfloat colour[] = {0.2F, 0.05F * float(frame % 9), 0.5F, 1};
    glClearBufferfi(GL_DEPTH_STENCIL, 0, 0.95F, 1);
    glClearBufferfv(GL_COLOR, 0, colour);
}
void byOtherBuffers(int) { // colours of a missing draw buffer
    const GLfloat colour[] = {1, 1, 0, 1};
    glClearBufferfi(GL_DEPTH_STENCIL, 0, 0.95F, 1);
    glClearBufferfv(GL_COLOR, 1, colour);
}
void compiled(int) { // and executed
    const GLuint list = glGenLists(1);
    glNewList(list, GL_COMPILE_AND_EXECUTE);
    glClear(kAll);
    triangles(7, 2);
    glEndList();
    glDeleteLists(list, 1);
}
void pushed(int) {
    glPushAttrib(GL_ALL_ATTRIB_BITS);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, 90, 200);
    glClear(GL_COLOR_BUFFER_BIT);
    glPopAttrib();
    glClear(kAll);
}
using Begin = void (*)(int frame);
constexpr Begin kBegins[] = {whole,    one,       withDrawsBetween, whole,          withoutStencil, twice,
                             nothing,  whole,     masked,           whole,          within,         refused,
                             inList,   byBuffers, nothing,          byOtherBuffers, whole,          coloursOnly,
                             compiled, pushed,    withoutStencil,   byBuffers,      coloursOnly};

void scene(int frame) {
    glEnable(GL_DEPTH_TEST);
    if (frame % 5 == 1) {
        glEnable(GL_STENCIL_TEST);
        glStencilFunc(GL_ALWAYS, frame % 3, 255);
        glStencilOp(GL_KEEP, GL_INVERT, GL_REPLACE);
    }
    triangles(frame, 6);
    if (frame % 5 == 2) { // where the stencil may be left over from an earlier frame
        glEnable(GL_STENCIL_TEST);
        glStencilFunc(GL_EQUAL, frame % 3, 255);
        glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
        triangles(frame + 33, 8);
    }
    glDisable(GL_STENCIL_TEST);
    if (frame % 4 == 2) glCallList(state.draws);
    glDisable(GL_DEPTH_TEST);
}

void showPixels(int x, int y, const std::vector<GLubyte>& pixels) {
    glWindowPos2i(x, y);
    glDrawPixels(kCopied, kCopied, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
}

std::vector<GLubyte> pixelsOf(GLenum buffer, int x, int y) {
    std::vector<GLubyte> pixels(kCopied * kCopied * 4);
    glReadBuffer(buffer);
    glReadPixels(x, y, kCopied, kCopied, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    glReadBuffer(GL_BACK);
    return pixels;
}

void showTexture(float x, float y) {
    glEnable(GL_TEXTURE_2D);
    glColor3f(1, 1, 1);
    glBegin(GL_QUADS);
    glTexCoord2f(0, 0), glVertex2f(x, y);
    glTexCoord2f(1, 0), glVertex2f(x + 0.4F, y);
    glTexCoord2f(1, 1), glVertex2f(x + 0.4F, y + 0.4F);
    glTexCoord2f(0, 1), glVertex2f(x, y + 0.4F);
    glEnd();
    glDisable(GL_TEXTURE_2D);
}

void setUp(Window&) {
    glGenTextures(1, &state.texture);
    glBindTexture(GL_TEXTURE_2D, state.texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glGenQueries(1, &state.query);
    state.clears = glGenLists(2);
    state.draws = state.clears + 1;
    glNewList(state.clears, GL_COMPILE);
    glClear(kAll);
    glEndList();
    glNewList(state.draws, GL_COMPILE);
    glPushAttrib(GL_ENABLE_BIT);
    glEnable(GL_STENCIL_TEST);
    triangles(4, 3);
    glPopAttrib();
    glEndList();
    glClear(kAll);
}

void draw(Window& window, int frame) {
    const int x = (13 * frame) % (window.width() - kCopied), y = (29 * frame) % (window.height() - kCopied);
    // Drivers differ in the front buffer's contents after a swap: it is read only with CLEARS_FRONT.
    static const bool readsFront = std::getenv("CLEARS_FRONT") != nullptr;
    const GLenum shown = readsFront && frame > 0 && frame < kFrontFrom ? GL_FRONT : GL_BACK;
    // the back buffer after a swap: contents of the previous frame
    const std::vector<GLubyte> before = pixelsOf(shown, x, y);
    const bool counts = frame % 3 == 0;
    values(frame);
    if (counts) glBeginQuery(GL_SAMPLES_PASSED, state.query);
    kBegins[static_cast<size_t>(frame) % std::size(kBegins)](frame);
    scene(frame);
    if (counts) glEndQuery(GL_SAMPLES_PASSED);
    if (frame % 4 == 1)
        showPixels(10, 10, pixelsOf(shown, y % (window.width() - kCopied), x % (window.height() - kCopied)));
    if (frame % 6 == 3) {
        glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, x, y, kCopied, kCopied, 0);
        showTexture(-0.9F, 0.2F);
    }
    if (frame % 6 == 4) {
        std::vector<GLfloat> depths(kCopied * kCopied);
        glReadPixels(x, y, kCopied, kCopied, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
        glWindowPos2i(100, 20);
        glDrawPixels(kCopied, kCopied, GL_LUMINANCE, GL_FLOAT, depths.data());
        glWindowPos2i(y, x % (window.height() - 20));
        glCopyPixels(x, y, kCopied, kCopied, GL_COLOR);
    }
    if (frame % 5 == 0) showPixels(120, 70, before);
    if (counts) {
        GLuint samples = 0;
        glGetQueryObjectuiv(state.query, GL_QUERY_RESULT, &samples);
        showBits(1, samples);
    }
    if (frame >= kFrontFrom && frame % 2 == 0) {
        glDrawBuffer(GL_FRONT);
        glClear(GL_COLOR_BUFFER_BIT);
        triangles(frame + 60, 2);
        const auto drawn = pixelsOf(GL_FRONT, x, y);
        glDrawBuffer(GL_BACK);
        showPixels(60, 60, drawn);
    }
    if (frame >= kAccumFrom) {
        glAccum(frame % 3 == 0 ? GL_LOAD : GL_ACCUM, 0.4F);
        if (frame % 3 == 2) glAccum(GL_RETURN, 1);
    }
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec;
    spec.accum = 16;
    return runInGlxWindow(argc, argv, spec, setUp, draw);
}
