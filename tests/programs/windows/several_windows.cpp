// Three windows of different sizes and depths with a context each, drawn in turn, one only in every second frame.
// Pixels are copied from one window into another, and two contexts share objects.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

GLuint list, texture;

// Makes objects in the first window's context, which the second one shares.
void makeShared() {
    list = glGenLists(1);
    glNewList(list, GL_COMPILE);
    glBegin(GL_QUADS);
    glTexCoord2f(0, 0), glVertex2f(-0.5F, -0.5F);
    glTexCoord2f(2, 0), glVertex2f(0.5F, -0.4F);
    glTexCoord2f(2, 2), glVertex2f(0.4F, 0.5F);
    glTexCoord2f(0, 2), glVertex2f(-0.4F, 0.4F);
    glEnd();
    glEndList();
    glGenTextures(1, &texture);
}

void changeTexture(int frame) {
    GLubyte texels[8 * 8 * 3];
    Sequence numbers(unsigned(frame) + 2);
    for (GLubyte& value : texels) {
        value = numbers.byte();
    }
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, 8, 8, 0, GL_RGB, GL_UNSIGNED_BYTE, texels);
}

void drawShared(int frame, float tint) {
    glClearColor(tint, 0.1F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glLoadIdentity();
    glRotatef(float(frame) * 17 + tint * 90, 0, 0, 1);
    glBindTexture(GL_TEXTURE_2D, texture);
    glEnable(GL_TEXTURE_2D);
    glCallList(list);
    glDisable(GL_TEXTURE_2D);
}

void drawAlone(int frame) {
    glClearColor(0.1F, 0.2F, 0.1F * float(frame), 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glBegin(GL_LINES);
    for (int i = 0; i < 20; ++i) {
        glColor3f(1, float(i) * 0.05F, 0.3F);
        glVertex2f(-0.9F + float(i) * 0.09F, -0.9F);
        glVertex2f(0.9F - float(i) * 0.09F, 0.3F + 0.1F * float(frame % 5));
    }
    glEnd();
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    WindowSpec spec;
    const auto first = openGlxWindow(spec, options.width, options.height);
    spec.x = options.width;
    const auto second = openGlxWindow(spec, options.width * 2 / 3, options.height / 2, first.get());
    spec.y = options.height / 2;
    spec.depth = 0;
    spec.stencil = 0;
    const auto third = openGlxWindow(spec, options.width / 2, options.height / 3);
    first->makeCurrent();
    makeShared();
    for (int frame = 0; frame < options.frames; ++frame) {
        first->makeCurrent();
        changeTexture(frame);
        drawShared(frame, 0.2F);
        glFinish(); // only then does the other context see the texture
        checkNoError("in the first window");
        // Copies a part of the first window's back buffer into the second window.
        second->makeCurrentReading(*first);
        drawShared(frame + 1, 0.4F);
        glReadBuffer(GL_BACK);
        glWindowPos2i(5, 5);
        glCopyPixels(options.width / 3, options.height / 3, 40, 30, GL_COLOR);
        checkNoError("in the second window");
        first->makeCurrent();
        first->swap();
        second->makeCurrent();
        second->swap();
        if (frame % 2 == 0) {
            third->makeCurrent();
            drawAlone(frame);
            checkNoError("in the third window");
            third->swap();
        }
    }
    return 0;
}
