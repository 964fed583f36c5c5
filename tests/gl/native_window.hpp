// A window on an X display, drawn to as any program would: with GLX or EGL and nothing of ours. It is
// the reference that the platforms' pictures are compared with.
#pragma once

#include <memory>

#include "common/result.hpp"
#include "tests/gl/scene.hpp"

namespace mural::test {

class NativeWindow {
public:
    virtual ~NativeWindow() = default;
    // Its context is current until it goes.
    [[nodiscard]] virtual FindProc find() const = 0;
    // Swaps and reads the window's pixels back from the X server: [y][x][rgb as 0xrrggbb], origin upper left.
    virtual std::vector<uint32_t> show() = 0;
};

// On the display that DISPLAY names; the window is of context.surface's size and bits.
Result<std::unique_ptr<NativeWindow>> openGlxWindow(const gl::ContextConfig& context);
Result<std::unique_ptr<NativeWindow>> openEglWindow(const gl::ContextConfig& context);

} // namespace mural::test
