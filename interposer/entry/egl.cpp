// The EGL entry. libEGL (of libglvnd) loads this library through the vendor file in __EGL_VENDOR_LIBRARY_FILENAMES. As
// in glx.cpp, calls are forwarded to the real vendor's library. Source: libglvnd, glvnd/libeglabi.h.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <glvnd/libeglabi.h>

#include "interposer/context/context.hpp"
#include "interposer/context/extensions.hpp"
#include "interposer/entry/egl_displays.hpp"
#include "interposer/entry/egl_images.hpp"
#include "interposer/entry/egl_syncs.hpp"
#include "interposer/entry/wrapped_library.hpp"
#include "interposer/entry/glvnd_environment.hpp"
#include "interposer/entry/own_functions.hpp"
#include "interposer/loader/libc_loader.hpp"
#include "interposer/diagnostics/log.hpp"
#include "interposer/diagnostics/native_count.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"
#include "interposer/readback/drawable_textures.hpp"
#include "interposer/x11/shown.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {

void* (*vendorGetProcAddress)(const char*) = nullptr;
EGLDisplay (*vendorGetPlatformDisplay)(EGLenum, void*, const EGLAttrib*) = nullptr;

Entry vendorEntry(const char* name) { return reinterpret_cast<Entry>(vendorGetProcAddress(name)); }
template <class F> F* real(const char* name) { return reinterpret_cast<F*>(eglLibrary().behind(name)); }

wire::WindowConfig configOf(EGLDisplay dpy, EGLConfig config) {
    static auto* get = real<EGLBoolean(EGLDisplay, EGLConfig, EGLint, EGLint*)>("eglGetConfigAttrib");
    const auto attribute = [&](EGLint name) {
        EGLint value = 0;
        return config && get && get(dpy, config, name, &value) ? value : 0;
    };
    wire::WindowConfig c{};
    c.red = clampByte(config ? attribute(EGL_RED_SIZE) : 8);
    c.green = clampByte(config ? attribute(EGL_GREEN_SIZE) : 8);
    c.blue = clampByte(config ? attribute(EGL_BLUE_SIZE) : 8);
    c.alpha = clampByte(attribute(EGL_ALPHA_SIZE));
    c.depth = clampByte(config ? attribute(EGL_DEPTH_SIZE) : 24);
    c.stencil = clampByte(config ? attribute(EGL_STENCIL_SIZE) : 8);
    c.samples = clampByte(attribute(EGL_SAMPLES));
    c.doubleBuffer = 1;
    return c;
}

Window* addSurface(EGLDisplay dpy, EGLSurface surface, EGLConfig config, uint64_t native, const EGLint* attributes,
                   bool pbuffer) {
    if (!surface || nativeRun()) return nullptr;
    wire::WindowConfig c = configOf(dpy, config);
    c.isPbuffer = pbuffer;
    // Mesa gives windows two buffers, whatever EGL_RENDER_BUFFER says, and other surfaces one. Desktop GL is queried
    // (readBufferFormats).
    c.doubleBuffer = !pbuffer;
    for (const EGLint* a = attributes; a && *a != EGL_NONE; a += 2) {
        if (a[0] == EGL_GL_COLORSPACE) c.srgb = a[1] == EGL_GL_COLORSPACE_SRGB;
    }
    const bool isX = hasXWindows(dpy) && native <= UINT32_MAX; // other platforms use pointers
    return addWindow(reinterpret_cast<uintptr_t>(surface), dpy, true, c, isX ? native : 0);
}

EGLSurface addPixmap(EGLDisplay dpy, EGLSurface surface, EGLConfig config, const EGLint* attributes) {
    if (Window* w = addSurface(dpy, surface, config, 0, attributes, true)) w->isPixmap = true;
    return surface;
}

