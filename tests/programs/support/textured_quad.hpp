// Draws the bound texture of the fixed pipeline on a slightly skewed quad, which makes every filter visible.
#pragma once

#include "tests/programs/support/gl.hpp"

namespace programs {

// Draws the quad with corners in clip coordinates; the right side is 0.1 higher.
inline void drawTexturedQuad(float x, float y, float width, float height) {
    glEnable(GL_TEXTURE_2D);
    glBegin(GL_QUADS);
    for (int i = 0; i < 4; ++i) {
        const float u = i == 1 || i == 2 ? 1 : 0, v = i >= 2 ? 1 : 0;
        glTexCoord2f(u, v);
        glVertex2f(x + u * width, y + v * height + u * 0.1F);
    }
    glEnd();
    glDisable(GL_TEXTURE_2D);
}

} // namespace programs
