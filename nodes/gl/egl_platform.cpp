// Contexts over EGL without a window system. Surfaces are pbuffers of the whole picture's size.
//
// Measured with Mesa 22.3.6 (llvmpipe) and checked by tests/gl/:
//
// Pbuffers have one colour buffer. README.md lists its names. There are no accumulation buffers and no stereo. The
// surface has the sRGB property.
//
// The attribute EGL_MAX_PBUFFER_WIDTH is 4096, but 16384 works. 16385 succeeds without an error, although the viewport
// then ends at 16384. Sizes are therefore checked against GL_MAX_VIEWPORT_DIMS.
//
// The function eglGetProcAddress of libglvnd returns a function for every name that begins with "gl".
#include <algorithm>
#include <utility>

#include "nodes/gl/backends.hpp"
#include "nodes/gl/egl_display.hpp"
#include "nodes/gl/epoxy_functions.hpp"
#include "nodes/gl/gl_info.hpp"
#include "nodes/gl/surface_clear.hpp"

namespace mural::gl {
namespace {

using SharedDisplay = std::shared_ptr<EglDisplayState>;

class EglSurface final : public Surface {
public:
    EglSurface(SharedDisplay display, EGLSurface handle, const SurfaceConfig& config)
        : display_(std::move(display)), handle_(handle), config_(config) {}
    EglSurface(const EglSurface&) = delete;
    EglSurface& operator=(const EglSurface&) = delete;
    ~EglSurface() override { display_->deferredObjects.addSurface(handle_); }

    [[nodiscard]] const SurfaceConfig& config() const override { return config_; }
    [[nodiscard]] ColorBuffers colorBuffers() const override { return display_->colorBuffers; }
    [[nodiscard]] EGLSurface handle() const { return handle_; }

private:
    SharedDisplay display_;
    EGLSurface handle_;
    SurfaceConfig config_;
};

class EglContext final : public Context {
public:
    EglContext(SharedDisplay display, EGLContext handle, EGLenum api, bool reportsReset, std::unique_ptr<Surface> dummy)
        : display_(std::move(display)),
          handle_(handle),
          api_(api),
          reportsReset_(reportsReset),
          dummy_(std::move(dummy)) {}
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;
    ~EglContext() override { display_->deferredObjects.addContext(handle_); }

    [[nodiscard]] EGLContext handle() const { return handle_; }
    [[nodiscard]] bool reportsReset() const override { return reportsReset_; }
    [[nodiscard]] EGLenum api() const { return api_; }
    // Surface that is bound when the caller names none.
    [[nodiscard]] EGLSurface dummy() const {
        return dummy_ ? static_cast<EglSurface*>(dummy_.get())->handle() : EGL_NO_SURFACE;
    }

private:
    SharedDisplay display_;
    EGLContext handle_;
    EGLenum api_;
    bool reportsReset_;
    std::unique_ptr<Surface> dummy_;
};

class EglImage final : public Image {
public:
    EglImage(SharedDisplay display, EGLImageKHR handle) : display_(std::move(display)), handle_(handle) {}
    EglImage(const EglImage&) = delete;
    EglImage& operator=(const EglImage&) = delete;
    ~EglImage() override { display_->egl.destroyImage(display_->display, handle_); }

    [[nodiscard]] void* handle() const override { return handle_; }

private:
    SharedDisplay display_;
    EGLImageKHR handle_;
};

// The bound API and the current context are per thread.
class EglReader final : public SharedReader {
public:
    EglReader(SharedDisplay display, std::unique_ptr<Context> context)
        : display_(std::move(display)), context_(std::move(context)) {}