EGLContext createContext(EGLDisplay dpy, EGLConfig config, EGLContext share, const EGLint* attributes) {
    static auto* call = real<EGLContext(EGLDisplay, EGLConfig, EGLContext, const EGLint*)>("eglCreateContext");
    static auto* queryApi = real<EGLenum()>("eglQueryAPI");
    const EGLContext made = call(dpy, config, share, attributes);
    if (made && !nativeRun()) {
        const bool desktop = queryApi && queryApi() == EGL_OPENGL_API;
        Context* c = addContext(made, dpy, findContext(share), desktop ? wire::Api::Desktop : wire::Api::Es2,
                                configOf(dpy, config));
        for (const EGLint* a = attributes; c && a && *a != EGL_NONE; a += 2) {
            if (a[0] == EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY ||
                a[0] == EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT)
                c->losesOnReset = a[1] == EGL_LOSE_CONTEXT_ON_RESET;
            if (a[0] == EGL_CONTEXT_RELEASE_BEHAVIOR_KHR)
                c->keepsUnflushed = a[1] == EGL_CONTEXT_RELEASE_BEHAVIOR_NONE_KHR;
        }
    }
    return made;
}

EGLBoolean destroyedContext(EGLDisplay dpy, EGLContext context) {
    static auto* call = real<EGLBoolean(EGLDisplay, EGLContext)>("eglDestroyContext");
    destroyContext(context);
    return call(dpy, context);
}

Window* windowFor(EGLDisplay dpy, EGLSurface surface) {
    return surface ? findWindow(reinterpret_cast<uintptr_t>(surface), dpy) : nullptr;
}

EGLBoolean makeCurrent(EGLDisplay dpy, EGLSurface draw, EGLSurface read, EGLContext context) {
    static auto* call = real<EGLBoolean(EGLDisplay, EGLSurface, EGLSurface, EGLContext)>("eglMakeCurrent");
    if (!nativeRun())
        beforeMakeCurrent(context ? findContext(context) : nullptr, windowFor(dpy, draw), windowFor(dpy, read));
    const EGLBoolean ok = call(dpy, draw, read, context);
    if (ok && !nativeRun())
        becameCurrent(context ? findContext(context) : nullptr, windowFor(dpy, draw), windowFor(dpy, read));
    return ok;
}

// Releases the thread's context.
EGLBoolean releaseThread() {
    static auto* call = real<EGLBoolean()>("eglReleaseThread");
    const EGLBoolean ok = call();
    if (ok && !nativeRun() && tThread->context) becameCurrent(nullptr, nullptr, nullptr);
    return ok;
}

EGLBoolean terminate(EGLDisplay dpy) {
    static auto* call = real<EGLBoolean(EGLDisplay)>("eglTerminate");
    if (!nativeRun()) displayEnds(dpy, true);
    return call(dpy);
}

void frameShown(EGLDisplay dpy, EGLSurface surface) {
    if (nativeRun())
        countNativeFrame();
    else
        endFrame(windowFor(dpy, surface));
}

// EGL 1.5, 3.10.1: only a surface that is current for drawing is shown. The driver reports the error.
bool isCurrentForDrawing(const Window* w) { return w && tThread->context && tThread->context->drawWindow == w->id; }

template <class Call> EGLBoolean swap(EGLDisplay dpy, EGLSurface surface, Call&& call) {
    if (!nativeRun() && !isCurrentForDrawing(windowFor(dpy, surface))) {
        const EGLBoolean ok = call();
        if (ok) frameShown(dpy, surface);
        return ok;
    }
    frameShown(dpy, surface);
    return swapsItself(windowFor(dpy, surface)) ? call() : EGL_TRUE;
}

EGLBoolean swapBuffers(EGLDisplay dpy, EGLSurface surface) {
    static auto* call = real<EGLBoolean(EGLDisplay, EGLSurface)>("eglSwapBuffers");
    return swap(dpy, surface, [&] { return call(dpy, surface); });
}
EGLBoolean swapBuffersWithDamageKhr(EGLDisplay dpy, EGLSurface surface, const EGLint* rects, EGLint n) {
    static auto* call = real<EGLBoolean(EGLDisplay, EGLSurface, const EGLint*, EGLint)>("eglSwapBuffersWithDamageKHR");
    return swap(dpy, surface, [&] { return call(dpy, surface, rects, n); });
}
EGLBoolean swapBuffersWithDamageExt(EGLDisplay dpy, EGLSurface surface, const EGLint* rects, EGLint n) {
    static auto* call = real<EGLBoolean(EGLDisplay, EGLSurface, const EGLint*, EGLint)>("eglSwapBuffersWithDamageEXT");
    return swap(dpy, surface, [&] { return call(dpy, surface, rects, n); });
}

