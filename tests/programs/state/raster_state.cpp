// Rasterisation state: stipples, point and line sizes, smoothing, polygon modes and offsets, culling, scissor, logic
// operations, colour masks, dithering, alpha test, stencil operations, depth functions.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

void fan(float x, float y, float radius, int corners, float depth = 0) {
    glBegin(GL_TRIANGLE_FAN);
    for (int i = 0; i < corners; ++i) {
        Sequence numbers(unsigned(i) + unsigned(corners));
        glColor4f(numbers.unit(), numbers.unit(), numbers.unit(), 0.3F + 0.1F * float(i));
        const float dx[] = {0, 1, 0.6F, -0.3F, -1, -0.8F, 0.1F, 0.9F};
        const float dy[] = {-0.1F, 0, 0.9F, 1, 0.3F, -0.7F, -1, -0.4F};
        glVertex3f(x + radius * dx[i % 8], y + radius * dy[i % 8], depth + 0.05F * float(i));
    }
    glEnd();
}

void drawStipples(int frame) {
    GLubyte pattern[128];
    Sequence numbers(unsigned(frame) + 60);
    for (GLubyte& value : pattern) {
        value = numbers.byte();
    }
    glEnable(GL_POLYGON_STIPPLE);
    glPolygonStipple(pattern);
    fan(25, 25, 22, 7);
    glRectf(50, 5, 90.5F, 30);
    glDisable(GL_POLYGON_STIPPLE);
    GLubyte readBack[128] = {};
    glGetPolygonStipple(readBack);
    showBits(37, std::uint32_t(readBack[0]) | std::uint32_t(readBack[77]) << 8);
    glEnable(GL_LINE_STIPPLE);
    for (int i = 0; i < 4; ++i) {
        glLineStipple(i + 1, GLushort(0x3c57 + frame * 0x1111));
        glLineWidth(float(i) + 1);
        glColor3f(1, 0.3F * float(i), 0.2F);
        glBegin(i % 2 == 0 ? GL_LINE_STRIP : GL_LINE_LOOP);
        glVertex2f(5, 55 + float(i) * 9);
        glVertex2f(40.5F, 50 + float(i) * 9 + float(frame));
        glVertex2f(90, 60 + float(i) * 9);
        glEnd();
    }
    glDisable(GL_LINE_STIPPLE);
    glLineWidth(1);
}

void drawPointsAndLines(int frame) {
    for (int i = 0; i < 8; ++i) {
        if (i % 2 == 1) {
            glEnable(GL_POINT_SMOOTH);
            glEnable(GL_LINE_SMOOTH);
            glEnable(GL_BLEND);
        }
        glPointSize(float(i) * 1.7F + 1);
        glColor4f(0.2F, 1, 0.1F * float(i), 0.9F);
        glBegin(GL_POINTS);
        glVertex2f(100.3F + float(i) * 12, 10.4F + float(frame) * 1.3F);
        glEnd();
        glLineWidth(float(i) * 0.8F + 0.5F);
        glBegin(GL_LINES);
        glVertex2f(98 + float(i) * 12, 25);
        glVertex2f(106 + float(i * 14), 45.5F + float(frame) * 2);
        glEnd();
        glDisable(GL_POINT_SMOOTH);
        glDisable(GL_LINE_SMOOTH);
        glDisable(GL_BLEND);
    }
    glLineWidth(1);
    // Point sizes that depend on distance.
    const GLfloat attenuation[] = {1, 2, 5};
    glPointParameterfv(GL_POINT_DISTANCE_ATTENUATION, attenuation);
    glPointParameterf(GL_POINT_SIZE_MIN, 2);
    glPointParameterf(GL_POINT_FADE_THRESHOLD_SIZE, 3);
    glPointSize(20);
    glBegin(GL_POINTS);
    for (int i = 0; i < 6; ++i) {
        glVertex3f(105 + float(i) * 15, 55, -0.15F * float(i));
    }
    glEnd();
    const GLfloat none[] = {1, 0, 0};
    glPointParameterfv(GL_POINT_DISTANCE_ATTENUATION, none);
    glPointParameterf(GL_POINT_SIZE_MIN, 0);
    glPointSize(1);
}

