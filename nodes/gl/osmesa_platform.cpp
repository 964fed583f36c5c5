// Contexts over OSMesa: Mesa's software renderer without a window system.
//
// Measured with Mesa 22.3.6 and checked by tests/gl/:
//
// There is one colour buffer, and no multisampling, stereo, sRGB, ES or forward-compatible context.
//
// The state GL_FRAMEBUFFER_SRGB has no effect. EGL and GLX of the same Mesa honour it on every framebuffer of desktop
// GL. The picture of a program that enables it on its window is therefore not exact.
//
// The buffer has no sRGB view, so glAccum results differ from a window's, where Mesa accumulates decoded sRGB.
// Accumulation buffers are therefore not offered.
//
// Formats belong to the context, which also holds the buffers (osmesa_pixels.hpp). One buffer at a time can be bound,
// for both drawing and reading.
//
// Debug and robust contexts do not exist. The request succeeds, because the picture of a well-defined program does not
// depend on it.
#include <algorithm>
#include <array>
#include <utility>

#include "nodes/gl/backends.hpp"
#include "nodes/gl/config_match.hpp"
#include "nodes/gl/gl_info.hpp"
#include "nodes/gl/osmesa_library.hpp"
#include "nodes/gl/osmesa_pixels.hpp"

namespace mural::gl {
namespace {

// Colour formats with the same llvmpipe results as in windows. OSMESA_RGB gives garbage (measured). A surface without
// alpha therefore has an alpha channel that the replay keeps at 1.
struct ColorFormat {
    int red, green, blue, alpha;
    GLenum format, type;
    int bytesPerPixel;
};
constexpr std::array<ColorFormat, 3> kColorFormats{{
    {8, 8, 8, 8, OSMESA_BGRA, GL_UNSIGNED_BYTE, 4},
    {8, 8, 8, 0, OSMESA_BGRA, GL_UNSIGNED_BYTE, 4},
    {5, 6, 5, 0, OSMESA_RGB_565, GL_UNSIGNED_SHORT_5_6_5, 2},
}};

// Formats without depth are missing: llvmpipe then clips differently from windows, which its "linear" rasterizer draws.
// Stippled lines also have another phase (measured).
struct DepthStencil {
    int depth, stencil;
};
constexpr std::array<DepthStencil, 3> kDepthStencils{{{16, 0}, {24, 0}, {24, 8}}};

struct Candidates {
    std::vector<ConfigCandidate> list;
    std::vector<ColorFormat> formats; // same order
};

Candidates listCandidates() {
    Candidates all;
    for (const ColorFormat& format : kColorFormats)
        for (const DepthStencil& ds : kDepthStencils) {
            ConfigCandidate candidate;
            candidate.bits = {1,          1, format.red, format.green, format.blue, format.alpha, ds.depth,
                              ds.stencil, 0, 0,          false,        false};
            all.list.push_back(candidate);
            all.formats.push_back(format);
        }
    return all;
}

struct Chosen {
    ColorFormat format;
    SurfaceConfig bits;
};

Result<Chosen> chooseFormat(const SurfaceConfig& requested) {
    const Candidates all = listCandidates();
    auto index = matchConfig("OSMesa", all.list, requested);
    if (!index) return index.error();
    return Chosen{all.formats[*index], bitsOf(all.list[*index], requested)};
}

class OsmesaContext;

struct OsmesaState {
    explicit OsmesaState(const OsmesaFunctions& functions) : osmesa(functions), pixels(functions.getProcAddress) {}

    OsmesaFunctions osmesa;
    OsmesaPixels pixels;
    int maxSurfaceSize = kMaxSurfaceSize;
    OsmesaContext* current = nullptr;
};
using SharedState = std::shared_ptr<OsmesaState>;

class OsmesaSurface final : public Surface {
public:
    OsmesaSurface(const SurfaceConfig& config, const ColorFormat& format) : config_(config) {
        const size_t sizeBytes = static_cast<size_t>(config.width) * static_cast<size_t>(config.height) *
                                 static_cast<size_t>(format.bytesPerPixel);
        // The memory stays uninitialised. OSMesa only writes it, and only when GL is flushed, so a large surface costs
        // nothing before that. Draws and reads use the context's own buffers, which bind() clears.
        memory_ = std::shared_ptr<std::byte[]>(new std::byte[sizeBytes]);
    }
    OsmesaSurface(const OsmesaSurface&) = delete;
    OsmesaSurface& operator=(const OsmesaSurface&) = delete;
    ~OsmesaSurface() override;

