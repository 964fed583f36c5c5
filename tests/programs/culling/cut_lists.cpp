// Display lists of glBegin. Nodes leave out lists of nothing but primitives that cannot touch their tiles. Other lists
// change matrices and other state between primitives. Lists leave colours and materials behind, call other lists, and
// draw quads that cross the near plane.
#include <array>
#include <cmath>

#include "tests/programs/culling/meshes.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

constexpr GLuint kRow = 10, kRows = 12, kScene = 60, kColours = 61, kLate = 62, kWide = 63, kPushed = 64, kBatches = 65,
                 kMove = 66, kPure = 70, kPures = 6;

void quads(int first, int count, GLenum mode) {
    glBegin(mode);
    for (int i = first; i < first + count; ++i) {
        const auto x = static_cast<float>(i);
        for (int corner = 0; corner < 4; ++corner) {
            glNormal3f(0.1F * static_cast<float>(corner), 0.2F, 1);
            glColor3ub(static_cast<GLubyte>(20 * i), static_cast<GLubyte>(60 * corner), 120);
            const bool isRight = corner == 1 || corner == 2;
            glVertex3d(0.2 * static_cast<double>(x) + (isRight ? 0.18 : 0), corner > 1 ? 0.2 : 0,
                       0.1 * std::sin(static_cast<double>(i + corner)));
        }
    }
    glEnd();
}

// A row of quads, strips, fans, lines and points, each after a command that separates it from the others.
void compileRow(GLuint row) {
    glNewList(kRow + row, GL_COMPILE);
    glPushMatrix();
    glTranslatef(-1, 0.2F * static_cast<float>(row) - 1.2F, 0);
    glColor3f(1, 0.1F * static_cast<float>(row), 0);
    quads(0, 3, GL_QUADS);
    glFrontFace(row % 2 ? GL_CW : GL_CCW);
    glShadeModel(row % 3 ? GL_SMOOTH : GL_FLAT);
    quads(3, 3, GL_QUAD_STRIP);
    glTranslatef(0, 0, 0.1F);
    quads(6, 2, GL_TRIANGLE_FAN);
    glEnable(GL_NORMALIZE);
    glBegin(GL_TRIANGLE_STRIP);
    for (GLshort i = 0; i < 8; ++i) glVertex2s(static_cast<GLshort>(1 + i / 6), static_cast<GLshort>(i % 2));
    glEnd();
    glRotatef(3, 0, 0, 1);
    glBegin(GL_LINES);
    glColor3f(1, 1, 1);
    glVertex3f(0, 0, 0.2F);
    glVertex3f(2, 0, 0.2F);
    glEnd();
    glColor4f(0.2F, 0.9F, 0.3F, 1);
    glPopMatrix();
    glEndList();
}

// Nothing but primitives, in all modes. Nodes leave out these lists.
void compilePure(GLuint which) {
    constexpr std::array<GLenum, kPures> kModes{GL_QUADS, GL_QUAD_STRIP, GL_POLYGON, GL_TRIANGLES, GL_LINES, GL_POINTS};
    glNewList(kPure + which, GL_COMPILE);
    if (which % 2 == 0) glMaterialf(GL_FRONT_AND_BACK, GL_SHININESS, 3);
    quads(0, 3, kModes[which]);
    quads(2, 4, kModes[(which + 1) % kPures]);
    glEndList();
}

void compileScene() {
    for (GLuint which = 0; which < kPures; ++which) compilePure(which);
    glNewList(kMove, GL_COMPILE);
    glTranslatef(0.11F, 0.06F, 0);
    glEndList();
    // Colours before, inside and after of primitives; the last one stays.
    glNewList(kColours, GL_COMPILE);
    glColor3f(0, 0, 1);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 9; ++i) {
        if (i == 4) glColor3f(1, 0, 1);
        glVertex2f(0.1F * static_cast<float>(i % 3), i % 3 == 1 ? 0.2F : 0);
    }
    glEnd();
    glColor3f(0.9F, 0.8F, 0.1F);
    glEndList();
    // The first primitive takes its colour from the caller, and sets another one in the middle.
    glNewList(kLate, GL_COMPILE);
    glBegin(GL_QUADS);
    glVertex2f(0, 0);
    glVertex2f(0.3F, 0);
    glColor3f(0, 1, 1);
    glVertex2f(0.3F, 0.3F);
    glVertex2f(0, 0.3F);
    glEnd();
    glTranslatef(0.4F, 0, 0);
    quads(0, 1, GL_QUADS);
    glTranslatef(-0.4F, 0, 0);
    glEndList();
    glNewList(kWide, GL_COMPILE);
    glLineWidth(9);
    glBegin(GL_LINE_STRIP);
    for (int i = 0; i < 12; ++i) glVertex3f(0.2F * static_cast<float>(i) - 1, i % 2 ? 0.3F : -0.3F, 0);
    glEnd();
    glLineWidth(1);
    glPointSize(11);
    glBegin(GL_POINTS);
    for (int i = 0; i < 12; ++i) glVertex4f(0.4F * static_cast<float>(i) - 2, 0.8F, 0, 2);
    glEnd();
    glPointSize(1);
    glEndList();
    glNewList(kPushed, GL_COMPILE);
    glPushAttrib(GL_ALL_ATTRIB_BITS);
    glColor3f(1, 0, 0);
    quads(0, 2, GL_QUADS);
    glPopAttrib();
    quads(4, 2, GL_QUADS); // in the colour of the caller for Mesa's first vertex
    glEndList();
    // Neighbouring primitives, which drivers may join.
    glNewList(kBatches, GL_COMPILE);
    for (int i = 0; i < 40; ++i) {
        quads(i % 5, 3, i % 7 ? GL_QUADS : GL_POLYGON);
        if (i % 10 == 9) glTranslatef(0.3F, -0.1F, 0.4F);
    }
    glEndList();
    glNewList(kScene, GL_COMPILE);
    for (GLuint row = 0; row < kRows; ++row) glCallList(kRow + row);
    glEndList();
}

