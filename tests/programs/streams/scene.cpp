// Typical repetition from frame to frame: geometry in a display list and in a buffer stays unchanged, only the camera
// moves.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

constexpr int kVertices = 3000;
constexpr float kTriangle = 0.1F; // small, because calls and bytes are measured, not pixels
GLuint list, buffer;

void setUp(Window&) {
    Sequence numbers(5);
    float corner[3] = {};
    list = glGenLists(1);
    glNewList(list, GL_COMPILE);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < kVertices; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        if (i % 3 == 0)
            for (float& value : corner) value = 2 * numbers.unit() - 1;
        glVertex3f(corner[0] + kTriangle * numbers.unit(), corner[1] + kTriangle * numbers.unit(),
                   corner[2] + kTriangle * numbers.unit());
    }
    glEnd();
    glEndList();
    std::vector<float> points(kVertices * 3);
    for (float& value : points) value = 2 * numbers.unit() - 1;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(points.size() * sizeof(float)), points.data(), GL_STATIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void draw(Window&, int frame) {
    glEnable(GL_DEPTH_TEST);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glRotatef(3.0F * float(frame), 0.2F, 1, 0.1F);
    glScalef(0.6F, 0.6F, 0.3F);
    for (int object = 0; object < 50; ++object) {
        glPushMatrix();
        glTranslatef(0.02F * float(object), 0, 0);
        glCallList(list);
        glPopMatrix();
    }
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(3, GL_FLOAT, 0, nullptr);
    glDrawArrays(GL_POINTS, 0, kVertices);
    glDisableClientState(GL_VERTEX_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {}, setUp, draw); }
