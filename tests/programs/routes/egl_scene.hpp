// The scene in a window by EGL, with the functions that `find` gives.
#pragma once

#include "tests/programs/routes/scene.hpp"
#include "tests/programs/support/program.hpp"

namespace programs {

// atEnd is called while the window is still there.
template <class Find, class AtEnd> int runSceneByEgl(const Options& options, Find find, AtEnd atEnd) {
    const auto window = openEglWindow({}, options.width, options.height);
    window->makeCurrent();
    {
        Scene scene(find);
        for (int frame = 0; frame < options.frames; ++frame) {
            scene.draw(frame, options.width, options.height);
            window->swap();
        }
    }
    atEnd();
    window->release();
    return 0;
}

} // namespace programs
