#include "nodes/gl/surface_clear.hpp"

#include <utility>

#define GL_GLEXT_PROTOTYPES // for the types only: nothing links to libGL here
#include <GL/gl.h>

#include "nodes/gl/config_match.hpp"
#include "nodes/gl/gl_info.hpp"

namespace mural::gl {
namespace {

template <class Function> void load(Platform& platform, Function& function, const char* name) {
    function = reinterpret_cast<Function>(platform.getProcAddress(name));
}

bool isEmbedded(Platform& platform) {
    const GLubyte* (*getString)(GLenum) = nullptr;
    load(platform, getString, "glGetString");
    const auto* version = getString ? reinterpret_cast<const char*>(getString(GL_VERSION)) : nullptr;
    return version && std::string(version).starts_with("OpenGL ES");
}

} // namespace

Result<Context*> ClearingContexts::find(const SurfaceConfig& bits, bool anyConfig, const Create& create) {
    for (const Entry& entry : entries_)
        if (anyConfig || sameBits(entry.bits, bits)) return entry.context.get();
    ContextConfig config;
    config.surface = bits;
    config.surface.width = config.surface.height = 1;
    auto made = create(config);
    if (!made) { // the driver has OpenGL ES only
        config.api = Api::Es2;
        config.major = 2;
        auto embedded = create(config);
        if (!embedded) return made.error();
        made = std::move(embedded);
    }
    entries_.push_back({bits, std::move(*made)});
    return entries_.back().context.get();
}

void clearCurrentSurface(Platform& platform, const SurfaceConfig& bits, ColorBuffers buffers) {
    void (*clear)(GLbitfield) = nullptr;
    void (*clearDepth)(GLdouble) = nullptr;
    void (*clearDepthf)(GLfloat) = nullptr;
    void (*drawBuffer)(GLenum) = nullptr;
    load(platform, clear, "glClear");
    if (isEmbedded(platform))
        load(platform, clearDepthf, "glClearDepthf");
    else
        load(platform, clearDepth, "glClearDepth");
    if (buffers == ColorBuffers::FrontAndBack) load(platform, drawBuffer, "glDrawBuffer");
    if (!clear) return;
    // The other clear values are initially 0.
    if (clearDepth) clearDepth(0);
    if (clearDepthf) clearDepthf(0);
    if (drawBuffer) drawBuffer(GL_FRONT_AND_BACK);
    clear(GL_COLOR_BUFFER_BIT | (bits.depth > 0 ? GL_DEPTH_BUFFER_BIT : 0U) |
          (bits.stencil > 0 ? GL_STENCIL_BUFFER_BIT : 0U) | (bits.accum > 0 ? GL_ACCUM_BUFFER_BIT : 0U));
    finishDrawing(platform);
}

} // namespace mural::gl
