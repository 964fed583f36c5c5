// Feedback and selection. Their results are drawn, so a wrong hit or coordinate is a wrong pixel.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

void drawObjects(int frame, bool named) {
    Sequence numbers(unsigned(frame) + 4);
    for (GLuint i = 0; i < 12; ++i) {
        if (named) {
            glLoadName(i + 100);
            glPushName(i % 3);
        }
        const float x = numbers.unit() * 200;
        const float y = numbers.unit() * 80;
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glBegin(i % 4 == 0 ? GL_LINES : GL_TRIANGLES);
        glVertex3f(x, y, numbers.unit());
        glVertex3f(x + 40, y + 5, -numbers.unit());
        if (i % 4 != 0) {
            glVertex3f(x + 15, y + 35, numbers.unit() * 0.5F);
        }
        glEnd();
        if (named) {
            glPopName();
        }
    }
}

void setProjection(double left, double right, double bottom, double top) {
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glOrtho(left, right, bottom, top, -1, 1);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
}

// Selects everything within a small box, as picking does.
void select(int frame) {
    GLuint hits[256] = {};
    glSelectBuffer(256, hits);
    glRenderMode(GL_SELECT);
    glInitNames();
    glPushName(0);
    setProjection(60 + frame * 10, 110 + frame * 10, 20, 60);
    drawObjects(frame, true);
    const GLint count = glRenderMode(GL_RENDER);
    setProjection(0, 250, 0, 190);
    showBits(30, std::uint32_t(count));
    for (int i = 0; i < 7; ++i) {
        showBits(22 + i, hits[i]);
    }
}

void feedBack(int frame) {
    GLfloat values[1024] = {};
    glFeedbackBuffer(1024, GL_3D_COLOR, values);
    glRenderMode(GL_FEEDBACK);
    glPassThrough(float(frame) + 0.5F);
    drawObjects(frame, false);
    glBegin(GL_POINTS);
    glVertex2f(10, 10);
    glEnd();
    const GLint count = glRenderMode(GL_RENDER);
    showBits(31, std::uint32_t(count));
    // Draws the feedback positions again, as points in window coordinates.
    GLint viewport[4];
    glGetIntegerv(GL_VIEWPORT, viewport);
    setProjection(0, viewport[2], 0, viewport[3]);
    glColor3f(1, 1, 0);
    glPointSize(3);
    glBegin(GL_POINTS);
    for (GLint i = 0; i < count;) {
        const auto token = static_cast<GLint>(values[i++]);
        GLint vertices = token == GL_LINE_TOKEN || token == GL_LINE_RESET_TOKEN ? 2 : 1;
        if (token == GL_PASS_THROUGH_TOKEN) {
            ++i;
            continue;
        }
        if (token == GL_POLYGON_TOKEN) {
            vertices = static_cast<GLint>(values[i++]);
        }
        for (GLint k = 0; k < vertices; ++k, i += 7) {
            glVertex2f(values[i], values[i + 1] + float(viewport[3]) * 0.2F);
        }
    }
    glEnd();
    setProjection(0, 250, 0, 190);
}

// Uses a buffer that is too small, which the returned count reports.
void overflow(int frame) {
    GLfloat few[4];
    glFeedbackBuffer(4, GL_2D, few);
    glRenderMode(GL_FEEDBACK);
    drawObjects(frame, false);
    showBits(32, std::uint32_t(glRenderMode(GL_RENDER)));
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {}, [](Window&) {},
        [](Window&, int frame) {
            glClearColor(0.1F, 0.05F, 0.05F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            setProjection(0, 250, 0, 190);
            drawObjects(frame, false);
            select(frame);
            feedBack(frame);
            overflow(frame);
        });
}
