#include "interposer/entry/egl_syncs.hpp"

#include "encoders.hpp"
#include "interposer/entry/wrapped_library.hpp"
#include "interposer/encode/session.hpp"
#include "interposer/context/thread_state.hpp"

namespace mural {

namespace {
template <class F> F* real(const char* name) { return reinterpret_cast<F*>(eglLibrary().behind(name)); }

void publishOwn() {
    if (Session* s = Session::current(); s && tThread->context) s->publish(*tThread, false);
}

// Flushes the commands before the sync at its creation; nodes do not flush when they switch contexts.
void flushOwn() {
    if (tThread->context) encode_glFlush(*tThread);
    publishOwn();
}
} // namespace

EGLSync createSync(EGLDisplay dpy, EGLenum type, const EGLAttrib* attributes) {
    static auto* call = real<EGLSync(EGLDisplay, EGLenum, const EGLAttrib*)>("eglCreateSync");
    flushOwn();
    return call(dpy, type, attributes);
}
EGLSyncKHR createSyncKhr(EGLDisplay dpy, EGLenum type, const EGLint* attributes) {
    static auto* call = real<EGLSyncKHR(EGLDisplay, EGLenum, const EGLint*)>("eglCreateSyncKHR");
    flushOwn();
    return call(dpy, type, attributes);
}
EGLint clientWaitSync(EGLDisplay dpy, EGLSync sync, EGLint flags, EGLTime timeout) {
    static auto* call = real<EGLint(EGLDisplay, EGLSync, EGLint, EGLTime)>("eglClientWaitSync");
    flags& EGL_SYNC_FLUSH_COMMANDS_BIT ? flushOwn() : publishOwn();
    return call(dpy, sync, flags, timeout);
}
EGLint clientWaitSyncKhr(EGLDisplay dpy, EGLSyncKHR sync, EGLint flags, EGLTimeKHR timeout) {
    static auto* call = real<EGLint(EGLDisplay, EGLSyncKHR, EGLint, EGLTimeKHR)>("eglClientWaitSyncKHR");
    flags& EGL_SYNC_FLUSH_COMMANDS_BIT_KHR ? flushOwn() : publishOwn();
    return call(dpy, sync, flags, timeout);
}
EGLBoolean signalSync(EGLDisplay dpy, EGLSyncKHR sync, EGLenum mode) {
    static auto* call = real<EGLBoolean(EGLDisplay, EGLSyncKHR, EGLenum)>("eglSignalSyncKHR");
    publishOwn();
    return call(dpy, sync, mode);
}

} // namespace mural
