#include "interposer/entry/egl_images.hpp"

#include "interposer/context/context.hpp"
#include "interposer/entry/wrapped_library.hpp"
#include "interposer/diagnostics/log.hpp"
#include "interposer/diagnostics/native_count.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/encode/session.hpp"

namespace mural {

namespace {

template <class F> F* real(const char* name) { return reinterpret_cast<F*>(eglLibrary().behind(name)); }

bool ofGlObject(EGLenum target) {
    return target == EGL_GL_RENDERBUFFER ||
           (target >= EGL_GL_TEXTURE_2D && target <= EGL_GL_TEXTURE_CUBE_MAP_NEGATIVE_Z);
}

template <class Attribute> int32_t valueOf(const Attribute* attributes, EGLint name) {
    for (const Attribute* a = attributes; a && *a != EGL_NONE; a += 2) {
        if (a[0] == name) return static_cast<int32_t>(a[1]);
    }
    return 0;
}

// Writes records with the thread's own state, which works without a current context, too. Publishes them at once,
// because another thread may use the image next.
template <class Write> void sendToNodes(Write&& write) {
    Session* s = Session::current();
    if (nativeRun() || !s || !s->alive()) return;
    ThreadState& t = ownThreadState();
    write(t);
    s->publish(t, false);
}

template <class Attribute>
void sendCreated(EGLImage image, EGLContext native, EGLenum target, EGLClientBuffer buffer,
                 const Attribute* attributes) {
    if (!image || nativeRun()) return;
    const Context* context = native ? findContext(native) : nullptr;
    const uint32_t sharer = context ? announcedSharer(*context) : 0;
    if (!ofGlObject(target) || !sharer) {
        static bool once = false;
        if (!__atomic_exchange_n(&once, true, __ATOMIC_RELAXED))
            say("eglCreateImage of target 0x%x is not supported on the wall (such images exist on one machine only)",
                target);
        return;
    }
    const auto name = static_cast<uint32_t>(reinterpret_cast<uintptr_t>(buffer));
    const records::ImageInfo info{
        reinterpret_cast<uint64_t>(image),          sharer, target, name, valueOf(attributes, EGL_GL_TEXTURE_LEVEL),
        valueOf(attributes, EGL_GL_TEXTURE_ZOFFSET)};
    sendToNodes([&](ThreadState& t) { records::createImage(t, info); });
}

void sendDestroyed(EGLImage image) {
    sendToNodes([&](ThreadState& t) { records::destroyImage(t, reinterpret_cast<uint64_t>(image)); });
}

} // namespace

EGLImage createImage(EGLDisplay dpy, EGLContext context, EGLenum target, EGLClientBuffer buffer,
                     const EGLAttrib* attributes) {
    static auto* call =
        real<EGLImage(EGLDisplay, EGLContext, EGLenum, EGLClientBuffer, const EGLAttrib*)>("eglCreateImage");
    const EGLImage made = call(dpy, context, target, buffer, attributes);
    sendCreated(made, context, target, buffer, attributes);
    return made;
}

EGLImageKHR createImageKhr(EGLDisplay dpy, EGLContext context, EGLenum target, EGLClientBuffer buffer,
                           const EGLint* attributes) {
    static auto* call =
        real<EGLImageKHR(EGLDisplay, EGLContext, EGLenum, EGLClientBuffer, const EGLint*)>("eglCreateImageKHR");
    const EGLImageKHR made = call(dpy, context, target, buffer, attributes);
    sendCreated(made, context, target, buffer, attributes);
    return made;
}

// Sends the destruction first, because the driver may reuse the image's number as soon as it is freed.
EGLBoolean destroyImage(EGLDisplay dpy, EGLImage image) {
    static auto* call = real<EGLBoolean(EGLDisplay, EGLImage)>("eglDestroyImage");
    sendDestroyed(image);
    return call(dpy, image);
}
EGLBoolean destroyImageKhr(EGLDisplay dpy, EGLImageKHR image) {
    static auto* call = real<EGLBoolean(EGLDisplay, EGLImageKHR)>("eglDestroyImageKHR");
    sendDestroyed(image);
    return call(dpy, image);
}

} // namespace mural
