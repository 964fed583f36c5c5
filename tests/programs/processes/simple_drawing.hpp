// The picture that the programs about processes draw.
#pragma once

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

namespace programs {

inline void drawSimple(Window& window, int frame) {
    glViewport(0, 0, window.width(), window.height());
    glClearColor(0.1F, 0.1F, 0.05F * float(frame % 12), 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    Sequence numbers(unsigned(frame) + 1);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 60; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(numbers.unit() * 2 - 1, numbers.unit() * 2 - 1);
    }
    glEnd();
}

} // namespace programs
