// Syncs of EGL order threads whose contexts share nothing but images and surfaces: what a thread has
// encoded is with the nodes before another one goes on.
#pragma once

#include <EGL/egl.h>
#include <EGL/eglext.h>

namespace mural {

EGLSync createSync(EGLDisplay dpy, EGLenum type, const EGLAttrib* attributes);
EGLSyncKHR createSyncKhr(EGLDisplay dpy, EGLenum type, const EGLint* attributes);
EGLint clientWaitSync(EGLDisplay dpy, EGLSync sync, EGLint flags, EGLTime timeout);
EGLint clientWaitSyncKhr(EGLDisplay dpy, EGLSyncKHR sync, EGLint flags, EGLTimeKHR timeout);
EGLBoolean signalSync(EGLDisplay dpy, EGLSyncKHR sync, EGLenum mode);

} // namespace mural