    [[nodiscard]] ColorBuffers colorBuffers() const override { return ColorBuffers::OneNamedFront; }
    [[nodiscard]] bool hiddenAlpha() const override { return config_.red == 8 && config_.alpha == 0; }
    [[nodiscard]] const SurfaceConfig& config() const override { return config_; }

    std::shared_ptr<std::byte[]> memory_;
    OsmesaContext* home_ = nullptr; // context that holds the contents; null: saved_ holds them
    SavedPixels saved_;

private:
    SurfaceConfig config_;
};

class OsmesaContext final : public Context {
public:
    OsmesaContext(SharedState state, OSMesaContext handle, const ContextConfig& config, const ColorFormat& format)
        : state_(std::move(state)), handle_(handle), config_(config), format_(format) {}
    OsmesaContext(const OsmesaContext&) = delete;
    OsmesaContext& operator=(const OsmesaContext&) = delete;
    ~OsmesaContext() override;

    [[nodiscard]] OSMesaContext handle() const { return handle_; }
    // Makes the context current with the surface and moves the surface's contents here. Null: with a dummy.
    Result<void> bind(OsmesaSurface* surface);
    // Saves the contents of the resident surface in the surface. Leaves this context current.
    void evict();
    void forget(OsmesaSurface* surface) {
        if (resident_ == surface) resident_ = nullptr;
    }

private:
    [[nodiscard]] bool compatibility() const { return !(config_.core && versionRequest(config_).profile); }
    bool bindMemory(std::shared_ptr<std::byte[]> memory, int width, int height);

    SharedState state_;
    OSMesaContext handle_;
    ContextConfig config_;
    ColorFormat format_;
    OsmesaSurface* resident_ = nullptr;  // surface that this context's buffers hold
    std::shared_ptr<std::byte[]> bound_; // memory that OSMesa writes to, even after its surface is destroyed
    std::shared_ptr<std::byte[]> dummy_{new std::byte[16]};
};

OsmesaSurface::~OsmesaSurface() {
    if (home_) home_->forget(this);
}

OsmesaContext::~OsmesaContext() {
    OsmesaContext* previous = state_->current;
    evict();
    state_->osmesa.destroyContext(handle_);
    state_->osmesa.makeCurrent(nullptr, nullptr, 0, 0, 0);
    state_->current = nullptr;
    if (previous && previous != this) {
        OsmesaSurface* surface = previous->resident_;
        (void)previous->bind(surface); // the same binding succeeded before
    }
}

bool OsmesaContext::bindMemory(std::shared_ptr<std::byte[]> memory, int width, int height) {
    if (!state_->osmesa.makeCurrent(handle_, memory.get(), format_.type, width, height)) return false;
    bound_ = std::move(memory);
    state_->current = this;
    return true;
}

void OsmesaContext::evict() {
    if (resident_) {
        const SurfaceConfig& config = resident_->config();
        if (bindMemory(resident_->memory_, config.width, config.height))
            resident_->saved_ = state_->pixels.save(config, compatibility());
        resident_->home_ = nullptr;
        resident_ = nullptr;
    }
    // The change of size makes OSMesa free the old buffers, so their contents cannot appear in another surface.
    if (bound_) bindMemory(dummy_, 1, 1);
}

Result<void> OsmesaContext::bind(OsmesaSurface* surface) {
    const Error failed{
        "OSMesa cannot make the context current, probably because memory is short; try a smaller picture"};
    if (!surface) {
        evict();
        if (!bindMemory(dummy_, 1, 1)) return failed;
        return {};
    }
    if (!sameBits(surface->config(), config_.surface))
        return Error{"OSMesa cannot draw with one context to surfaces of different depths: use --gl egl"};
    if (surface->home_ != this) {
        evict();
        if (surface->home_) surface->home_->evict();
    }
    if (!bindMemory(surface->memory_, surface->width(), surface->height())) return failed;
    if (surface->home_ == this) return {};
    resident_ = surface;
    surface->home_ = this;
    if (surface->saved_.valid) {
        state_->pixels.restore(surface->config(), compatibility(), surface->saved_);
        surface->saved_ = {};
    } else {
        state_->pixels.clearNew(surface->config(), compatibility(), surface->hiddenAlpha() ? 1.0F : 0.0F);
    }
    return {};
}

class OsmesaPlatform final : public Platform {
public:
    explicit OsmesaPlatform(SharedState state) : state_(std::move(state)) {}

