// Opaque draws with equal numbers of vertices, whose first tenth has nearly all cost of a frame. These are large
// layers, each in front of the previous one; thousands of small triangles follow. UNEVEN_LAYERS (60) sets the cost.
// With UNEVEN_EVENLY all layers have one size.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <cstdlib>

using namespace programs;

namespace {

constexpr int kDraws = 600, kTriangles = 4; // triangles of each draw

void setUp(Window&) {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
}

// Draws from back to front, so nothing is hidden when it is drawn.
void draw(int index, float size, Sequence& numbers) {
    const float depth = 0.9F - 1.8F * static_cast<float>(index) / kDraws;
    glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < kTriangles; ++i) {
        const float x = numbers.unit() * 2 - 1, y = numbers.unit() * 2 - 1;
        glVertex3f(x - size, y - size, depth);
        glVertex3f(x + size, y - size, depth);
        glVertex3f(x, y + size, depth);
    }
    glEnd();
}

void frame(Window&, int number) {
    static const char* const layers = std::getenv("UNEVEN_LAYERS");
    static const int large = layers ? std::atoi(layers) : 60;
    static const bool evenly = std::getenv("UNEVEN_EVENLY") != nullptr;
    glClearColor(0.2F, 0.01F * static_cast<float>(number % 50), 0.1F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    Sequence numbers(static_cast<unsigned>(number) + 3);
    for (int i = 0; i < kDraws; ++i) draw(i, evenly ? 0.3F : i < large ? 1.2F : 0.01F, numbers);
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {}, setUp, frame); }
