// Evaluators: one- and two-dimensional maps of vertices, colours, normals and texture coordinates, meshes, points,
// automatic normals, and maps changed and freed after the call.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

void drawCurves(int frame) {
    // Control points with a stride of 5 floats. The memory is freed before evaluation.
    {
        std::vector<GLfloat> points(5 * 5, -1);
        Sequence numbers(unsigned(frame) + 1);
        for (int i = 0; i < 5; ++i) {
            points[std::size_t(i) * 5] = 10 + float(i) * 25;
            points[std::size_t(i) * 5 + 1] = 10 + numbers.unit() * 60;
            points[std::size_t(i) * 5 + 2] = 0;
        }
        glMap1f(GL_MAP1_VERTEX_3, 0, 1, 5, 5, points.data());
        const std::vector<GLdouble> colors = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0.2 * frame, 1, 1};
        glMap1d(GL_MAP1_COLOR_4, 0, 1, 4, 3, colors.data());
    }
    glEnable(GL_MAP1_VERTEX_3);
    glEnable(GL_MAP1_COLOR_4);
    glLineWidth(2);
    glBegin(GL_LINE_STRIP);
    for (int i = 0; i <= 30; ++i) {
        if (i % 2 == 0) {
            glEvalCoord1f(float(i) / 30);
        } else {
            const GLdouble u = i / 30.0;
            glEvalCoord1dv(&u);
        }
    }
    glEnd();
    glPushMatrix();
    glTranslatef(0, 20, 0);
    glMapGrid1f(12, 0, 1);
    glEvalMesh1(GL_LINE, 2, 10);
    glTranslatef(0, 10, 0);
    glPointSize(4);
    glEvalMesh1(GL_POINT, 0, 12);
    glBegin(GL_POINTS);
    glEvalPoint1(3 + frame);
    glEnd();
    glPopMatrix();
    glDisable(GL_MAP1_VERTEX_3);
    glDisable(GL_MAP1_COLOR_4);
    glLineWidth(1);
}

void mapSurface(int frame) {
    GLfloat points[4][4][3];
    Sequence numbers(unsigned(frame) + 20);
    for (int v = 0; v < 4; ++v) {
        for (int u = 0; u < 4; ++u) {
            points[v][u][0] = 20 + float(u) * 25 + numbers.unit() * 10;
            points[v][u][1] = float(v) * 20 + numbers.unit() * 10;
            points[v][u][2] = numbers.unit() * 50 - 25;
        }
    }
    glMap2f(GL_MAP2_VERTEX_3, 0, 1, 3, 4, 0, 1, 12, 4, &points[0][0][0]);
    const GLfloat coordinates[2][2][2] = {{{0, 0}, {2, 0}}, {{0, 3}, {2, 3}}};
    glMap2f(GL_MAP2_TEXTURE_COORD_2, 0, 1, 2, 2, 0, 1, 4, 2, &coordinates[0][0][0]);
}

void drawSurfaces(int frame) {
    mapSurface(frame);
    glEnable(GL_MAP2_VERTEX_3);
    glEnable(GL_AUTO_NORMAL);
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glEnable(GL_DEPTH_TEST);
    glMapGrid2f(8, 0, 1, 6, 0, 1);
    glPushMatrix();
    glTranslatef(0, 95, 0);
    glEvalMesh2(GL_FILL, 0, 8, 0, 6);
    glPopMatrix();
    glPushMatrix();
    glTranslatef(110, 95, 0);
    glMapGrid2d(5, 0.1, 0.9, 5, 0.2, 1);
    glEvalMesh2(GL_LINE, 0, 5, 0, 5);
    glPopMatrix();
    glDisable(GL_LIGHTING);
    glEnable(GL_MAP2_TEXTURE_COORD_2);
    glEnable(GL_TEXTURE_2D);
    glColor3f(1, 1, 1);
    glPushMatrix();
    glTranslatef(115, 5, 0);
    glBegin(GL_TRIANGLE_STRIP);
    for (int i = 0; i <= 16; ++i) {
        const GLfloat place[] = {float(i) / 16, 0.5F};
        glEvalCoord2f(float(i) / 16, 0.1F);
        glEvalCoord2fv(place);
    }
    glEnd();
    glBegin(GL_QUADS);
    glEvalPoint2(1, 3);
    glEvalPoint2(4, 3);
    glEvalPoint2(4, 5);
    glEvalPoint2(1, 5);
    glEnd();
    glPopMatrix();
    for (const GLenum name :
         {GL_TEXTURE_2D, GL_MAP2_TEXTURE_COORD_2, GL_MAP2_VERTEX_3, GL_AUTO_NORMAL, GL_DEPTH_TEST}) {
        glDisable(name);
    }
    GLfloat readBack[48] = {};
    glGetMapfv(GL_MAP2_VERTEX_3, GL_COEFF, readBack);
    showBits(37, readBack[5]);
    GLint order[2] = {};
    glGetMapiv(GL_MAP2_VERTEX_3, GL_ORDER, order);
    showBits(36, std::uint32_t(order[0] * 16 + order[1]));
}

void setUp() {
    GLubyte texels[4 * 4 * 4];
    Sequence numbers(9);
    for (GLubyte& value : texels) {
        value = numbers.byte();
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels); // texture 0
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {}, [](Window&) { setUp(); },
        [](Window&, int frame) {
            glClearColor(0.08F, 0.1F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            glMatrixMode(GL_PROJECTION);
            glLoadIdentity();
            glOrtho(0, 250, 0, 190, -60, 60);
            glMatrixMode(GL_MODELVIEW);
            glLoadIdentity();
            drawCurves(frame);
            drawSurfaces(frame);
        });
}