    Result<std::unique_ptr<Surface>> createSurface(const SurfaceConfig& requested) override;
    Result<std::unique_ptr<Context>> createContext(const ContextConfig& requested, Context* shareWith) override;
    Result<void> makeCurrent(Context* context, Surface* draw, Surface* read, PendingCommands pendingCommands) override;
    [[nodiscard]] bool readsOtherSurfaces() const override { return false; }
    Proc getProcAddress(const char* name) override {
        return reinterpret_cast<Proc>(state_->osmesa.getProcAddress(name));
    }
    [[nodiscard]] std::string describe() const override { return "OSMesa, " + renderer_ + ", " + version_; }

    Result<void> measure();

private:
    SharedState state_;
    std::string renderer_, version_;
};

Result<std::unique_ptr<Surface>> OsmesaPlatform::createSurface(const SurfaceConfig& requested) {
    if (auto size = checkSize("OSMesa", requested, state_->maxSurfaceSize); !size) return size.error();
    auto chosen = chooseFormat(requested);
    if (!chosen) return chosen.error();
    return std::unique_ptr<Surface>(std::make_unique<OsmesaSurface>(chosen->bits, chosen->format));
}

Result<std::unique_ptr<Context>> OsmesaPlatform::createContext(const ContextConfig& requested, Context* shareWith) {
    if (requested.api != Api::Desktop || requested.forwardCompatible)
        return Error{"OSMesa cannot make an " + describeContext(requested) + " context: use --gl egl"};
    auto chosen = chooseFormat(requested.surface);
    if (!chosen) return chosen.error();
    ContextConfig config = requested;
    config.surface = chosen->bits;
    const VersionRequest request = versionRequest(requested);
    const bool core = request.profile && requested.core;
    const int list[] = {OSMESA_FORMAT,
                        static_cast<int>(chosen->format.format),
                        OSMESA_DEPTH_BITS,
                        config.surface.depth,
                        OSMESA_STENCIL_BITS,
                        config.surface.stencil,
                        OSMESA_PROFILE,
                        core ? OSMESA_CORE_PROFILE : OSMESA_COMPAT_PROFILE,
                        OSMESA_CONTEXT_MAJOR_VERSION,
                        request.major,
                        OSMESA_CONTEXT_MINOR_VERSION,
                        request.minor,
                        0,
                        0};
    OSMesaContext share = shareWith ? static_cast<OsmesaContext*>(shareWith)->handle() : nullptr;
    OSMesaContext handle = state_->osmesa.createContextAttribs(list, share);
    if (!handle)
        return Error{"OSMesa cannot make an " + describeContext(requested) + " context" +
                     (shareWith ? " that shares objects" : "") + ": the driver does not have it; see mural doctor"};
    return std::unique_ptr<Context>(std::make_unique<OsmesaContext>(state_, handle, config, chosen->format));
}

Result<void> OsmesaPlatform::makeCurrent(Context* context, Surface* draw, Surface* read, PendingCommands) {
    if (!context) {
        state_->current = nullptr;
        if (state_->osmesa.makeCurrent(nullptr, nullptr, 0, 0, 0)) return {};
        return Error{"OSMesa cannot release the context: install a newer libosmesa6"};
    }
    if (read && read != draw) return Error{"OSMesa cannot draw to one surface and read from another: use --gl egl"};
    return static_cast<OsmesaContext*>(context)->bind(static_cast<OsmesaSurface*>(draw));
}

Result<void> OsmesaPlatform::measure() {
    auto info = measureGl(*this, false);
    if (!info) return info.error();
    state_->maxSurfaceSize = std::min(kMaxSurfaceSize, info->maxSurfaceSize);
    renderer_ = info->renderer;
    version_ = info->version;
    return {};
}

} // namespace

Result<std::unique_ptr<Platform>> openOsmesa() {
    auto library = DynamicLibrary::open({"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}, "libosmesa6");
    if (!library) return library.error();
    OsmesaFunctions osmesa;
    if (!library->load(osmesa.createContextAttribs, "OSMesaCreateContextAttribs") ||
        !library->load(osmesa.destroyContext, "OSMesaDestroyContext") ||
        !library->load(osmesa.getProcAddress, "OSMesaGetProcAddress") ||
        !library->load(osmesa.makeCurrent, "OSMesaMakeCurrent"))
        return Error{library->name() + " is older than OSMesa 11.2: install a newer libosmesa6"};
    auto platform = std::make_unique<OsmesaPlatform>(std::make_shared<OsmesaState>(osmesa));
    if (auto measured = platform->measure(); !measured) return measured.error();
    return std::unique_ptr<Platform>(std::move(platform));
}

} // namespace mural::gl
