// A window on an X display, drawn to by plain GLX or EGL without our code: the reference for the platforms' pictures.
#pragma once

#include <memory>

#include "common/base/result.hpp"
#include "tests/gl/scene.hpp"

namespace mural::test {

class NativeWindow {
public:
    virtual ~NativeWindow() = default;
    // Its context is current during its lifetime.
    [[nodiscard]] virtual FindProc find() const = 0;
    // Swaps and reads the window's pixels from the X server: [y][x][rgb as 0xrrggbb], origin upper left.
    virtual std::vector<uint32_t> show() = 0;
};

// On the display named by DISPLAY, with the size and bits of context.surface.
Result<std::unique_ptr<NativeWindow>> openGlxWindow(const gl::ContextConfig& context);
Result<std::unique_ptr<NativeWindow>> openEglWindow(const gl::ContextConfig& context);

} // namespace mural::test
