// A window without depth and stencil buffers, with blended rectangles of two triangles each and a few other triangles.
// Mesa's software driver draws a block of 64x64 pixels with another code path if it contains only rectangles. The two
// paths round colours differently. Some frames copy, read, and clear in between; one counts samples.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <array>
#include <vector>

using namespace programs;

namespace {

constexpr int kLists = 6, kRectangles = 20, kCopied = 40;
GLuint texture;

struct Vertices {
    std::vector<float> places, colours;
    void add(float x, float y, const std::array<float, 4>& colour) {
        places.insert(places.end(), {x, y});
        colours.insert(colours.end(), colour.begin(), colour.end());
    }
};

void addRectangle(Vertices& v, Sequence& s) {
    const float x = 2.2F * s.unit() - 1.2F, y = 2.2F * s.unit() - 1.2F, right = x + 0.1F + 0.6F * s.unit(),
                top = y + 0.1F + 0.6F * s.unit();
    const std::array<float, 4> colour{s.unit(), s.unit(), s.unit(), 0.2F + 0.6F * s.unit()};
    v.add(x, y, colour);
    v.add(right, y, colour);
    v.add(right, top, colour);
    v.add(x, y, colour);
    v.add(right, top, colour);
    v.add(x, top, colour);
}

void addTriangle(Vertices& v, Sequence& s) {
    const float x = 2 * s.unit() - 1, y = 2 * s.unit() - 1;
    for (const std::array<float, 2> corner : {std::array{0.0F, 0.0F}, {0.06F, 0.01F}, {0.02F, 0.07F}})
        v.add(x + corner[0], y + corner[1], {1, 1, 0, 0.5F});
}

// Two more triangles keep the number of vertices a multiple of six, without which no pair of triangles is a rectangle.
Vertices listOf(int number, Sequence& s) {
    Vertices v;
    for (int i = 0; i < kRectangles; ++i) addRectangle(v, s);
    for (int i = 0; i < (number % 3 == 0 ? 2 : 0); ++i) addTriangle(v, s);
    return v;
}

Vertices oddTriangle(Sequence& s) {
    Vertices v;
    addTriangle(v, s);
    return v;
}

void drawList(const Vertices& v) {
    glVertexPointer(2, GL_FLOAT, 0, v.places.data());
    glColorPointer(4, GL_FLOAT, 0, v.colours.data());
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(v.places.size() / 2));
}

void drawLists(int frame) {
    Sequence s(static_cast<unsigned>(frame) + 3);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    for (int i = 0; i < kLists; ++i) drawList(listOf(i, s));
    drawList(oddTriangle(s));
    glDisableClientState(GL_COLOR_ARRAY);
    glDisableClientState(GL_VERTEX_ARRAY);
}

void drawAndCount(int frame) {
    GLuint query = 0, samples = 0;
    glGenQueries(1, &query);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    drawLists(frame);
    glEndQuery(GL_SAMPLES_PASSED);
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &samples);
    glDeleteQueries(1, &query);
    showBits(1, samples);
}

// Ends a scene of the driver in the middle of a frame: a copy, a read, and clears and draws inside a scissor box.
void drawBetweenScenes(const Window& window, int frame) {
    glBindTexture(GL_TEXTURE_2D, texture);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, window.width() / 2 - kCopied / 2, window.height() / 2 - kCopied / 2,
                        kCopied, kCopied);
    drawLists(frame + 10);
    GLubyte pixel[4];
    glReadPixels(5, 5, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    drawLists(frame + 20);
    glEnable(GL_SCISSOR_TEST);
    glScissor(20, 30, 100, 70);
    glClearColor(0.5F, 0.5F, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    drawLists(frame + 30);
    glDisable(GL_SCISSOR_TEST);
    drawLists(frame + 40);
}

void setUp(Window&) {
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kCopied, kCopied, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
}

void draw(Window& window, int frame) {
    glViewport(0, 0, window.width(), window.height());
    glClearColor(0.1F, 0.2F, 0.3F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    drawLists(frame);
    if (frame == 0 || frame == 3) drawBetweenScenes(window, frame);
    if (frame == 2) drawAndCount(frame);
    glDisable(GL_BLEND);
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec;
    spec.depth = 0;
    spec.stencil = 0;
    return MURAL_RUN(argc, argv, spec, setUp, draw);
}
