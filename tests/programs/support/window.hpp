// Windows with one GL context each, opened with raw Xlib and GLX or EGL, as in old and new programs.
#pragma once

#include <memory>

namespace programs {

enum class Profile { Compatibility, Core, Es };

struct WindowSpec {
    Profile profile = Profile::Compatibility;
    int major = 0, minor = 0; // 0: a context without a requested version (glXCreateNewContext)
    int alpha = 0, depth = 24, stencil = 8, samples = 0, accum = 0;
    bool doubleBuffered = true;
    int x = 0, y = 0;
};

class Window {
public:
    Window(int width, int height) : width_(width), height_(height) {}
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;
    virtual ~Window() = default;

    virtual void makeCurrent() = 0;
    // Makes this window current for drawing and `from`, a window of the same kind, current for reading.
    virtual void makeCurrentReading(Window& from) = 0;
    virtual void release() = 0; // leaves this thread without a current context
    virtual void swap() = 0;
    virtual void resize(int width, int height) = 0; // returns after the server has done it

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

protected:
    int width_, height_;
};

// Opens a window. If given, `share`'s context shares objects with it. Ends the program on failure, never returns null.
std::unique_ptr<Window> openGlxWindow(const WindowSpec& spec, int width, int height, Window* share = nullptr);
std::unique_ptr<Window> openEglWindow(const WindowSpec& spec, int width, int height, Window* share = nullptr);

} // namespace programs
