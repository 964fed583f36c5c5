// Pbuffers that can become textures (eglBindTexImage), each with a context of its own.
#pragma once

#include <EGL/egl.h>

namespace programs {

struct PbufferSource {
    EGLDisplay display;
    EGLSurface surface;
    EGLContext context;
};

PbufferSource makePbufferSource(EGLDisplay display, bool alpha);

// Makes the pbuffer current and draws into it.
void drawPbufferSource(const PbufferSource& s, unsigned seed);

void bindPbufferSource(const PbufferSource& s);

} // namespace programs
