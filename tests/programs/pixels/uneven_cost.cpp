// Frames whose cost lies mostly in one corner of the picture: many layers over each other. After UNEVEN_STAY frames
// (20) it is another corner. UNEVEN_LAYERS (150) sets the cost. With UNEVEN_EVENLY the layers cover the whole picture.
#include "tests/programs/support/environment.hpp"
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <cstdlib>

using namespace programs;

namespace {

void setUp(Window&) {
    glEnable(GL_DEPTH_TEST);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
}

void layer(float x, float y, float side, Sequence& numbers) {
    glColor4f(numbers.unit(), numbers.unit(), numbers.unit(), 0.1F);
    glBegin(GL_QUADS);
    glVertex3f(x, y, 0.9F);
    glVertex3f(x + side, y, 0.9F);
    glVertex3f(x + side, y + side, 0.9F);
    glVertex3f(x, y + side, 0.9F);
    glEnd();
}

void draw(Window&, int frame) {
    static const int stay = numberOf("UNEVEN_STAY", 20), layers = numberOf("UNEVEN_LAYERS", 150);
    static const bool evenly = std::getenv("UNEVEN_EVENLY") != nullptr;
    glClearColor(0.1F, 0.02F * float(frame % 40), 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    Sequence numbers(unsigned(frame) + 5);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 30; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex3f(numbers.unit() * 2 - 1, numbers.unit() * 2 - 1, 0.95F);
    }
    glEnd();
    const int corner = frame / stay % 4;
    glEnable(GL_BLEND);
    glDepthMask(GL_FALSE);
    for (int i = 0; i < layers; ++i) {
        if (evenly) {
            layer(-1, -1, 2, numbers);
            continue;
        }
        const float x = corner % 2 == 0 ? -1 : 0.2F, y = corner / 2 == 0 ? -1 : 0.2F;
        layer(x + 0.1F * numbers.unit(), y + 0.1F * numbers.unit(), 0.7F, numbers);
    }
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {}, setUp, draw); }
