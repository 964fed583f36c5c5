// Queries the window systems' extensions in every way, and counts the lists that name extensions for a single machine,
// or extensions that a wall does not support.
#include <EGL/egl.h>
#include <GL/glx.h>
#include <cstdio>
#include <cstring>
#include <initializer_list>

#include "tests/programs/support/program.hpp"
#include "tests/programs/support/x_window.hpp"

int main() {
    Display* display = programs::openDisplayOnce();
    const int screen = DefaultScreen(display);
    const EGLDisplay egl = eglGetDisplay(reinterpret_cast<EGLNativeDisplayType>(display));
    if (eglInitialize(egl, nullptr, nullptr) == EGL_FALSE) {
        programs::fail("no EGL display");
    }
    int lists = 0;
    int local = 0;
    for (const char* list : {glXQueryExtensionsString(display, screen), glXGetClientString(display, GLX_EXTENSIONS),
                             glXQueryServerString(display, screen, GLX_EXTENSIONS), eglQueryString(egl, EGL_EXTENSIONS),
                             eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS)}) {
        if (list == nullptr || *list == '\0') {
            programs::fail("list %d is empty", lists);
        }
        ++lists;
        bool named = false;
        for (const char* name : {"EGL_KHR_image_pixmap", "EGL_MESA_drm_image", "_copy_sub_buffer", "_post_sub_buffer",
                                 "_swap_event", "OML_sync_control"}) {
            named = named || std::strstr(list, name) != nullptr;
        }
        local += named ? 1 : 0;
    }
    std::printf("%d of %d lists name what is on one machine only\n", local, lists);
    eglTerminate(egl);
    return 0;
}
