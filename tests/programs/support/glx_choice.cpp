#include "tests/programs/support/glx_choice.hpp"

#include <GL/glxext.h>

#include "tests/programs/support/program.hpp"

namespace programs {

GLXFBConfig chooseGlxConfig(Display* display, int drawableBits, int depthBits) {
    const int attributes[] = {GLX_DRAWABLE_TYPE,
                              drawableBits,
                              GLX_DOUBLEBUFFER,
                              True,
                              GLX_RED_SIZE,
                              8,
                              GLX_GREEN_SIZE,
                              8,
                              GLX_BLUE_SIZE,
                              8,
                              GLX_DEPTH_SIZE,
                              depthBits,
                              None};
    int count = 0;
    GLXFBConfig* found = glXChooseFBConfig(display, DefaultScreen(display), attributes, &count);
    if (found == nullptr || count == 0) {
        fail("no GLX configuration for drawables 0x%x with %d bits of depth", unsigned(drawableBits), depthBits);
    }
    GLXFBConfig config = found[0];
    for (int i = count; i-- > 0;) { // the deepest come first, but windows have 8 bits
        int bits = 0;
        glXGetFBConfigAttrib(display, found[i], GLX_RED_SIZE, &bits);
        if (bits == 8) {
            config = found[i];
        }
    }
    XFree(found);
    return config;
}

GLXContext makeCoreGlxContext(Display* display, GLXFBConfig config, GLXContext share) {
    static const auto create = reinterpret_cast<PFNGLXCREATECONTEXTATTRIBSARBPROC>(
        glXGetProcAddress(reinterpret_cast<const GLubyte*>("glXCreateContextAttribsARB")));
    const int attributes[] = {
        GLX_CONTEXT_MAJOR_VERSION_ARB,    3,   GLX_CONTEXT_MINOR_VERSION_ARB, 3, GLX_CONTEXT_PROFILE_MASK_ARB,
        GLX_CONTEXT_CORE_PROFILE_BIT_ARB, None};
    const GLXContext made = create(display, config, share, True, attributes);
    if (made == nullptr) {
        fail("no core context");
    }
    return made;
}

} // namespace programs
