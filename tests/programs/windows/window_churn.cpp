// Windows and contexts created and destroyed in each frame, some in the order of other programs: the window before its
// context, or the context while it is current.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

void draw(int frame, int which) {
    glClearColor(0.1F * float(which), 0.2F, 0.1F * float(frame % 6), 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    GLuint texture = 0; // the first name of a new context, repeatedly
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    GLubyte texels[4 * 4 * 3];
    Sequence numbers(unsigned(frame * 10 + which));
    for (GLubyte& value : texels) {
        value = numbers.byte();
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, 4, 4, 0, GL_RGB, GL_UNSIGNED_BYTE, texels);
    glEnable(GL_TEXTURE_2D);
    glBegin(GL_QUADS);
    glTexCoord2f(0, 0), glVertex2f(-0.8F, -0.7F);
    glTexCoord2f(1, 0), glVertex2f(0.7F, -0.8F);
    glTexCoord2f(1, 1), glVertex2f(0.8F, 0.6F);
    glTexCoord2f(0, 1), glVertex2f(-0.6F, 0.8F);
    glEnd();
    checkNoError("in a new window");
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto staying = openGlxWindow({}, options.width, options.height);
    for (int frame = 0; frame < options.frames; ++frame) {
        WindowSpec spec;
        spec.x = options.width;
        {
            const auto passing = openGlxWindow(spec, options.width / 2 + frame, options.height / 2);
            passing->makeCurrent();
            draw(frame, 1);
            passing->swap();
            draw(frame + 1, 2);
            passing->swap();
            if (frame % 2 == 0) {
                staying->makeCurrent();
            }
        }
        staying->makeCurrent();
        draw(frame, 0);
        staying->swap();
    }
    return 0;
}
