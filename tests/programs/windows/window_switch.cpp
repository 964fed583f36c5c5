// A small window, a large one that is destroyed after some frames, and the small one again: like a splash screen, a
// program and its last message. The large one's context is still current when its window ends.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

void showFrames(Window& window, int frames, int which) {
    window.makeCurrent();
    for (int frame = 0; frame < frames; ++frame) {
        glClearColor(0.2F * float(which), 0.1F * float(frame % 8), 0.3F, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        showBits(2, std::uint32_t(frame * 3 + which));
        checkNoError("in a window");
        window.swap();
    }
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    WindowSpec spec;
    spec.x = options.width;
    const auto small = openGlxWindow(spec, options.width / 2, options.height / 2);
    showFrames(*small, options.frames, 1);
    {
        const auto large = openGlxWindow({}, options.width, options.height);
        showFrames(*large, options.frames, 2);
        showFrames(*small, 1, 3); // smaller than the large one: not on the wall
        large->makeCurrent();
    }
    showFrames(*small, options.frames, 4);
    return 0;
}
