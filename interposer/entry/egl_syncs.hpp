// EGL syncs order threads whose contexts share only images and surfaces: the encoded commands of one thread reach the
// nodes before another thread continues.
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