void drawPolygonModes(int frame) {
    glEnable(GL_DEPTH_TEST);
    fan(215, 25, 22, 8);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glEnable(GL_POLYGON_OFFSET_LINE);
    glPolygonOffset(-1.5F, -2.0F - float(frame));
    fan(215, 25, 22, 8);
    glDisable(GL_POLYGON_OFFSET_LINE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
    glPointSize(5);
    glEnable(GL_POLYGON_OFFSET_POINT);
    fan(215, 25, 22, 8);
    glDisable(GL_POLYGON_OFFSET_POINT);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(3, 5);
    fan(218, 27, 24, 8);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDisable(GL_DEPTH_TEST);
    glPointSize(1);
    // Different polygon modes for the two sides, culled.
    glPolygonMode(GL_BACK, GL_LINE);
    glFrontFace(frame % 2 == 0 ? GL_CW : GL_CCW);
    fan(20, 110, 16, 7);
    glEnable(GL_CULL_FACE);
    glCullFace(frame % 3 == 0 ? GL_FRONT : GL_BACK);
    fan(55, 110, 16, 7);
    glDisable(GL_CULL_FACE);
    glFrontFace(GL_CCW);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glEnable(GL_POLYGON_SMOOTH);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    fan(85, 110, 13, 6);
    glDisable(GL_POLYGON_SMOOTH);
    glDisable(GL_BLEND);
    glShadeModel(GL_FLAT);
    fan(115, 110, 13, 7);
    glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
    fan(142, 110, 13, 7);
    glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
    glShadeModel(GL_SMOOTH);
}

void drawScissored(Window& window, int frame) {
    const int w = window.width();
    const int h = window.height();
    glEnable(GL_SCISSOR_TEST);
    for (int i = 0; i < 3; ++i) {
        glScissor(w * 2 / 3 + i * 17 + frame, h / 2 + i * 11, 15 + i * 3, 13);
        glClearColor(0.2F * float(i), 0.3F, 0.1F * float(frame), 1);
        glClear(GL_COLOR_BUFFER_BIT);
        fan(185, 115, 25, 8);
    }
    glScissor(w - 8, 0, 100, h); // beyond the edge
    glClearColor(0.8F, 0.8F, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
    // Another viewport, larger than the window.
    glViewport(-w / 2, h * 2 / 3, w * 2, h);
    fan(120, 20, 15, 8);
    glViewport(0, 0, w, h);
}

void drawLogicAndMasks(int frame) {
    const GLenum operations[] = {
        GL_CLEAR, GL_AND,   GL_AND_REVERSE, GL_COPY,       GL_AND_INVERTED,  GL_NOOP,        GL_XOR,  GL_OR,
        GL_NOR,   GL_EQUIV, GL_INVERT,      GL_OR_REVERSE, GL_COPY_INVERTED, GL_OR_INVERTED, GL_NAND, GL_SET};
    glColor3f(0.1F, 0.5F, 0.9F);
    glRectf(5, 130, 165, 136);
    glEnable(GL_COLOR_LOGIC_OP);
    for (int i = 0; i < 16; ++i) {
        glLogicOp(operations[i]);
        glColor3f(0.7F, 0.2F + 0.1F * float(frame), 0.4F);
        glRecti(5 + i * 10, 128, 13 + i * 10, 141);
    }
    glDisable(GL_COLOR_LOGIC_OP);
    for (int i = 0; i < 8; ++i) {
        glColorMask(i & 1 ? GL_TRUE : GL_FALSE, i & 2 ? GL_TRUE : GL_FALSE, i & 4 ? GL_TRUE : GL_FALSE, GL_TRUE);
        glColor3f(0.9F, 0.8F, 1);
        glRecti(170 + i * 9, 128, 177 + i * 9, 141);
    }
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glEnable(GL_ALPHA_TEST);
    glAlphaFunc(GL_GREATER, 0.5F + 0.05F * float(frame));
    fan(20, 160, 14, 8);
    glDisable(GL_ALPHA_TEST);
    glDisable(GL_DITHER);
    fan(48, 160, 13, 6);
    glEnable(GL_DITHER);
}

void drawStencilAndDepth(int frame) {
    glEnable(GL_STENCIL_TEST);
    glStencilMask(0x7f);
    glStencilFunc(GL_ALWAYS, 3, 0xff);
    glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_KEEP, GL_INCR_WRAP);
    glStencilOpSeparate(GL_BACK, GL_KEEP, GL_KEEP, GL_DECR_WRAP);
    fan(90, 160, 20, 8);
    fan(95, 158, 14, 7);
    glStencilFuncSeparate(GL_FRONT_AND_BACK, GL_EQUAL, 2, 0x3);
    glStencilOp(GL_INVERT, GL_KEEP, GL_REPLACE);
    glColor3f(1, 1, 1);
    glRecti(65, 142, 115, 178);
    glStencilFunc(GL_NOTEQUAL, 0, 0x80);
    glStencilOp(GL_KEEP, GL_KEEP, GL_ZERO);
    glColor3f(0, 0.5F, 0);
    glRecti(75, 150, 120, 178 + frame);
    glDisable(GL_STENCIL_TEST);
    glStencilMask(0xff);
    const GLenum functions[] = {GL_NEVER, GL_LESS, GL_EQUAL, GL_LEQUAL, GL_GREATER, GL_NOTEQUAL, GL_GEQUAL, GL_ALWAYS};
    glEnable(GL_DEPTH_TEST);
    for (int i = 0; i < 8; ++i) {
        const float x = 125 + float(i) * 15;
        glDepthFunc(GL_ALWAYS);
        glColor3f(0.3F, 0.3F, 0.3F);
        glRectf(x, 145, x + 13, 178);
        glDepthFunc(functions[i]);
        glDepthMask(i % 2 == 0 ? GL_TRUE : GL_FALSE);
        glDepthRange(0.1, 0.9);
        fan(x + 6, 162, 9, 8, -0.2F);
        glDepthRange(0, 1);
        fan(x + 5, 158 + float(frame), 9, 7, 0.1F);
        glDepthMask(GL_TRUE);
    }
    glDepthFunc(GL_LESS);
    glDisable(GL_DEPTH_TEST);
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {}, [](Window&) {},
        [](Window& window, int frame) {
            glViewport(0, 0, window.width(), window.height());
            glClearColor(0.1F, 0.12F, 0.14F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
            glMatrixMode(GL_PROJECTION);
            glLoadIdentity();
            glOrtho(0, 250, 0, 190, -1, 1);
            drawStipples(frame);
            drawPointsAndLines(frame);
            drawPolygonModes(frame);
            drawScissored(window, frame);
            drawLogicAndMasks(frame);
            drawStencilAndDepth(frame);
        });
}
