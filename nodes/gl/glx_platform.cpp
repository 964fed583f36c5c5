// Contexts over GLX on an X display. Surfaces are double-buffered pbuffers of the whole picture's size.
//
// Measured with Mesa 22.3.6 (llvmpipe, Xvfb) and checked by tests/gl/. Accumulation buffers of 16 bits and 4 samples
// exist, but not together. GL_BACK and GL_FRONT are two buffers. A request that the driver can't meet causes an X
// error, which XErrorTrap catches.
#include <algorithm>
#include <utility>

#include "nodes/gl/backends.hpp"
#include "nodes/gl/epoxy_functions.hpp"
#include "nodes/gl/gl_info.hpp"
#include "nodes/gl/glx_display.hpp"
#include "nodes/gl/surface_clear.hpp"

namespace mural::gl {
namespace {

using SharedDisplay = std::shared_ptr<GlxDisplayState>;

// Destroyed objects must not stay current, because clear() restores the context and surfaces that were current before
// it.
void release(const GlxDisplayState& display) {
    XErrorTrap trap(display);
    display.glx.makeContextCurrent(display.display, 0, 0, nullptr);
    (void)trap.take();
}

class GlxSurface final : public Surface {
public:
    GlxSurface(SharedDisplay display, GLXPbuffer handle, const SurfaceConfig& config)
        : display_(std::move(display)), handle_(handle), config_(config) {}
    GlxSurface(const GlxSurface&) = delete;
    GlxSurface& operator=(const GlxSurface&) = delete;
    ~GlxSurface() override {
        const GlxFunctions& glx = display_->glx;
        if (glx.getCurrentDrawable() == handle_ || glx.getCurrentReadDrawable() == handle_) release(*display_);
        glx.destroyPbuffer(display_->display, handle_);
    }

    [[nodiscard]] const SurfaceConfig& config() const override { return config_; }
    [[nodiscard]] ColorBuffers colorBuffers() const override { return ColorBuffers::FrontAndBack; }
    [[nodiscard]] GLXPbuffer handle() const { return handle_; }

private:
    SharedDisplay display_;
    GLXPbuffer handle_;
    SurfaceConfig config_;
};

class GlxContext final : public Context {
public:
    GlxContext(SharedDisplay display, GLXContext handle, bool reportsReset, std::unique_ptr<GlxSurface> dummy)
        : display_(std::move(display)), handle_(handle), reportsReset_(reportsReset), dummy_(std::move(dummy)) {}
    GlxContext(const GlxContext&) = delete;
    GlxContext& operator=(const GlxContext&) = delete;
    ~GlxContext() override {
        if (display_->glx.getCurrentContext() == handle_) release(*display_);
        display_->glx.destroyContext(display_->display, handle_);
    }

    [[nodiscard]] GLXContext handle() const { return handle_; }
    [[nodiscard]] bool reportsReset() const override { return reportsReset_; }
    // Surface that is bound when the caller names none. GLX allows none only for some versions.
    [[nodiscard]] GLXPbuffer dummy() const { return dummy_->handle(); }

private:
    SharedDisplay display_;
    GLXContext handle_;
    bool reportsReset_;
    std::unique_ptr<GlxSurface> dummy_;
};

class GlxPlatform final : public Platform {
public:
    explicit GlxPlatform(SharedDisplay display) : display_(std::move(display)) {}

    Result<std::unique_ptr<Surface>> createSurface(const SurfaceConfig& requested) override;
    Result<std::unique_ptr<Context>> createContext(const ContextConfig& requested, Context* shareWith) override;
    Result<void> makeCurrent(Context* context, Surface* draw, Surface* read, PendingCommands pendingCommands) override;
    Proc getProcAddress(const char* name) override {
        return throughEpoxy(name, display_->glx.getProcAddress(reinterpret_cast<const GLubyte*>(name)));
    }
    [[nodiscard]] bool accumulates() const override { return true; }
    [[nodiscard]] std::string describe() const override {
        return "GLX on " + display_->name + ", " + renderer_ + ", " + version_;
    }

    Result<void> measure();

private:
    struct Chosen {
        GLXFBConfig handle;
        SurfaceConfig bits;
    };
    Result<Chosen> chooseConfig(const SurfaceConfig& requested) const;
    // Creates a surface with undefined contents.
    Result<std::unique_ptr<GlxSurface>> createPbuffer(const SurfaceConfig& requested);
    // Keeps the current context and surfaces.
    Result<void> clear(const GlxSurface& surface);
    Result<void> checkSupport(const ContextConfig& requested) const;
    std::vector<int> contextAttributes(const ContextConfig& requested) const;

