// Lit display lists whose material follows the colour, with other materials in between. Mesa's result for both depends
// on further calls, so a node must not call more than the program.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

GLuint list = 0;

void material(GLenum name, float grey) {
    const GLfloat value[] = {grey, grey, grey, 1};
    glMaterialfv(GL_FRONT_AND_BACK, name, value);
}

void ambientOfAll(float grey) {
    const GLfloat value[] = {grey, grey, grey, 1};
    glLightModelfv(GL_LIGHT_MODEL_AMBIENT, value);
}

void setUp() {
    static const GLfloat corners[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0},
                         normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    static const GLushort indices[] = {0, 1, 2, 0, 2, 3};
    list = glGenLists(1);
    glNewList(list, GL_COMPILE);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_NORMAL_ARRAY);
    glVertexPointer(3, GL_FLOAT, 0, corners);
    glNormalPointer(GL_FLOAT, 0, normals);
    glDrawElements(GL_TRIANGLES, 6, GL_UNSIGNED_SHORT, indices);
    glEndList();
}

void draw(int frame) {
    const GLfloat black[] = {0, 0, 0, 1}, bright[] = {0.8F, 0.8F, 0.8F, 1}, front[] = {0, 0, 1, 0};
    glClearColor(0.2F, 0.2F, 0.4F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glLightfv(GL_LIGHT0, GL_AMBIENT, black);
    glLightfv(GL_LIGHT0, GL_DIFFUSE, bright);
    glLightfv(GL_LIGHT0, GL_POSITION, front);
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glColorMaterial(GL_FRONT_AND_BACK, GL_AMBIENT_AND_DIFFUSE);
    glEnable(GL_COLOR_MATERIAL);
    glColor4f(0.8F, 0.8F, 0.8F, 1);
    material(GL_SPECULAR, 0);
    ambientOfAll(0.1F);
    glPushMatrix();
    glRotatef(static_cast<float>(10 * frame), 0, 1, 0);
    glScalef(0.7F, 0.7F, 0.7F);
    glCallList(list);
    glPopMatrix();
    glDisable(GL_LIGHTING);
    glDisable(GL_LIGHT0);
    glDisable(GL_COLOR_MATERIAL);
    glColor4f(0.8F, 0.8F, 0.8F, 1);
    material(GL_AMBIENT, 0.2F);
    material(GL_DIFFUSE, 0.8F);
    material(GL_SPECULAR, 0);
    ambientOfAll(0.2F);
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {}, [](Window&) { setUp(); }, [](Window&, int frame) { draw(frame); });
}
