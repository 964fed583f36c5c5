#include "nodes/gl/gl_probe.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "nodes/gl/config_match.hpp"
#include "nodes/gl/gl_info.hpp"

namespace mural::gl {
namespace {

using Version = std::pair<int, int>;

// Drivers may return exactly the requested version of a core profile or ES context, so the search starts at the
// highest.
std::vector<Version> versionsToTry(Api api, bool core) {
    if (api == Api::Es1) return {{1, 1}, {1, 0}};
    if (api == Api::Es2) return {{3, 2}, {3, 1}, {3, 0}, {2, 0}};
    if (core) return {{4, 6}, {4, 5}, {4, 4}, {4, 3}, {4, 2}, {4, 1}, {4, 0}, {3, 3}, {3, 2}};
    return {{1, 0}}; // the version of glXCreateContext
}

Result<std::unique_ptr<Context>> createHighest(Platform& platform, Api api, bool core) {
    ContextConfig config;
    config.api = api;
    config.core = core;
    Error last;
    for (auto [major, minor] : versionsToTry(api, core)) {
        config.major = major;
        config.minor = minor;
        auto context = platform.createContext(config, nullptr);
        if (context) return context;
        last = context.error();
    }
    return last;
}

} // namespace

bool GlProbe::has(const std::string& extension) const {
    return std::binary_search(extensions.begin(), extensions.end(), extension);
}

Result<GlProbe> probe(Platform& platform, Api api, bool core) {
    auto surface = platform.createSurface(ContextConfig().surface);
    if (!surface) return surface.error();
    auto context = createHighest(platform, api, core && api == Api::Desktop);
    if (!context) return context.error();
    if (auto current = platform.makeCurrent(context->get(), surface->get(), surface->get()); !current)
        return current.error();
    auto info = readGlInfo(platform);
    auto released = platform.makeCurrent(nullptr, nullptr, nullptr);
    if (!info) return info.error();
    if (!released) return released.error();
    GlProbe result;
    result.backend = platform.describe();
    result.vendor = info->vendor;
    result.renderer = info->renderer;
    result.version = info->version;
    result.glVersion = info->glVersion;
    result.es = info->es;
    result.extensions = std::move(info->extensions);
    result.maxSurfaceSize = std::min(info->maxSurfaceSize, kMaxSurfaceSize);
    return result;
}

} // namespace mural::gl
