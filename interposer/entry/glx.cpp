// The GLX entry. libGLX (of libglvnd) loads this library as a vendor named "mural". It forwards all calls to the real
// vendor's library, except those that create contexts, bind them, or show pictures. Every GL call thus arrives here,
// regardless of how the program found the function. Source: libglvnd, glvnd/libglxabi.h.
#include <cstdlib>
#include <cstring>
#include <X11/Xlib.h>
#include <glvnd/libglxabi.h>

#include "interposer/context/context.hpp"
#include "interposer/context/extensions.hpp"
#include "interposer/entry/wrapped_library.hpp"
#include "interposer/entry/glx_fonts.hpp"
#include "interposer/entry/glvnd_environment.hpp"
#include "interposer/entry/glx_types.hpp"
#include "interposer/entry/own_functions.hpp"
#include "interposer/entry/xlib.hpp"
#include "interposer/context/object_registry.hpp"
#include "interposer/loader/libc_loader.hpp"
#include "interposer/diagnostics/log.hpp"
#include "interposer/diagnostics/native_count.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"
#include "interposer/readback/drawable_textures.hpp"
#include "interposer/x11/shown.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

using glx::XID;

namespace {

void* (*vendorGetProcAddress)(const GLubyte*) = nullptr;

Entry vendorEntry(const char* name) {
    return reinterpret_cast<Entry>(vendorGetProcAddress(reinterpret_cast<const GLubyte*>(name)));
}

// Returns the real library's own GLX function.
template <class F> F* real(const char* name) { return reinterpret_cast<F*>(glxLibrary().behind(name)); }

// Returns the bits of a visual or framebuffer configuration. `attribute` queries one attribute.
template <class Query> wire::WindowConfig configFrom(Query attribute) {
    wire::WindowConfig c{};
    c.red = clampByte(attribute(glx::kRed));
    c.green = clampByte(attribute(glx::kGreen));
    c.blue = clampByte(attribute(glx::kBlue));
    c.alpha = clampByte(attribute(glx::kAlpha));
    c.depth = clampByte(attribute(glx::kDepth));
    c.stencil = clampByte(attribute(glx::kStencil));
    c.samples = clampByte(attribute(glx::kSamples));
    c.doubleBuffer = attribute(glx::kDoubleBuffer) != 0;
    c.accum = clampByte(attribute(glx::kAccumRed));
    c.stereo = attribute(glx::kStereo) != 0;
    c.srgb = attribute(glx::kSrgbCapable) != 0;
    return c;
}

wire::WindowConfig configOfFb(Display* dpy, GLXFBConfig fb) {
    static auto* get = real<int(Display*, GLXFBConfig, int, int*)>("glXGetFBConfigAttrib");
    return configFrom([&](int name) {
        int value = 0;
        if (!get || !fb || get(dpy, fb, name, &value) != 0) value = 0;
        return value;
    });
}

wire::WindowConfig configOfVisual(Display* dpy, XVisualInfo* visual) {
    static auto* get = real<int(Display*, XVisualInfo*, int, int*)>("glXGetConfig");
    return configFrom([&](int name) {
        int value = 0;
        if (!get || !visual || get(dpy, visual, name, &value) != 0) value = 0;
        return value;
    });
}

wire::WindowConfig defaultConfig() {
    wire::WindowConfig c{};
    c.red = c.green = c.blue = 8;
    c.depth = 24;
    c.stencil = 8;
    c.doubleBuffer = 1;
    return c;
}

Window* windowFor(Display* dpy, XID drawable, const Context& context) {
    return drawable ? known::bareWindow(drawable, dpy, context.config) : nullptr;
}

GLXContext created(Display* dpy, GLXContext made, GLXContext share, const wire::WindowConfig& config) {
    if (made && !nativeRun()) addContext(made, dpy, findContext(share), wire::Api::Desktop, config);
    return made;
}

GLXContext createContext(Display* dpy, XVisualInfo* visual, GLXContext share, Bool direct) {
    static auto* call = real<GLXContext(Display*, XVisualInfo*, GLXContext, Bool)>("glXCreateContext");
    return created(dpy, call(dpy, visual, share, direct), share, configOfVisual(dpy, visual));
}

GLXContext createNewContext(Display* dpy, GLXFBConfig fb, int type, GLXContext share, Bool direct) {
    static auto* call = real<GLXContext(Display*, GLXFBConfig, int, GLXContext, Bool)>("glXCreateNewContext");
    return created(dpy, call(dpy, fb, type, share, direct), share, configOfFb(dpy, fb));
}

GLXContext createContextWithConfig(Display* dpy, GLXFBConfig fb, int type, GLXContext share, Bool direct) {
    static auto* call =
        real<GLXContext(Display*, GLXFBConfig, int, GLXContext, Bool)>("glXCreateContextWithConfigSGIX");
    return created(dpy, call(dpy, fb, type, share, direct), share, configOfFb(dpy, fb));
}

GLXContext createContextAttribs(Display* dpy, GLXFBConfig fb, GLXContext share, Bool direct, const int* attributes) {
    static auto* call =
        real<GLXContext(Display*, GLXFBConfig, GLXContext, Bool, const int*)>("glXCreateContextAttribsARB");
    const GLXContext made =
        created(dpy, call(dpy, fb, share, direct, attributes), share, fb ? configOfFb(dpy, fb) : defaultConfig());
    Context* c = made && !nativeRun() ? findContext(made) : nullptr;
    for (const int* a = attributes; c && a && *a; a += 2) {
        if (a[0] == glx::kResetStrategy) c->losesOnReset = a[1] == glx::kLoseOnReset;
        if (a[0] == glx::kReleaseBehavior) c->keepsUnflushed = a[1] == 0;
    }
    return made;
}

void destroyedContext(Display* dpy, GLXContext context) {
    static auto* call = real<void(Display*, GLXContext)>("glXDestroyContext");
    destroyContext(context);
    call(dpy, context);
}

Bool madeCurrent(Bool ok, Display* dpy, XID draw, XID read, GLXContext native) {
    if (!ok || nativeRun()) return ok;
    Context* c = native ? findContext(native) : nullptr;
    becameCurrent(c, c ? windowFor(dpy, draw, *c) : nullptr, c ? windowFor(dpy, read, *c) : nullptr);
    return ok;
}

void beforeBinding(Display* dpy, XID draw, XID read, GLXContext native) {
    if (!nativeRun())
        beforeMakeCurrent(native ? findContext(native) : nullptr, draw ? findWindow(draw, dpy) : nullptr,
                          read ? findWindow(read, dpy) : nullptr);
}

Bool makeCurrent(Display* dpy, XID drawable, GLXContext context) {
    static auto* call = real<Bool(Display*, XID, GLXContext)>("glXMakeCurrent");
    beforeBinding(dpy, drawable, drawable, context);
    return madeCurrent(call(dpy, drawable, context), dpy, drawable, drawable, context);
}

Bool makeContextCurrent(Display* dpy, XID draw, XID read, GLXContext context) {
    static auto* call = real<Bool(Display*, XID, XID, GLXContext)>("glXMakeContextCurrent");
    beforeBinding(dpy, draw, read, context);
    return madeCurrent(call(dpy, draw, read, context), dpy, draw, read, context);
}

Bool makeCurrentRead(Display* dpy, XID draw, XID read, GLXContext context) {
    static auto* call = real<Bool(Display*, XID, XID, GLXContext)>("glXMakeCurrentReadSGI");
    beforeBinding(dpy, draw, read, context);
    return madeCurrent(call(dpy, draw, read, context), dpy, draw, read, context);
}

void swapBuffers(Display* dpy, XID drawable) {
    static auto* call = real<void(Display*, XID)>("glXSwapBuffers");
    if (nativeRun())
        countNativeFrame();
    else
        endFrame(findWindow(drawable, dpy));
    if (swapsItself(findWindow(drawable, dpy))) call(dpy, drawable);
}

int64_t swapBuffersMsc(Display* dpy, XID drawable, int64_t target, int64_t divisor, int64_t remainder) {
    static auto* call = real<int64_t(Display*, XID, int64_t, int64_t, int64_t)>("glXSwapBuffersMscOML");
    if (nativeRun())
        countNativeFrame();
    else
        endFrame(findWindow(drawable, dpy));
    return swapsItself(findWindow(drawable, dpy)) ? call(dpy, drawable, target, divisor, remainder) : 0;
}

// Not advertised. If a program calls it nevertheless, the whole picture is shown.
void copySubBuffer(Display* dpy, XID drawable, int x, int y, int width, int height) {
    static auto* call = real<void(Display*, XID, int, int, int, int)>("glXCopySubBufferMESA");
    if (!nativeRun()) endFrame(findWindow(drawable, dpy));
    if (swapsItself(findWindow(drawable, dpy))) call(dpy, drawable, x, y, width, height);
}

void waitGl() {
    static auto* call = real<void()>("glXWaitGL");
    waitGlShown();
    call();
}

void useXFont(Font font, int first, int count, int listBase) {
    static auto* call = real<void(Font, int, int, int)>("glXUseXFont");
    const Context* c = tThread->context;
    const Window* w = c ? findWindowById(c->drawWindow) : nullptr;
    const bool isCaptured = w && !w->isEgl && !nativeRun();
    if (!isCaptured || !listsFromXFont(static_cast<Display*>(w->display), font, first, count, listBase))
        call(font, first, count, listBase);
}

GLXWindow createWindow(Display* dpy, GLXFBConfig fb, ::Window window, const int* attributes) {
    static auto* call = real<GLXWindow(Display*, GLXFBConfig, ::Window, const int*)>("glXCreateWindow");
    const GLXWindow made = call(dpy, fb, window, attributes);
    if (made && !nativeRun()) addWindow(made, dpy, false, configOfFb(dpy, fb), window);
    return made;
}

void destroyGlxWindow(Display* dpy, GLXWindow window) {
    static auto* call = real<void(Display*, GLXWindow)>("glXDestroyWindow");
    destroyWindow(window, dpy);
    call(dpy, window);
}

void addPbuffer(Display* dpy, GLXFBConfig fb, GLXPbuffer made) {
    if (!made || nativeRun()) return;
    wire::WindowConfig config = configOfFb(dpy, fb);
    config.isPbuffer = 1;
    addWindow(made, dpy, false, config, 0);
}

GLXPbuffer createPbuffer(Display* dpy, GLXFBConfig fb, const int* attributes) {
    static auto* call = real<GLXPbuffer(Display*, GLXFBConfig, const int*)>("glXCreatePbuffer");
    const GLXPbuffer made = call(dpy, fb, attributes);
    addPbuffer(dpy, fb, made);
    return made;
}

GLXPbuffer createSgixPbuffer(Display* dpy, GLXFBConfig fb, unsigned width, unsigned height, int* attributes) {
    static auto* call = real<GLXPbuffer(Display*, GLXFBConfig, unsigned, unsigned, int*)>("glXCreateGLXPbufferSGIX");
    const GLXPbuffer made = call(dpy, fb, width, height, attributes);
    addPbuffer(dpy, fb, made);
    return made;
}

void destroySgixPbuffer(Display* dpy, GLXPbuffer pbuffer) {
    static auto* call = real<void(Display*, GLXPbuffer)>("glXDestroyGLXPbufferSGIX");
    destroyWindow(pbuffer, dpy);
    call(dpy, pbuffer);
}

void destroyPbuffer(Display* dpy, GLXPbuffer pbuffer) {
    static auto* call = real<void(Display*, GLXPbuffer)>("glXDestroyPbuffer");
    destroyWindow(pbuffer, dpy);
    call(dpy, pbuffer);
}

GLXPixmap createdPixmap(Display* dpy, GLXPixmap made, wire::WindowConfig config) {
    if (!made || nativeRun()) return made;
    config.isPbuffer = 1;
    if (Window* w = addWindow(made, dpy, false, config, 0)) w->isPixmap = true;
    return made;
}

GLXPixmap createPixmap(Display* dpy, GLXFBConfig fb, Pixmap pixmap, const int* attributes) {
    static auto* call = real<GLXPixmap(Display*, GLXFBConfig, Pixmap, const int*)>("glXCreatePixmap");
    return createdPixmap(dpy, call(dpy, fb, pixmap, attributes), configOfFb(dpy, fb));
}

GLXPixmap createGlxPixmap(Display* dpy, XVisualInfo* visual, Pixmap pixmap) {
    static auto* call = real<GLXPixmap(Display*, XVisualInfo*, Pixmap)>("glXCreateGLXPixmap");
    return createdPixmap(dpy, call(dpy, visual, pixmap), configOfVisual(dpy, visual));
}

GLXPixmap createGlxPixmapWithConfig(Display* dpy, GLXFBConfig fb, Pixmap pixmap) {
    static auto* call = real<GLXPixmap(Display*, GLXFBConfig, Pixmap)>("glXCreateGLXPixmapWithConfigSGIX");
    return createdPixmap(dpy, call(dpy, fb, pixmap), configOfFb(dpy, fb));
}

void destroyPixmap(Display* dpy, GLXPixmap pixmap) {
    static auto* call = real<void(Display*, GLXPixmap)>("glXDestroyPixmap");
    destroyWindow(pixmap, dpy);
    call(dpy, pixmap);
}

void destroyGlxPixmap(Display* dpy, GLXPixmap pixmap) {
    static auto* call = real<void(Display*, GLXPixmap)>("glXDestroyGLXPixmap");
    destroyWindow(pixmap, dpy);
    call(dpy, pixmap);
}

// The driver copies the pixmap or uses it directly. The nodes receive the resulting texture image.
void bindTexImage(Display* dpy, XID drawable, int buffer, const int* attributes) {
    static auto* call = real<void(Display*, XID, int, const int*)>("glXBindTexImageEXT");
    static auto* query = real<void(Display*, XID, int, unsigned*)>("glXQueryDrawable");
    call(dpy, drawable, buffer, attributes);
    if (nativeRun() || !query) return;
    unsigned target = 0, format = 0;
    query(dpy, drawable, glx::kTextureTarget, &target);
    query(dpy, drawable, glx::kTextureFormat, &format);
    if (target == glx::kTexture2d || target == glx::kTextureRectangle)
        textureFromLocal(target == glx::kTexture2d ? GL_TEXTURE_2D : GL_TEXTURE_RECTANGLE, format == glx::kTextureRgba);
}

// Filters the result of the three extension queries: only extensions that work across machines are reported.
const char* advertised(const char* text) { return nativeRun() ? text : filterWindowSystemExtensions(text); }

const char* queryExtensionsString(Display* dpy, int screen) {
    static auto* call = real<const char*(Display*, int)>("glXQueryExtensionsString");
    return advertised(call(dpy, screen));
}

const char* getClientString(Display* dpy, int name) {
    static auto* call = real<const char*(Display*, int)>("glXGetClientString");
    const char* text = call(dpy, name);
    return name == glx::kExtensions ? advertised(text) : text;
}

const char* queryServerString(Display* dpy, int screen, int name) {
    static auto* call = real<const char*(Display*, int, int)>("glXQueryServerString");
    const char* text = call(dpy, screen, name);
    return name == glx::kExtensions ? advertised(text) : text;
}

void* getProcAddress(const GLubyte* name) {
    return reinterpret_cast<void*>(glxLibrary().entryFor(reinterpret_cast<const char*>(name)));
}

const OwnEntry kOwn[] = {
    ownEntry("glXCreateContext", createContext),
    ownEntry("glXCreateNewContext", createNewContext),
    ownEntry("glXCreateContextWithConfigSGIX", createContextWithConfig),
    ownEntry("glXCreateContextAttribsARB", createContextAttribs),
    ownEntry("glXDestroyContext", destroyedContext),
    ownEntry("glXMakeCurrent", makeCurrent),
    ownEntry("glXMakeContextCurrent", makeContextCurrent),
    ownEntry("glXMakeCurrentReadSGI", makeCurrentRead),
    ownEntry("glXSwapBuffers", swapBuffers),
    ownEntry("glXSwapBuffersMscOML", swapBuffersMsc),
    ownEntry("glXCopySubBufferMESA", copySubBuffer),
    ownEntry("glXWaitGL", waitGl),
    ownEntry("glXUseXFont", useXFont),
    ownEntry("glXCreateWindow", createWindow),
    ownEntry("glXDestroyWindow", destroyGlxWindow),
    ownEntry("glXCreatePbuffer", createPbuffer),
    ownEntry("glXDestroyPbuffer", destroyPbuffer),
    ownEntry("glXCreateGLXPbufferSGIX", createSgixPbuffer),
    ownEntry("glXDestroyGLXPbufferSGIX", destroySgixPbuffer),
    ownEntry("glXCreatePixmap", createPixmap),
    ownEntry("glXDestroyPixmap", destroyPixmap),
    ownEntry("glXCreateGLXPixmap", createGlxPixmap),
    ownEntry("glXDestroyGLXPixmap", destroyGlxPixmap),
    ownEntry("glXCreateGLXPixmapWithConfigSGIX", createGlxPixmapWithConfig),
    ownEntry("glXDestroyGLXPixmap", destroyGlxPixmap),
    ownEntry("glXBindTexImageEXT", bindTexImage),
    ownEntry("glXQueryExtensionsString", queryExtensionsString),
    ownEntry("glXGetClientString", getClientString),
    ownEntry("glXQueryServerString", queryServerString),
    ownEntry("glXGetProcAddress", getProcAddress),
    ownEntry("glXGetProcAddressARB", getProcAddress),
};
constinit WrappedLibrary library("glX", kOwn);

// Opens the library of the vendor that draws: the user's setting, otherwise Mesa's, otherwise NVIDIA's.
void* openVendor() {
    const char* requested = wantedGlxVendor();
    const char* const candidates[] = {requested && *requested ? requested : "mesa", "mesa", "nvidia"};
    for (const char* vendor : candidates) {
        char name[128];
        snprintf(name, sizeof name, "libGLX_%s.so.0", vendor);
        if (void* handle = loader::openLibrary(name, RTLD_LAZY)) return handle;
    }
    say("no GLX driver found (libGLX_mesa.so.0): install libglx-mesa0");
    return nullptr;
}

} // namespace