    SharedDisplay display_;
    std::string renderer_, version_;
    ClearingContexts clearing_;
};

Result<GlxPlatform::Chosen> GlxPlatform::chooseConfig(const SurfaceConfig& requested) const {
    auto index = matchConfig("GLX", display_->candidates, requested);
    if (!index) return index.error();
    return Chosen{display_->configs[*index], bitsOf(display_->candidates[*index], requested)};
}

Result<std::unique_ptr<GlxSurface>> GlxPlatform::createPbuffer(const SurfaceConfig& requested) {
    if (auto size = checkSize("GLX", requested, display_->maxSurfaceSize); !size) return size.error();
    auto config = chooseConfig(requested);
    if (!config) return config.error();
    const int list[] = {GLX_PBUFFER_WIDTH,
                        requested.width,
                        GLX_PBUFFER_HEIGHT,
                        requested.height,
                        GLX_PRESERVED_CONTENTS,
                        1,
                        GLX_LARGEST_PBUFFER,
                        0,
                        0};
    const GlxFunctions& glx = display_->glx;
    const std::string what = std::to_string(requested.width) + "x" + std::to_string(requested.height) + " pixels";
    XErrorTrap trap(*display_);
    GLXPbuffer handle = glx.createPbuffer(display_->display, config->handle, list);
    if (const std::string why = trap.take(); !why.empty() || !handle)
        return Error{"GLX cannot make a pbuffer of " + what + ": " + (why.empty() ? "no reason given" : why) +
                     "; try a smaller picture or --gl egl"};
    auto surface = std::make_unique<GlxSurface>(display_, handle, config->bits);
    unsigned width = 0, height = 0;
    glx.queryDrawable(display_->display, handle, GLX_WIDTH, &width);
    glx.queryDrawable(display_->display, handle, GLX_HEIGHT, &height);
    if (static_cast<int>(width) != requested.width || static_cast<int>(height) != requested.height)
        return Error{"GLX made a pbuffer of " + std::to_string(width) + "x" + std::to_string(height) + " instead of " +
                     what + ": draw a smaller picture"};
    return surface;
}

Result<std::unique_ptr<Surface>> GlxPlatform::createSurface(const SurfaceConfig& requested) {
    auto surface = createPbuffer(requested);
    if (!surface) return surface.error();
    if (auto cleared = clear(**surface); !cleared) return cleared.error();
    return std::unique_ptr<Surface>(std::move(surface.value()));
}

Result<void> GlxPlatform::clear(const GlxSurface& surface) {
    auto context = clearing_.find(surface.config(), display_->noConfigContext,
                                  [this](const ContextConfig& c) { return createContext(c, nullptr); });
    if (!context) return context.error();
    const GlxFunctions& glx = display_->glx;
    const GLXContext before = glx.getCurrentContext();
    const GLXDrawable draw = glx.getCurrentDrawable(), read = glx.getCurrentReadDrawable();
    const auto failed = [](const std::string& why) {
        return Error{"GLX cannot clear a new pbuffer: " + (why.empty() ? "no reason given" : why) + "; use --gl egl"};
    };
    XErrorTrap trap(*display_);
    if (!glx.makeContextCurrent(display_->display, surface.handle(), surface.handle(),
                                static_cast<GlxContext*>(*context)->handle()))
        return failed(trap.take());
    clearCurrentSurface(*this, surface.config(), surface.colorBuffers());
    if (!glx.makeContextCurrent(display_->display, draw, read, before)) return failed(trap.take());
    // Ignores the X error of a flush of the front into a pixmap of another depth: the front is cleared nevertheless. It
    // occurs with Mesa's software driver and alpha on a screen of depth 24.
    (void)trap.take();
    return {};
}

Result<void> GlxPlatform::checkSupport(const ContextConfig& requested) const {
    const char* missing = nullptr;
    if (requested.api != Api::Desktop && !display_->esProfile)
        missing = "GLX_EXT_create_context_es_profile";
    else if (requested.robust && !display_->robust)
        missing = "GLX_ARB_create_context_robustness";
    if (!missing) return {};
    return Error{"GLX on '" + display_->name + "' has no " + describeContext(requested) + " contexts (" + missing +
                 " is missing): use --gl egl"};
}

std::vector<int> GlxPlatform::contextAttributes(const ContextConfig& requested) const {
    const VersionRequest request = versionRequest(requested);
    std::vector<int> list{GLX_CONTEXT_MAJOR_VERSION_ARB, request.major, GLX_CONTEXT_MINOR_VERSION_ARB, request.minor};
    if (requested.api != Api::Desktop)
        list.insert(list.end(), {GLX_CONTEXT_PROFILE_MASK_ARB, GLX_CONTEXT_ES_PROFILE_BIT_EXT});
    else if (request.profile)
        list.insert(list.end(),
                    {GLX_CONTEXT_PROFILE_MASK_ARB,
                     requested.core ? GLX_CONTEXT_CORE_PROFILE_BIT_ARB : GLX_CONTEXT_COMPATIBILITY_PROFILE_BIT_ARB});
    int flags = 0;
    if (requested.forwardCompatible) flags |= GLX_CONTEXT_FORWARD_COMPATIBLE_BIT_ARB;
    if (requested.debug) flags |= GLX_CONTEXT_DEBUG_BIT_ARB;
    if (requested.robust) flags |= GLX_CONTEXT_ROBUST_ACCESS_BIT_ARB;
    if (flags) list.insert(list.end(), {GLX_CONTEXT_FLAGS_ARB, flags});
    if (requested.reportsReset)
        list.insert(list.end(), {GLX_CONTEXT_RESET_NOTIFICATION_STRATEGY_ARB, GLX_LOSE_CONTEXT_ON_RESET_ARB});
    if (display_->flushControl)
        list.insert(list.end(), {GLX_CONTEXT_RELEASE_BEHAVIOR_ARB, GLX_CONTEXT_RELEASE_BEHAVIOR_NONE_ARB});
    if (display_->noConfigContext) list.insert(list.end(), {GLX_SCREEN, display_->screen});
    list.push_back(0);
    return list;
}

Result<std::unique_ptr<Context>> GlxPlatform::createContext(const ContextConfig& requested, Context* shareWith) {
    if (auto supported = checkSupport(requested); !supported) return supported.error();
    auto config = chooseConfig(requested.surface);
    if (!config) return config.error();
    SurfaceConfig small = requested.surface;
    small.width = small.height = 1;
    auto dummy = createPbuffer(small);
    if (!dummy) return dummy.error();
    GLXContext share = shareWith ? static_cast<GlxContext*>(shareWith)->handle() : nullptr;
    std::string why;
    const auto create = [&](bool reportsReset) {
        ContextConfig with = requested;
        with.reportsReset = reportsReset;
        XErrorTrap trap(*display_);
        GLXContext made =
            display_->glx.createContextAttribs(display_->display, display_->noConfigContext ? nullptr : config->handle,
                                               share, 1, contextAttributes(with).data());
        why = trap.take();
        if (!made || why.empty()) return made;
        display_->glx.destroyContext(display_->display, made);
        return GLXContext{};
    };
    bool reportsReset = requested.reportsReset && display_->robust && display_->reportsResets;
    GLXContext handle = create(reportsReset);
    if (!handle && reportsReset) { // contexts of a share group must all have this attribute, or none
        reportsReset = false;
        handle = create(reportsReset);
        if (handle) display_->reportsResets = false;
    }
    if (!handle || !why.empty())
        return Error{"GLX cannot make an " + describeContext(requested) + " context" +
                     (shareWith ? " that shares objects" : "") + ": " +
                     (why.empty() ? "the driver does not have it" : why) + "; see mural doctor"};
    return std::unique_ptr<Context>(
        std::make_unique<GlxContext>(display_, handle, reportsReset, std::move(dummy.value())));
}

Result<void> GlxPlatform::makeCurrent(Context* context, Surface* draw, Surface* read, PendingCommands pendingCommands) {
    auto* wanted = static_cast<GlxContext*>(context);
    GLXDrawable none = wanted ? wanted->dummy() : 0;
    GLXDrawable drawHandle = draw && wanted ? static_cast<GlxSurface*>(draw)->handle() : none;
    GLXDrawable readHandle = read && wanted ? static_cast<GlxSurface*>(read)->handle() : drawHandle;
    if (display_->glx.getCurrentContext()) {
        if (wanted && draw && read && draw != read)
            finishDrawing(*this);
        else if (display_->flushControl && pendingCommands == PendingCommands::Flushed)
            flushDrawing(*this);
    }
    XErrorTrap trap(*display_);
    const Bool made = display_->glx.makeContextCurrent(display_->display, drawHandle, readHandle,
                                                       wanted ? wanted->handle() : nullptr);
    const std::string why = trap.take();
    if (made && why.empty()) return {};
    return Error{"GLX cannot make the context current: " + (why.empty() ? "no reason given" : why) +
                 "; check that context and surfaces were made for the same kind of surface"};
}

Result<void> GlxPlatform::measure() {
    auto info = measureGl(*this, false);
    if (!info) return info.error();
    display_->maxSurfaceSize = std::min(kMaxSurfaceSize, info->maxSurfaceSize);
    renderer_ = info->renderer;
    version_ = info->version;
    return {};
}

} // namespace

Result<std::unique_ptr<Platform>> openGlx() {
    auto display = std::make_shared<GlxDisplayState>();
    if (auto opened = openGlxDisplay(*display); !opened) return opened.error();
    auto platform = std::make_unique<GlxPlatform>(std::move(display));
    if (auto measured = platform->measure(); !measured) return measured.error();
    return std::unique_ptr<Platform>(std::move(platform));
}

} // namespace mural::gl