// Not advertised. If a program calls it nevertheless, the whole picture is shown.
EGLBoolean postSubBuffer(EGLDisplay dpy, EGLSurface surface, EGLint x, EGLint y, EGLint width, EGLint height) {
    static auto* call = real<EGLBoolean(EGLDisplay, EGLSurface, EGLint, EGLint, EGLint, EGLint)>("eglPostSubBufferNV");
    return swap(dpy, surface, [&] { return call(dpy, surface, x, y, width, height); });
}

EGLBoolean waitGl() {
    static auto* call = real<EGLBoolean()>("eglWaitGL");
    waitGlShown();
    return call();
}
EGLBoolean waitClient() {
    static auto* call = real<EGLBoolean()>("eglWaitClient");
    waitGlShown();
    return call();
}

EGLSurface createWindowSurface(EGLDisplay dpy, EGLConfig config, EGLNativeWindowType window, const EGLint* attributes) {
    static auto* call =
        real<EGLSurface(EGLDisplay, EGLConfig, EGLNativeWindowType, const EGLint*)>("eglCreateWindowSurface");
    const EGLSurface made = call(dpy, config, window, attributes);
    addSurface(dpy, made, config, static_cast<uint64_t>(window), attributes, false);
    return made;
}

// Converts the attributes of platform functions to the type of the other functions.
struct Narrow {
    explicit Narrow(const EGLAttrib* attributes) {
        int n = 0;
        for (; attributes && n < 32 && attributes[n] != EGL_NONE; n += 2) {
            list[n] = static_cast<EGLint>(attributes[n]);
            list[n + 1] = static_cast<EGLint>(attributes[n + 1]);
        }
        list[n] = EGL_NONE;
    }
    EGLint list[33];
};

// Platform surfaces of X11 take a pointer to the window's id (EXT_platform_x11, EXT_platform_xcb).
EGLSurface createPlatformWindowSurface(EGLDisplay dpy, EGLConfig config, void* window, const EGLAttrib* attributes) {
    static auto* call =
        real<EGLSurface(EGLDisplay, EGLConfig, void*, const EGLAttrib*)>("eglCreatePlatformWindowSurface");
    const EGLSurface made = call(dpy, config, window, attributes);
    const Narrow narrow(attributes);
    addSurface(dpy, made, config, window ? *static_cast<uint32_t*>(window) : 0, narrow.list, false);
    return made;
}
EGLSurface createPlatformWindowSurfaceExt(EGLDisplay dpy, EGLConfig config, void* window, const EGLint* attributes) {
    static auto* call =
        real<EGLSurface(EGLDisplay, EGLConfig, void*, const EGLint*)>("eglCreatePlatformWindowSurfaceEXT");
    const EGLSurface made = call(dpy, config, window, attributes);
    addSurface(dpy, made, config, window ? *static_cast<uint32_t*>(window) : 0, attributes, false);
    return made;
}
EGLSurface createPixmapSurface(EGLDisplay dpy, EGLConfig config, EGLNativePixmapType pixmap, const EGLint* attributes) {
    static auto* call =
        real<EGLSurface(EGLDisplay, EGLConfig, EGLNativePixmapType, const EGLint*)>("eglCreatePixmapSurface");
    return addPixmap(dpy, call(dpy, config, pixmap, attributes), config, attributes);
}
EGLSurface createPlatformPixmapSurface(EGLDisplay dpy, EGLConfig config, void* pixmap, const EGLAttrib* attributes) {
    static auto* call =
        real<EGLSurface(EGLDisplay, EGLConfig, void*, const EGLAttrib*)>("eglCreatePlatformPixmapSurface");
    return addPixmap(dpy, call(dpy, config, pixmap, attributes), config, Narrow(attributes).list);
}
EGLSurface createPlatformPixmapSurfaceExt(EGLDisplay dpy, EGLConfig config, void* pixmap, const EGLint* attributes) {
    static auto* call =
        real<EGLSurface(EGLDisplay, EGLConfig, void*, const EGLint*)>("eglCreatePlatformPixmapSurfaceEXT");
    return addPixmap(dpy, call(dpy, config, pixmap, attributes), config, attributes);
}
EGLSurface createPbufferSurface(EGLDisplay dpy, EGLConfig config, const EGLint* attributes) {
    static auto* call = real<EGLSurface(EGLDisplay, EGLConfig, const EGLint*)>("eglCreatePbufferSurface");
    const EGLSurface made = call(dpy, config, attributes);
    addSurface(dpy, made, config, 0, attributes, true);
    return made;
}
EGLBoolean destroySurface(EGLDisplay dpy, EGLSurface surface) {
    static auto* call = real<EGLBoolean(EGLDisplay, EGLSurface)>("eglDestroySurface");
    destroyWindow(reinterpret_cast<uintptr_t>(surface), dpy);
    return call(dpy, surface);
}
// Makes the picture of a pbuffer a texture. Each node receives the picture that is combined from all nodes.
EGLBoolean bindTexImage(EGLDisplay dpy, EGLSurface surface, EGLint buffer) {
    static auto* call = real<EGLBoolean(EGLDisplay, EGLSurface, EGLint)>("eglBindTexImage");
    static auto* query = real<EGLBoolean(EGLDisplay, EGLSurface, EGLint, EGLint*)>("eglQuerySurface");
    const EGLBoolean ok = call(dpy, surface, buffer);
    Window* w = ok && !nativeRun() ? windowFor(dpy, surface) : nullptr;
    EGLint format = 0;
    if (w && query && query(dpy, surface, EGL_TEXTURE_FORMAT, &format)) bindDrawn(*w, format == EGL_TEXTURE_RGBA);
    return ok;
}

