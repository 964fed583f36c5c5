// Draws with OSMesa into its own memory and copies the picture into its window through X11: no GLX, no EGL.
#include <GL/osmesa.h>
#include <X11/Xutil.h>
#include <vector>

#include "tests/programs/support/program.hpp"
#include "tests/programs/support/x_window.hpp"

int main(int argc, char** argv) {
    const programs::Options options = programs::parseOptions(argc, argv);
    Display* display = programs::openDisplayOnce();
    XVisualInfo wanted{};
    wanted.screen = DefaultScreen(display);
    wanted.visualid = XVisualIDFromVisual(DefaultVisual(display, wanted.screen));
    int count = 0;
    XVisualInfo* visual = XGetVisualInfo(display, VisualIDMask | VisualScreenMask, &wanted, &count);
    if (visual == nullptr) {
        programs::fail("no visual");
    }
    const programs::XWindow window(*visual, 0, 0, options.width, options.height);
    std::vector<unsigned> pixels(static_cast<size_t>(options.width) * static_cast<size_t>(options.height));
    OSMesaContext context = OSMesaCreateContext(OSMESA_BGRA, nullptr);
    OSMesaMakeCurrent(context, pixels.data(), GL_UNSIGNED_BYTE, options.width, options.height);
    XImage* image = XCreateImage(display, visual->visual, static_cast<unsigned>(visual->depth), ZPixmap, 0,
                                 reinterpret_cast<char*>(pixels.data()), static_cast<unsigned>(options.width),
                                 static_cast<unsigned>(options.height), 32, options.width * 4);
    for (int frame = 0; frame < options.frames; ++frame) {
        glClearColor(0.1F * static_cast<float>(frame), 0.5F, 0.2F, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        glFinish();
        XPutImage(display, window.id(), DefaultGC(display, wanted.screen), image, 0, 0, 0, 0,
                  static_cast<unsigned>(options.width), static_cast<unsigned>(options.height));
        XSync(display, False);
    }
    image->data = nullptr;
    XDestroyImage(image);
    OSMesaDestroyContext(context);
    XFree(visual);
    return 0;
}
