// Draws the scene in a window through EGL, with the functions that `find` returns.
#pragma once

#include "tests/programs/routes/scene.hpp"
#include "tests/programs/support/program.hpp"

namespace programs {

// Runs the scene; calls atEnd while the window still exists.
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