EGLBoolean releaseTexImage(EGLDisplay dpy, EGLSurface surface, EGLint buffer) {
    static auto* call = real<EGLBoolean(EGLDisplay, EGLSurface, EGLint)>("eglReleaseTexImage");
    const EGLBoolean ok = call(dpy, surface, buffer);
    if (Window* w = ok ? windowFor(dpy, surface) : nullptr) releaseDrawn(*w);
    return ok;
}

const char* queryString(EGLDisplay dpy, EGLint name) {
    static auto* call = real<const char*(EGLDisplay, EGLint)>("eglQueryString");
    const char* text = call(dpy, name);
    return name == EGL_EXTENSIONS && !nativeRun() ? filterWindowSystemExtensions(text) : text;
}

// Vendors receive eglGetDisplay and eglGetPlatformDisplay(EXT) as this call.
EGLDisplay getPlatformDisplay(EGLenum platform, void* native, const EGLAttrib* attributes) {
    const EGLDisplay made = vendorGetPlatformDisplay(platform, native, attributes);
    rememberDisplay(made, platform, native);
    return made;
}

void* getProcAddress(const char* name) { return reinterpret_cast<void*>(eglLibrary().entryFor(name)); }

const OwnEntry kOwn[] = {
    ownEntry("eglCreateContext", createContext),
    ownEntry("eglDestroyContext", destroyedContext),
    ownEntry("eglMakeCurrent", makeCurrent),
    ownEntry("eglSwapBuffers", swapBuffers),
    ownEntry("eglReleaseThread", releaseThread),
    ownEntry("eglTerminate", terminate),
    ownEntry("eglPostSubBufferNV", postSubBuffer),
    ownEntry("eglWaitGL", waitGl),
    ownEntry("eglWaitClient", waitClient),
    ownEntry("eglSwapBuffersWithDamageKHR", swapBuffersWithDamageKhr),
    ownEntry("eglSwapBuffersWithDamageEXT", swapBuffersWithDamageExt),
    ownEntry("eglCreateWindowSurface", createWindowSurface),
    ownEntry("eglCreatePlatformWindowSurface", createPlatformWindowSurface),
    ownEntry("eglCreatePlatformWindowSurfaceEXT", createPlatformWindowSurfaceExt),
    ownEntry("eglCreatePixmapSurface", createPixmapSurface),
    ownEntry("eglCreatePlatformPixmapSurface", createPlatformPixmapSurface),
    ownEntry("eglCreatePlatformPixmapSurfaceEXT", createPlatformPixmapSurfaceExt),
    ownEntry("eglCreatePbufferSurface", createPbufferSurface),
    ownEntry("eglDestroySurface", destroySurface),
    ownEntry("eglCreateImage", createImage),
    ownEntry("eglCreateImageKHR", createImageKhr),
    ownEntry("eglDestroyImage", destroyImage),
    ownEntry("eglDestroyImageKHR", destroyImageKhr),
    ownEntry("eglCreateSync", createSync),
    ownEntry("eglCreateSyncKHR", createSyncKhr),
    ownEntry("eglClientWaitSync", clientWaitSync),
    ownEntry("eglClientWaitSyncKHR", clientWaitSyncKhr),
    ownEntry("eglSignalSyncKHR", signalSync),
    ownEntry("eglBindTexImage", bindTexImage),
    ownEntry("eglReleaseTexImage", releaseTexImage),
    ownEntry("eglQueryString", queryString),
    ownEntry("eglGetProcAddress", getProcAddress),
};
constinit WrappedLibrary library("egl", kOwn);

