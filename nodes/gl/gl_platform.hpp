// Contexts and window-like surfaces of a render node, over EGL (surfaceless), OSMesa or GLX. Thread safety: only the
// replay thread calls (one per pipe). A SharedReader is the exception.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/gl/gpu_choice.hpp"

namespace mural::gl {

using Proc = void (*)();

// Size and buffers of a default framebuffer; bits per channel.
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
    int major = 1; // version of the program's own context; the created one may be later, never earlier
    int minor = 0;
    bool core = false;
    bool forwardCompatible = false;
    bool debug = false;
    bool robust = false;
    bool reportsReset = false; // glGetGraphicsResetStatus reports a lost context, if the driver can
    SurfaceConfig surface;     // kind of surface that the context draws to
};

// Colour buffers of a default framebuffer, and the GL name of a single one. EGL pbuffers have one buffer. Mesa names it
// front and NVIDIA back, and each refuses or ignores the other name (README.md).
enum class ColorBuffers { FrontAndBack, OneNamedFront, OneNamedBack };

// Off-screen memory with the colour, depth and stencil buffers of a window.
class Surface {
public:
    virtual ~Surface() = default;
    // Returns the size and the real bits. A value that the driver lacks is replaced by the nearest.
    [[nodiscard]] virtual const SurfaceConfig& config() const = 0;
    [[nodiscard]] int width() const { return config().width; }
    [[nodiscard]] int height() const { return config().height; }
    [[nodiscard]] virtual ColorBuffers colorBuffers() const = 0;
    // True: the replay maps GL_BACK* and GL_FRONT* to the only buffer, and creates a second surface if the program uses
    // the front.
    [[nodiscard]] bool singleBuffered() const { return colorBuffers() != ColorBuffers::FrontAndBack; }
    // True: the buffer has an alpha channel that was not requested, because OSMesa has no other 8-bit format. A new
    // surface has alpha 1 everywhere. The picture is exact while that holds, so the replay removes alpha from
    // glColorMask while this framebuffer is drawn to.
    [[nodiscard]] virtual bool hiddenAlpha() const { return false; }
};

class Context {
public:
    virtual ~Context() = default;
    // Returns whether glGetGraphicsResetStatus reports a lost context.
    [[nodiscard]] virtual bool reportsReset() const { return false; }
};

// A picture that several share groups can use: an EGLImage.
class Image {
public:
    virtual ~Image() = default;
    [[nodiscard]] virtual void* handle() const = 0; // argument of glEGLImageTarget*
};

// The texture level or renderbuffer that an image is created from.
struct ImageSource {
    Context* context = nullptr; // a context of the object's share group
    unsigned target = 0;        // EGL_GL_TEXTURE_2D …
    unsigned name = 0;
    int level = 0;
    int layer = 0; // layer of a 3D texture
};

// Treatment of commands that the previously current context still holds back.
enum class PendingCommands { Flushed, Pending };

// Lets one thread besides the replay use the objects of a share group. It waits for fences and reads buffers.
class SharedReader {
public:
    virtual ~SharedReader() = default; // any thread, while no thread is between enter() and leave()
    // Makes a context of the share group current in the calling thread until leave().
    virtual Result<void> enter() = 0;
    virtual void leave() = 0;
};

class Platform {
public:
    virtual ~Platform() = default;
    // Creates a surface with 0 in all buffers, as new windows have with Mesa: colours, alpha, depth and stencil. A
    // hidden alpha is 1. No other memory becomes visible there (docs/architecture/security.md). The current context
    // stays current.
    virtual Result<std::unique_ptr<Surface>> createSurface(const SurfaceConfig& config) = 0;
    virtual Result<std::unique_ptr<Context>> createContext(const ContextConfig& config, Context* shareWith) = 0;
    // Null context: release. Null surfaces: none, or a dummy of 1×1 if the driver requires one. A surface that is bound
    // for reading only contains everything that contexts of this thread have drawn there. PendingCommands::Kept has no
    // effect with drivers that flush at each change: OSMesa, and those without KHR_context_flush_control.
    virtual Result<void> makeCurrent(Context* context, Surface* draw, Surface* read,
                                     PendingCommands pendingCommands = PendingCommands::Flushed) = 0;
    // Returns whether a context can draw to one surface and read from another.
    [[nodiscard]] virtual bool readsOtherSurfaces() const { return true; }
    // Returns whether surfaces can have an accumulation buffer.
    [[nodiscard]] virtual bool accumulates() const { return false; }
    // Returns the EGL image extensions that this platform implements. Empty: no images.
    [[nodiscard]] virtual std::vector<std::string> imageExtensions() const { return {}; }
    virtual Result<std::unique_ptr<Image>> createImage(const ImageSource& source);
    // requested: the configuration that `shareWith` was created with. Errors: this platform supports contexts in one
    // thread only.
    virtual Result<std::unique_ptr<SharedReader>> createReader(const ContextConfig& requested, Context& shareWith);
    // Returns an entry point for all contexts, or null for an unknown name. Requires a current context.
    virtual Proc getProcAddress(const char* name) = 0;
    [[nodiscard]] virtual std::string describe() const = 0; // e.g. "EGL surfaceless, Mesa 22.3.6"
};

// name: "egl", "osmesa", "glx" or "auto" (EGL, then OSMesa). The error text names the missing part and the way to get
// it. Only EGL chooses a GPU: GLX uses the one of its display.
Result<std::unique_ptr<Platform>> openPlatform(const std::string& name, const GpuChoice& choice = {});

} // namespace mural::gl
