// A plug-in that links OpenGL itself and draws when its host calls it.
#include "tests/programs/support/gl.hpp"

extern "C" __attribute__((visibility("default"))) void drawByPlugin(int frame, int width, int height) {
    glViewport(0, 0, width, height);
    glClearColor(0.2F, 0.1F, 0.05F * static_cast<float>(frame % 10), 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glBegin(GL_TRIANGLE_FAN);
    for (int i = 0; i < 7; ++i) {
        glColor3f(static_cast<float>(i) / 7, 0.6F, static_cast<float>(i % 2));
        glVertex2f(static_cast<float>((i * 5 + frame) % 9) / 5 - 0.8F, static_cast<float>((i * 7) % 9) / 5 - 0.8F);
    }
    glEnd();
}
