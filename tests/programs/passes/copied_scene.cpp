// A scene with its previous picture in the background, a little larger and darker, copied from the window into a
// texture.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <cmath>

using namespace programs;

namespace {

GLuint last;

void setUp(Window& window) {
    glClear(GL_COLOR_BUFFER_BIT);
    glGenTextures(1, &last);
    glBindTexture(GL_TEXTURE_2D, last);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, 0, 0, window.width(), window.height(), 0);
}

void lastPicture() {
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_TEXTURE_2D);
    glColor3f(0.8F, 0.8F, 0.8F);
    glBegin(GL_QUADS);
    for (int i = 0; i < 4; ++i) {
        const float x = i == 1 || i == 2 ? 1 : 0, y = i > 1 ? 1 : 0;
        glTexCoord2f(x * 0.96F + 0.02F, y * 0.96F + 0.02F);
        glVertex3f(x * 2 - 1, y * 2 - 1, 0);
    }
    glEnd();
    glDisable(GL_TEXTURE_2D);
    glEnable(GL_DEPTH_TEST);
}

void scene(int frame) {
    glMatrixMode(GL_PROJECTION);
    glFrustum(-0.5, 0.5, -0.5, 0.5, 1, 20);
    glMatrixMode(GL_MODELVIEW);
    glTranslatef(0, 0, -4);
    glRotatef(float(frame) * 20, 0.3F, 1, 0.2F);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 40; ++i) {
        const float turn = float(i) * 0.9F;
        glColor3f(float(i % 4) * 0.3F, float(i % 3) * 0.4F, float(i % 5) * 0.2F);
        glVertex3f(std::cos(turn), std::sin(turn), std::sin(turn * 3));
        glVertex3f(std::cos(turn + 0.7F), std::sin(turn * 2), std::cos(turn));
        glVertex3f(std::sin(turn), std::cos(turn + 1), -std::sin(turn * 2));
    }
    glEnd();
    glLoadIdentity();
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {}, [](Window& window) { setUp(window); },
        [](Window& window, int frame) {
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            lastPicture();
            scene(frame);
            glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, window.width(), window.height());
        });
}
