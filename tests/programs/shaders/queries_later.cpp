// Query results read one and two frames later, as programs do that avoid waiting: visible samples, boolean occlusion,
// primitives; with and without polling; of queries begun again, deleted in between and never ended. Shown as bits.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

constexpr int kBoxes = 6, kSets = 3;
constexpr GLenum kTargets[kBoxes] = {GL_SAMPLES_PASSED,
                                     GL_SAMPLES_PASSED,
                                     GL_ANY_SAMPLES_PASSED,
                                     GL_PRIMITIVES_GENERATED,
                                     GL_ANY_SAMPLES_PASSED_CONSERVATIVE,
                                     GL_SAMPLES_PASSED};

GLuint names[kSets][kBoxes];

void box(float x, float y, float side, float depth) {
    glBegin(GL_QUADS);
    glVertex3f(x, y, depth);
    glVertex3f(x + side, y, depth);
    glVertex3f(x + side, y + side, depth);
    glVertex3f(x, y + side, depth);
    glEnd();
}

// Counts boxes that the wall in front hides completely or in part.
void countBoxes(int frame) {
    glColor3f(0.3F, 0.3F, 0.5F);
    box(-0.3F + 0.02F * float(frame), -0.6F, 0.7F, 0);
    for (int i = 0; i < kBoxes; ++i) {
        glColor3f(0.2F * float(i), 0.8F, 0.1F * float(frame % 10));
        glBeginQuery(kTargets[i], names[frame % kSets][i]);
        box(-0.9F + 0.25F * float(i), -0.5F + 0.1F * float(i), 0.3F, 0.5F);
        glEndQuery(kTargets[i]);
    }
    // The last query begins again in the same frame; only this one counts.
    glBeginQuery(GL_SAMPLES_PASSED, names[frame % kSets][0]);
    box(-0.95F, 0.7F, 0.1F, 0.5F);
    glEndQuery(GL_SAMPLES_PASSED);
}

void showResults(int frame, int ago) {
    if (frame < ago) return;
    for (int i = 0; i < kBoxes; ++i) {
        const GLuint query = names[(frame - ago) % kSets][i];
        GLuint available = 0, result = 0;
        for (int tries = 0; i % 2 == 0 && !available && tries < 1000000; ++tries)
            glGetQueryObjectuiv(query, GL_QUERY_RESULT_AVAILABLE, &available);
        glGetQueryObjectuiv(query, GL_QUERY_RESULT, &result);
        showBits(10 + i + (ago - 1) * kBoxes,
                 kTargets[i] == GL_ANY_SAMPLES_PASSED_CONSERVATIVE ? GLuint{result != 0} : result);
    }
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openGlxWindow({}, options.width, options.height);
    window->makeCurrent();
    glGenQueries(kSets * kBoxes, names[0]);
    glEnable(GL_DEPTH_TEST);
    for (int frame = 0; frame < options.frames; ++frame) {
        glClearColor(0.1F, 0.1F, 0.1F, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        countBoxes(frame);
        glDisable(GL_DEPTH_TEST);
        showResults(frame, 1);
        showResults(frame, 2);
        glEnable(GL_DEPTH_TEST);
        if (frame % 5 == 4) { // names that are used again
            GLuint* const set = names[(frame + 1) % kSets];
            glDeleteQueries(kBoxes, set);
            glGenQueries(kBoxes, set);
        }
        checkNoError("with queries");
        window->swap();
    }
    return 0;
}
