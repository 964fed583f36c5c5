// Finds the time at which a new window size reaches GL's buffers. A driver decides it at its own times: the first
// binding, or the first drawing after a swap. Programs that resize between two calls make it visible. Each case resizes
// its own window at another time and tests whether a pixel outside the old size exists. The results are bits of the
// picture.
#include <functional>
#include <memory>
#include <vector>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

constexpr int kOld = 80, kNew = 160;

struct Case {
    Window& window;
    Window& other;

    void resize() { window.resize(kNew, kNew); }
    static void clear() { glClear(GL_COLOR_BUFFER_BIT); }
    static void viewport() { glViewport(0, 0, kNew, kNew); }
};

using Steps = std::function<void(Case&)>;

const std::vector<Steps>& allSteps() {
    static const std::vector<Steps> steps = {
        [](Case& c) { c.resize(); },
        [](Case& c) { c.resize(), Case::viewport(); },
        [](Case& c) { Case::clear(), c.resize(), Case::viewport(); },
        [](Case& c) { Case::clear(), c.resize(), glFlush(); },
        [](Case& c) { Case::clear(), c.resize(), glFinish(); },
        [](Case& c) { Case::clear(), c.window.swap(), c.resize(); },
        [](Case& c) { Case::clear(), c.window.swap(), Case::viewport(), c.resize(); },
        [](Case& c) { Case::clear(), c.window.swap(), Case::clear(), c.resize(), Case::viewport(); },
        [](Case& c) { Case::clear(), c.resize(), c.window.swap(); },
        [](Case& c) { Case::clear(), c.resize(), c.window.makeCurrent(); },
        [](Case& c) { Case::clear(), c.resize(), c.window.release(), c.window.makeCurrent(); },
        [](Case& c) { Case::clear(), c.window.swap(), c.resize(), c.window.release(), c.window.makeCurrent(); },
        [](Case& c) { c.resize(), c.other.makeCurrent(), c.window.makeCurrent(); },
        [](Case& c) { c.window.makeCurrentReading(c.other), c.resize(), c.window.makeCurrent(); },
    };
    return steps;
}

bool hasNewSize() {
    GLubyte pixel[4] = {9, 9, 9, 9};
    glClearColor(1, 0, 0, 1);
    Case::clear();
    glReadPixels((kOld + kNew) / 2, (kOld + kNew) / 2, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    return pixel[0] != 9;
}

// The windows stay: a new one at the same place could be confused with its predecessor.
std::vector<std::unique_ptr<Window>> opened;

Window& keep(std::unique_ptr<Window> window) {
    opened.push_back(std::move(window));
    return *opened.back();
}

std::uint32_t answers(std::unique_ptr<Window> (*open)(const WindowSpec&, int, int, Window*)) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < allSteps().size(); ++i) {
        Window& window = keep(open({}, kOld, kOld, nullptr));
        Case c{window, keep(open({}, kOld, kOld, nullptr))};
        window.makeCurrent();
        allSteps()[i](c);
        bits |= std::uint32_t(hasNewSize()) << i;
        window.release();
    }
    return bits;
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const std::uint32_t glx = answers(openGlxWindow);
    const std::uint32_t egl = answers(openEglWindow);
    const auto window = openGlxWindow({}, options.width, options.height);
    window->makeCurrent();
    for (int frame = 0; frame < options.frames; ++frame) {
        fillRectangle(0, 0, window->width(), window->height(), {0.1F, 0.2F, 0.1F * float(frame % 5)});
        showBits(2, glx);
        showBits(4, egl);
        checkNoError("after the resizes");
        window->swap();
    }
    return 0;
}