// Opens the library that a vendor file (JSON) names; null if there is none.
void* openNamedBy(const char* vendorFile) {
    FILE* file = fopen(vendorFile, "re");
    if (!file) return nullptr;
    char text[4096];
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    char* at = std::strstr(text, "\"library_path\"");
    at = at ? std::strchr(at + sizeof "\"library_path\"" - 1, '"') : nullptr;
    char* end = at ? std::strchr(++at, '"') : nullptr;
    if (!end) return nullptr;
    *end = 0;
    return loader::openLibrary(at, RTLD_LAZY);
}

// Opens the vendor library from the user's own list of vendor files, otherwise a common one.
void* openVendor() {
    const char* list = wantedEglVendors();
    while (list && *list) {
        char path[4096];
        const size_t length = std::strcspn(list, ":");
        if (length > 0 && length < sizeof path) {
            std::memcpy(path, list, length);
            path[length] = 0;
            if (void* handle = openNamedBy(path)) return handle;
        }
        list += length + (list[length] == ':');
    }
    for (const char* name : {"libEGL_mesa.so.0", "libEGL_nvidia.so.0"}) {
        if (void* handle = loader::openLibrary(name, RTLD_LAZY)) return handle;
    }
    say("no EGL driver found (libEGL_mesa.so.0): install libegl-mesa0");
    return nullptr;
}

} // namespace

WrappedLibrary& eglLibrary() { return library; }

bool makeEglCurrent(const Window& draw, const Window& read, const Context& context) {
    static auto* call = real<EGLBoolean(EGLDisplay, EGLSurface, EGLSurface, EGLContext)>("eglMakeCurrent");
    return call && call(draw.display, reinterpret_cast<EGLSurface>(draw.drawable),
                        reinterpret_cast<EGLSurface>(read.drawable), context.native);
}

bool queryEglSize(const Window& w, uint32_t& width, uint32_t& height) {
    static auto* query = real<EGLBoolean(EGLDisplay, EGLSurface, EGLint, EGLint*)>("eglQuerySurface");
    if (w.nativeGone) return false;
    if (w.native && queryXSize(w.display, w.native, width, height)) return width > 0 && height > 0;
    EGLint a = 0, b = 0;
    auto* surface = reinterpret_cast<EGLSurface>(w.drawable);
    if (!query || !query(w.display, surface, EGL_WIDTH, &a) || !query(w.display, surface, EGL_HEIGHT, &b)) return false;
    width = static_cast<uint32_t>(a);
    height = static_cast<uint32_t>(b);
    return a > 0 && b > 0;
}

} // namespace mural

extern "C" __attribute__((visibility("default"))) EGLBoolean __egl_Main(uint32_t version,
                                                                        const __EGLapiExports* exports,
                                                                        __EGLvendorInfo* vendor,
                                                                        __EGLapiImports* imports) {
    using Main = EGLBoolean(uint32_t, const __EGLapiExports*, __EGLvendorInfo*, __EGLapiImports*);
    void* handle = mural::openVendor();
    auto* main = handle ? reinterpret_cast<Main*>(mural::loader::symbolIn(handle, "__egl_Main")) : nullptr;
    if (!main || !main(version, exports, vendor, imports)) return EGL_FALSE;
    mural::loader::keepLoaded(exports); // as in glx.cpp
    if (!mural::claimProgram(mural::EntryKind::Vendor)) return EGL_TRUE;
    mural::vendorGetProcAddress = imports->getProcAddress;
    imports->getProcAddress = mural::getProcAddress;
    mural::vendorGetPlatformDisplay = imports->getPlatformDisplay;
    imports->getPlatformDisplay = mural::getPlatformDisplay;
    mural::forbidPatching(*imports);
    mural::library.attach(mural::vendorEntry);
    return EGL_TRUE;
}