WrappedLibrary& glxLibrary() { return library; }

bool makeGlxCurrent(const Window& draw, const Window& read, const Context& context) {
    static auto* call = real<Bool(Display*, XID, XID, GLXContext)>("glXMakeContextCurrent");
    return call && call(static_cast<Display*>(draw.display), draw.drawable, read.drawable,
                        static_cast<GLXContext>(context.native));
}

bool queryGlxSize(const Window& w, uint32_t& width, uint32_t& height) {
    auto* dpy = static_cast<Display*>(w.display);
    unsigned int a = 0, b = 0;
    if (w.nativeGone) return false; // an X error would end the program
    if (w.native && !w.config.isPbuffer) {
        static auto* geometry =
            xlib<Status(Display*, Drawable, ::Window*, int*, int*, unsigned*, unsigned*, unsigned*, unsigned*)>(
                "XGetGeometry");
        ::Window root = 0;
        int x = 0, y = 0;
        unsigned border = 0, depth = 0;
        if (!geometry || !geometry(dpy, w.native, &root, &x, &y, &a, &b, &border, &depth)) return false;
    } else {
        static auto* query = real<void(Display*, XID, int, unsigned*)>("glXQueryDrawable");
        if (!query) return false;
        query(dpy, w.drawable, glx::kWidth, &a);
        query(dpy, w.drawable, glx::kHeight, &b);
    }
    width = a;
    height = b;
    return a > 0 && b > 0;
}

} // namespace mural

extern "C" __attribute__((visibility("default"))) Bool __glx_Main(uint32_t version, const __GLXapiExports* exports,
                                                                  __GLXvendorInfo* vendor, __GLXapiImports* imports) {
    using Main = Bool(uint32_t, const __GLXapiExports*, __GLXvendorInfo*, __GLXapiImports*);
    void* handle = mural::openVendor();
    auto* main = handle ? reinterpret_cast<Main*>(mural::loader::symbolIn(handle, "__glx_Main")) : nullptr;
    if (!main || !main(version, exports, vendor, imports)) return False;
    mural::loader::keepLoaded(exports); // a program that restarts GLX finds it and the vendor unchanged
    if (!mural::claimProgram(mural::EntryKind::Vendor)) return True;
    mural::vendorGetProcAddress = imports->getProcAddress;
    imports->getProcAddress = mural::getProcAddress;
    mural::forbidPatching(*imports);
    mural::library.attach(mural::vendorEntry);
    return True;
}