    Result<void> enter() override {
        auto& context = static_cast<EglContext&>(*context_);
        display_->egl.bindApi(context.api());
        if (display_->egl.makeCurrent(display_->display, context.dummy(), context.dummy(), context.handle())) return {};
        return Error{"EGL cannot make the context of a second thread current: " + takeEglError(display_->egl) +
                     "; use --readback direct"};
    }
    void leave() override {
        display_->egl.makeCurrent(display_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }

private:
    SharedDisplay display_;
    std::unique_ptr<Context> context_;
};

std::vector<EGLint> contextAttributes(const ContextConfig& config, const EglDisplayState& display) {
    const VersionRequest request = versionRequest(config);
    std::vector<EGLint> list{EGL_CONTEXT_MAJOR_VERSION, request.major, EGL_CONTEXT_MINOR_VERSION, request.minor};
    const bool desktop = config.api == Api::Desktop;
    if (request.profile)
        list.insert(list.end(),
                    {EGL_CONTEXT_OPENGL_PROFILE_MASK,
                     config.core ? EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT : EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT});
    if (display.version >= 15) {
        if (config.forwardCompatible) list.insert(list.end(), {EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE, EGL_TRUE});
        if (config.debug) list.insert(list.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
        if (config.robust) list.insert(list.end(), {EGL_CONTEXT_OPENGL_ROBUST_ACCESS, EGL_TRUE});
        if (config.reportsReset)
            list.insert(list.end(), {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
    } else {
        EGLint flags = 0;
        if (config.forwardCompatible) flags |= EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE_BIT_KHR;
        if (config.debug) flags |= EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR;
        if (config.robust && desktop) flags |= EGL_CONTEXT_OPENGL_ROBUST_ACCESS_BIT_KHR;
        if (flags) list.insert(list.end(), {EGL_CONTEXT_FLAGS_KHR, flags});
        if (config.robust && !desktop) list.insert(list.end(), {EGL_CONTEXT_OPENGL_ROBUST_ACCESS_EXT, EGL_TRUE});
        if (config.reportsReset)
            list.insert(list.end(), {desktop ? EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_KHR
                                             : EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT,
                                     EGL_LOSE_CONTEXT_ON_RESET_KHR});
    }
    if (display.flushControl)
        list.insert(list.end(), {EGL_CONTEXT_RELEASE_BEHAVIOR_KHR, EGL_CONTEXT_RELEASE_BEHAVIOR_NONE_KHR});
    list.push_back(EGL_NONE);
    return list;
}

class EglPlatform final : public Platform {
public:
    explicit EglPlatform(SharedDisplay display) : display_(std::move(display)) {}
    EglPlatform(const EglPlatform&) = delete;
    EglPlatform& operator=(const EglPlatform&) = delete;
    ~EglPlatform() override {
        if (display_->mesa) return; // already released
        display_->egl.makeCurrent(display_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }

    Result<std::unique_ptr<Surface>> createSurface(const SurfaceConfig& requested) override;
    Result<std::unique_ptr<Context>> createContext(const ContextConfig& requested, Context* shareWith) override;
    Result<std::unique_ptr<SharedReader>> createReader(const ContextConfig& requested, Context& shareWith) override;
    Result<void> makeCurrent(Context* context, Surface* draw, Surface* read, PendingCommands pendingCommands) override;
    [[nodiscard]] std::vector<std::string> imageExtensions() const override;
    Result<std::unique_ptr<Image>> createImage(const ImageSource& source) override;
    Proc getProcAddress(const char* name) override { return throughEpoxy(name, display_->egl.getProcAddress(name)); }
    [[nodiscard]] std::string describe() const override {
        return "EGL " + display_->where + ", " + renderer_ + ", " + version_;
    }

    // Creates a context and reads the properties that no EGL query returns.
    Result<void> measure();
    // Surfaces with samples work with Mesa's software driver 22.3 and fail with 25.0. The test by drawing costs a
    // node's start 0.13 s of CPU time there, because it compiles shaders that no cache keeps.
    [[nodiscard]] bool isKnownToShowSamples() const {
        const int mesa = parseMesaVersion(version_);
        return display_->software && mesa > 0 && mesa <= 22;
    }
    [[nodiscard]] bool drawsAs(const EglPlatform& other) const {
        return renderer_ == other.renderer_ && version_ == other.version_;
    }

private:
    struct Chosen {
        EGLConfig handle;
        SurfaceConfig bits;
    };
    Result<Chosen> chooseConfig(const SurfaceConfig& requested) const;
    // Creates a surface with undefined contents.
    Result<std::unique_ptr<EglSurface>> createPbuffer(const SurfaceConfig& requested) const;
    // Keeps the current context and surfaces.
    Result<void> clear(const EglSurface& surface);

    SharedDisplay display_;
    EGLenum currentApi_ = EGL_OPENGL_API;
    std::string renderer_, version_;
    ClearingContexts clearing_;
};

Result<EglPlatform::Chosen> EglPlatform::chooseConfig(const SurfaceConfig& requested) const {
    const EglConfigs all = listEglConfigs(*display_, requested.srgb);
    auto index = matchConfig("EGL", all.candidates, requested);
    if (!index) return index.error();
    return Chosen{all.handles[*index], bitsOf(all.candidates[*index], requested)};
}

Result<std::unique_ptr<EglSurface>> EglPlatform::createPbuffer(const SurfaceConfig& requested) const {
    if (auto size = checkSize("EGL", requested, display_->maxSurfaceSize); !size) return size.error();
    auto config = chooseConfig(requested);
    if (!config) return config.error();
    std::vector<EGLint> list{EGL_WIDTH, requested.width, EGL_HEIGHT, requested.height};
    if (requested.srgb) list.insert(list.end(), {EGL_GL_COLORSPACE_KHR, EGL_GL_COLORSPACE_SRGB_KHR});
    list.push_back(EGL_NONE);
    const EglFunctions& egl = display_->egl;
    const std::string what = std::to_string(requested.width) + "x" + std::to_string(requested.height) + " pixels" +
                             (requested.srgb ? " in sRGB" : "");
    EGLSurface handle = egl.createPbufferSurface(display_->display, config->handle, list.data());
    if (handle == EGL_NO_SURFACE)
        return Error{"EGL cannot make a pbuffer of " + what + ": " + takeEglError(egl) +
                     "; try a smaller picture or another --gl backend"};
    auto surface = std::make_unique<EglSurface>(display_, handle, config->bits);
    EGLint width = 0, height = 0;
    egl.querySurface(display_->display, handle, EGL_WIDTH, &width);
    egl.querySurface(display_->display, handle, EGL_HEIGHT, &height);
    if (width != requested.width || height != requested.height)
        return Error{"EGL made a pbuffer of " + std::to_string(width) + "x" + std::to_string(height) + " instead of " +
                     what + ": draw a smaller picture"};
    return surface;
}

Result<void> EglPlatform::clear(const EglSurface& surface) {
    auto context = clearing_.find(surface.config(), display_->noConfigContext,
                                  [this](const ContextConfig& c) { return createContext(c, nullptr); });
    if (!context) return context.error();
    const EglFunctions& egl = display_->egl;
    auto* clearing = static_cast<EglContext*>(*context);
    // The code keeps handles, because the objects of the current context and surfaces may be gone (EglDeferredObjects).
    const EGLContext before = egl.getCurrentContext();
    const EGLSurface draw = egl.getCurrentSurface(EGL_DRAW), read = egl.getCurrentSurface(EGL_READ);
    egl.bindApi(clearing->api());
    if (!egl.makeCurrent(display_->display, surface.handle(), surface.handle(), clearing->handle())) {
        const std::string why = takeEglError(egl);
        egl.bindApi(currentApi_);
        return Error{"EGL cannot clear a new pbuffer: " + why + "; see mural doctor"};
    }
    clearCurrentSurface(*this, surface.config(), surface.colorBuffers());
    if (before == EGL_NO_CONTEXT && !display_->mesa) { // stays current until others are (EglDeferredObjects)
        currentApi_ = clearing->api();
        return {};
    }
    // A release acts on the bound API.
    if (before != EGL_NO_CONTEXT) egl.bindApi(currentApi_);
    if (!egl.makeCurrent(display_->display, draw, read, before))
        return Error{"EGL cannot make the context current again after clearing a pbuffer: " + takeEglError(egl) +
                     "; see mural doctor"};
    egl.bindApi(currentApi_);
    return {};
}

Result<std::unique_ptr<Surface>> EglPlatform::createSurface(const SurfaceConfig& requested) {
    auto surface = createPbuffer(requested);
    if (!surface) return surface.error();
    if (auto cleared = clear(**surface); !cleared) return cleared.error();
    return std::unique_ptr<Surface>(std::move(*surface));
}

Result<std::unique_ptr<Context>> EglPlatform::createContext(const ContextConfig& requested, Context* shareWith) {
    const EglFunctions& egl = display_->egl;
    auto config = chooseConfig(requested.surface);
    if (!config) return config.error();
    std::unique_ptr<Surface> dummy;
    if (!display_->surfaceless) {
        SurfaceConfig small = requested.surface;
        small.width = small.height = 1;
        auto made = createPbuffer(small);
        if (!made) return made.error();
        dummy = std::move(made.value());
    }
    const EGLenum api = requested.api == Api::Desktop ? EGL_OPENGL_API : EGL_OPENGL_ES_API;
    if (!egl.bindApi(api))
        return Error{"this EGL driver has no " + describeContext(requested) + ": try another --gl backend"};
    EGLContext share = shareWith ? static_cast<EglContext*>(shareWith)->handle() : EGL_NO_CONTEXT;
    const auto create = [&](bool reportsReset) {
        ContextConfig with = requested;
        with.reportsReset = reportsReset;
        const std::vector<EGLint> attributes = contextAttributes(with, *display_);
        EGLContext made = EGL_NO_CONTEXT;
        if (display_->noConfigContext)
            made = egl.createContext(display_->display, EGL_NO_CONFIG_KHR, share, attributes.data());
        if (made != EGL_NO_CONTEXT || (display_->noConfigContext && display_->mesa)) return made;
        if (display_->noConfigContext) (void)egl.getError(); // NVIDIA requires a configuration for ES 1 contexts
        return egl.createContext(display_->display, config->handle, share, attributes.data());
    };
    bool reportsReset = requested.reportsReset && display_->reportsResets;
    EGLContext handle = create(reportsReset);
    if (handle == EGL_NO_CONTEXT && reportsReset) { // contexts of a share group must all have this attribute, or none
        (void)egl.getError();
        reportsReset = false;
        handle = create(reportsReset);
        if (handle != EGL_NO_CONTEXT) display_->reportsResets = false;
    }
    const std::string why = handle == EGL_NO_CONTEXT ? takeEglError(egl) : "";
    egl.bindApi(currentApi_);
    if (handle == EGL_NO_CONTEXT)
        return Error{"EGL cannot make an " + describeContext(requested) + " context" +
                     (shareWith ? " that shares objects" : "") + ": " + why + "; see mural doctor"};
    return std::unique_ptr<Context>(
        std::make_unique<EglContext>(display_, handle, api, reportsReset, std::move(dummy)));
}

Result<std::unique_ptr<SharedReader>> EglPlatform::createReader(const ContextConfig& requested, Context& shareWith) {
    auto context = createContext(requested, &shareWith);
    if (!context) return context.error();
    return std::unique_ptr<SharedReader>(std::make_unique<EglReader>(display_, std::move(*context)));
}

Result<void> EglPlatform::makeCurrent(Context* context, Surface* draw, Surface* read, PendingCommands pendingCommands) {
    const EglFunctions& egl = display_->egl;
    auto* wanted = static_cast<EglContext*>(context);
    if (egl.getCurrentContext() != EGL_NO_CONTEXT) {
        if (wanted && draw && read && draw != read)
            finishDrawing(*this);
        else if (display_->flushControl && pendingCommands == PendingCommands::Flushed)
            flushDrawing(*this);
    }
    // the context stays current until others are (EglDeferredObjects); no draw of the caller is deferred
    if (!wanted && !display_->mesa) {
        if (egl.getCurrentContext() != EGL_NO_CONTEXT) flushDrawing(*this);
        return {};
    }
    // A release acts on the bound API, which must still match the current context.
    if (wanted) {
        currentApi_ = wanted->api();
        egl.bindApi(currentApi_);
    }
    EGLSurface none = wanted ? wanted->dummy() : EGL_NO_SURFACE;
    EGLSurface drawHandle = draw && wanted ? static_cast<EglSurface*>(draw)->handle() : none;
    EGLSurface readHandle = read && wanted ? static_cast<EglSurface*>(read)->handle() : drawHandle;
    if (egl.makeCurrent(display_->display, drawHandle, readHandle, wanted ? wanted->handle() : EGL_NO_CONTEXT)) {
        if (wanted) display_->deferredObjects.destroy(egl, display_->display);
        return {};
    }
    return Error{"EGL cannot make the context current: " + takeEglError(egl) +
                 "; check that context and surfaces were made for the same kind of surface"};
}

std::vector<std::string> EglPlatform::imageExtensions() const {
    std::vector<std::string> have;
    if (!display_->egl.createImage || !display_->egl.destroyImage) return have;
    for (const char* name : {"EGL_KHR_image_base", "EGL_KHR_gl_texture_2D_image", "EGL_KHR_gl_texture_cubemap_image",
                             "EGL_KHR_gl_texture_3D_image", "EGL_KHR_gl_renderbuffer_image"})
        if (display_->has(name)) have.emplace_back(name);
    return have;
}

Result<std::unique_ptr<Image>> EglPlatform::createImage(const ImageSource& source) {
    const EglFunctions& egl = display_->egl;
    if (!egl.createImage || !egl.destroyImage) return Platform::createImage(source);
    std::vector<EGLint> list{EGL_IMAGE_PRESERVED_KHR, EGL_TRUE};
    if (source.target != EGL_GL_RENDERBUFFER_KHR) list.insert(list.end(), {EGL_GL_TEXTURE_LEVEL_KHR, source.level});
    if (source.target == EGL_GL_TEXTURE_3D_KHR) list.insert(list.end(), {EGL_GL_TEXTURE_ZOFFSET_KHR, source.layer});
    list.push_back(EGL_NONE);
    auto* context = static_cast<EglContext*>(source.context);
    EGLImageKHR handle = egl.createImage(display_->display, context->handle(), source.target,
                                         reinterpret_cast<EGLClientBuffer>(uintptr_t{source.name}), list.data());
    if (handle != EGL_NO_IMAGE_KHR) return std::unique_ptr<Image>(std::make_unique<EglImage>(display_, handle));
    return Error{"EGL cannot make an image of object " + std::to_string(source.name) + ": " + takeEglError(egl) +
                 "; its format may be unknown to this driver"};
}

Result<void> EglPlatform::measure() {
    auto info = measureGl(*this, true);
    if (!info) return info.error();
    display_->maxSurfaceSize = std::min(kMaxSurfaceSize, info->maxSurfaceSize);
    display_->colorBuffers = info->colorBuffers;
    renderer_ = info->renderer;
    version_ = info->version;
    return {};
}

} // namespace

Result<std::unique_ptr<Platform>> openEgl(const GpuChoice& choice) {
    auto display = openEglDisplay(choice);
    if (!display) return display.error();
    auto platform = std::make_unique<EglPlatform>(display.value());
    if (auto measured = platform->measure(); !measured) return measured.error();
    if (platform->isKnownToShowSamples() || showsSamples(*platform))
        return std::unique_ptr<Platform>(std::move(platform));
    // The same driver has them on another EGL platform (Mesa 25.0, software).
    if (auto other = openOtherEglDisplay(**display)) {
        auto device = std::make_unique<EglPlatform>(std::move(other));
        if (device->measure() && device->drawsAs(*platform) && showsSamples(*device)) platform = std::move(device);
    }
    return std::unique_ptr<Platform>(std::move(platform));
}

} // namespace mural::gl