void setUp(Window&) {
    for (GLuint row = 0; row < kRows; ++row) compileRow(row);
    compileScene();
}

void callAt(GLuint list, float x, float y, float scale = 1) {
    glPushMatrix();
    glTranslatef(x, y, 0);
    glScalef(scale, scale, scale);
    glCallList(list);
    glPopMatrix();
}

void draw(Window& window, int frame) {
    const auto aspect = static_cast<double>(window.width()) / static_cast<double>(window.height());
    glClearColor(0.1F, 0.1F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glFrustum(-0.1 * aspect, 0.1 * aspect, -0.1, 0.1, 0.2, 50);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glTranslatef(0, 0, -2.6F);
    glPushMatrix();
    glRotatef(static_cast<float>(7 * frame), 0.3F, 1, 0.1F);
    glCallList(kScene);
    glPopMatrix();
    for (int i = 0; i < 12; ++i) {
        const float x = 0.4F * static_cast<float>(i % 6) - 1.2F, y = i < 6 ? -0.9F : 0.8F;
        glColor3f(0.1F * static_cast<float>(i), 1, 0);
        callAt(i % 2 ? kLate : kColours, x, y);
        glBegin(GL_TRIANGLES); // in the colour that the list left behind
        for (int corner = 0; corner < 3; ++corner)
            glVertex3f(x + (corner == 1 ? 0.1F : 0), y + (corner == 2 ? 0.1F : 0), 0.2F);
        glEnd();
    }
    for (int i = 0; i < 60; ++i) {
        callAt(kPure + static_cast<GLuint>(i) % kPures, 1.7F * std::sin(static_cast<float>(5 * i + frame)),
               1.2F * std::cos(static_cast<float>(3 * i)), 0.3F);
        if (i % 5 == 0) quads(i % 3, 2, GL_TRIANGLES); // after the list, and in its last colour
        glBegin(GL_LINES);
        glVertex3f(-2, 0.04F * static_cast<float>(i) - 1.2F, -0.5F);
        glVertex3f(2, 0.04F * static_cast<float>(i) - 1.2F, -0.5F);
        glEnd();
    }
    // Matrices that only lists change.
    glPushMatrix();
    glTranslatef(-1.4F, -0.9F, 0.1F);
    glScalef(0.2F, 0.2F, 0.2F);
    for (GLuint i = 0; i < 60; ++i) {
        for (int step = 0; step < 2; ++step) glCallList(kMove);
        glCallList(kPure + i % kPures);
    }
    glPopMatrix();
    callAt(kWide, 0, 0.02F * static_cast<float>(frame));
    callAt(kPushed, -0.5F, 0.3F);
    callAt(kBatches, -1.2F, 0.5F, 0.5F);
    // Through the near plane, with lists between quads of glBegin.
    glPushMatrix();
    glTranslatef(0.2F, -0.3F, 2.3F);
    glRotatef(75, 1, 0, 0.1F * static_cast<float>(frame));
    const std::array<GLubyte, 3> lists{0, 5, 11};
    glListBase(kRow);
    for (int i = 0; i < 4; ++i) {
        quads(i, 3, GL_QUADS);
        glCallLists(3, GL_UNSIGNED_BYTE, lists.data());
        callAt(kBatches, 0.2F * static_cast<float>(i), 0);
        callAt(kPure + static_cast<GLuint>(i), 0.5F * static_cast<float>(i) - 0.8F, 0.2F, 2);
    }
    glPopMatrix();
    if (frame % 2 == 1) compileRow(static_cast<GLuint>(frame) % kRows); // other contents under the same name
    glNewList(kColours, frame % 2 ? GL_COMPILE_AND_EXECUTE : GL_COMPILE);
    glColor3f(0, 0.2F * static_cast<float>(frame % 5), 1);
    quads(frame % 4, 3, GL_QUADS);
    glRotatef(1, 0, 0, 1);
    quads(frame % 3, 2, GL_QUADS);
    glEndList();
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, WindowSpec{}, setUp, draw); }
