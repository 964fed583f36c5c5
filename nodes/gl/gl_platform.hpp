// Contexts and window-like surfaces of a render node, over EGL (surfaceless), OSMesa or GLX.
// All calls come from the one thread that replays (one per pipe), but for those of a SharedReader.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/result.hpp"

namespace mural::gl {

using Proc = void (*)();

// What a default framebuffer is made of; bits per channel.
struct SurfaceConfig {
    int width = 1;
    int height = 1;
    int red = 8, green = 8, blue = 8, alpha = 0;
    int depth = 24, stencil = 8;
    int samples = 0;
    int accum = 0;
    bool srgb = false;
    bool stereo = false;
};

enum class Api { Desktop, Es1, Es2 };

struct ContextConfig {
    Api api = Api::Desktop;
    int major = 1; // the version that the app's own context has; what comes out may be later, never earlier
    int minor = 0;
    bool core = false;
    bool forwardCompatible = false;
    bool debug = false;
    bool robust = false;
    bool tellsReset = false; // when the driver can: glGetGraphicsResetStatus tells that the context is lost
    SurfaceConfig surface; // contexts are made for a kind of surface
};

// Those of a framebuffer, and by which name GL knows it where it is one: pbuffers of EGL have one, which Mesa calls front and NVIDIA
// back, each refusing or ignoring the other's (README.md).
enum class ColorBuffers { FrontAndBack, OneNamedFront, OneNamedBack };

// Off-screen memory with the colour, depth and stencil buffers of a window.
class Surface {
public:
    virtual ~Surface() = default;
    // Its size and its bits, which are those asked for or, where the driver has none such, the nearest.
    [[nodiscard]] virtual const SurfaceConfig& config() const = 0;
    [[nodiscard]] int width() const { return config().width; }
    [[nodiscard]] int height() const { return config().height; }
    [[nodiscard]] virtual ColorBuffers colorBuffers() const = 0;
    // True: the replay maps GL_BACK* and GL_FRONT* to the one there is, and takes a second surface for the front where it is used.
    [[nodiscard]] bool singleBuffered() const { return colorBuffers() != ColorBuffers::FrontAndBack; }
    // True: the buffer has an alpha channel that was not asked for (OSMesa has no other 8-bit format). It
    // is 1 everywhere when the surface is made; the picture is exact as long as it stays so: the replay
    // takes alpha out of glColorMask while this framebuffer is drawn to.
    [[nodiscard]] virtual bool hiddenAlpha() const { return false; }
};

class Context {
public:
    virtual ~Context() = default;
    // glGetGraphicsResetStatus tells when it is lost.
    [[nodiscard]] virtual bool tellsReset() const { return false; }
};

// A picture that contexts of several share groups may use: an EGLImage.
class Image {
public:
    virtual ~Image() = default;
    [[nodiscard]] virtual void* handle() const = 0; // as glEGLImageTarget* takes it
};

// The level of a texture, or the renderbuffer, that an image is made of.
struct ImageSource {
    Context* context = nullptr; // of the share group whose object it is
    unsigned target = 0;        // EGL_GL_TEXTURE_2D …
    unsigned name = 0;
    int level = 0;
    int layer = 0;              // of a 3D texture
};

// What becomes of commands that the context which was current holds back.
enum class HeldBack { Flushed, Kept };

// Lets one other thread than the replay's use the objects of a share group: it waits for fences and reads buffers.
class SharedReader {
public:
    virtual ~SharedReader() = default; // by any thread, while it is nowhere entered
    // From here to leave() the calling thread has a context of that group.
    virtual Result<void> enter() = 0;
    virtual void leave() = 0;
};

class Platform {
public:
    virtual ~Platform() = default;
    // Creates a surface with 0 in all buffers, as new windows have with Mesa: colours, alpha (a hidden one: 1), depth and
    // stencil. No other memory shows there (docs/architecture/security.md). The current context stays current.
    virtual Result<std::unique_ptr<Surface>> createSurface(const SurfaceConfig& config) = 0;
    virtual Result<std::unique_ptr<Context>> createContext(const ContextConfig& config, Context* shareWith) = 0;
    // Null context: release. Null surfaces: surfaceless (or a 1×1 dummy where that is unknown).
    // A surface that is only read from holds all that the contexts of this thread have drawn there.
    // Kept: drivers that flush with each change (those without KHR_context_flush_control, OSMesa) do so all the same.
    virtual Result<void> makeCurrent(Context* context, Surface* draw, Surface* read, HeldBack heldBack = HeldBack::Flushed) = 0;
    // True: a context can draw to one surface and read from another.
    [[nodiscard]] virtual bool readsOtherSurfaces() const { return true; }
    // True: surfaces can have an accumulation buffer.
    [[nodiscard]] virtual bool accumulates() const { return false; }
    // Extensions of EGL for images that this platform carries out; empty: there are no images.
    [[nodiscard]] virtual std::vector<std::string> imageExtensions() const { return {}; }
    virtual Result<std::unique_ptr<Image>> createImage(const ImageSource& source);
    // wish: as of `shareWith`. Errors: this platform has all its contexts in one thread.
    virtual Result<std::unique_ptr<SharedReader>> createReader(const ContextConfig& wish, Context& shareWith);
    // Entry point of all contexts, null when unknown. May be called only while a context is current.
    virtual Proc getProcAddress(const char* name) = 0;
    [[nodiscard]] virtual std::string describe() const = 0; // e.g. "EGL surfaceless, Mesa 22.3.6"
};

// name: "egl", "osmesa", "glx" or "auto" (EGL, then OSMesa). Errors say what is missing and how to get it.
Result<std::unique_ptr<Platform>> openPlatform(const std::string& name);

} // namespace mural::gl
