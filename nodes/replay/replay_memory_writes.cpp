// Fragment shaders that write to memory (atomic counters, shader storage, images): what they leave there
// must come from all fragments of the picture, on every node. Which these are, depth and stencil decide, which
// any draw may have written: from the link of such a program on, nothing is cut to the tile. A tile's
// framebuffer (lean) has no place for that: windows get framebuffers of their own size.
#include <algorithm>
#include <utility>

#include "nodes/replay/replay.hpp"

namespace mural {

namespace {

bool isImage(GLint type) { return type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY; }

// True when a resource of that kind that the fragment shader uses passes `wanted` (its GL_TYPE, where it has one).
template <class Wanted> bool fragmentUses(const GlFunctions& gl, GLuint program, GLenum kind, bool hasType, Wanted&& wanted) {
    GLint count = 0;
    gl.glGetProgramInterfaceiv(program, kind, GL_ACTIVE_RESOURCES, &count);
    for (GLint i = 0; i < count; ++i) {
        const GLenum names[2] = {GL_REFERENCED_BY_FRAGMENT_SHADER, GL_TYPE};
        GLint values[2] = {};
        gl.glGetProgramResourceiv(program, kind, static_cast<GLuint>(i), hasType ? 2 : 1, names, 2, nullptr, values);
        if (values[0] && wanted(values[1])) return true;
    }
    return false;
}

} // namespace

bool Replay::writesMemory(GLuint ours) {
    const bool may = c_->api == wire::Api::Desktop ? c_->version >= 42 : c_->version >= 31;
    if (ours == 0 || !may || !c_->shared || !gl.glGetProgramInterfaceiv || !gl.glGetProgramResourceiv) return false;
    const auto known = c_->shared->memoryWriters.find(ours);
    if (known != c_->shared->memoryWriters.end()) return known->second;
    GLint linked = 0;
    gl.glGetProgramiv(ours, GL_LINK_STATUS, &linked);
    const auto any = [](GLint) { return true; };
    const bool writes = linked && (fragmentUses(gl, ours, GL_ATOMIC_COUNTER_BUFFER, false, any) || fragmentUses(gl, ours, GL_SHADER_STORAGE_BLOCK, false, any) ||
                                   fragmentUses(gl, ours, GL_UNIFORM, true, isImage));
    return c_->shared->memoryWriters[ours] = writes;
}

void Replay::programLinked(GLuint ours) {
    if (c_->shared) c_->shared->memoryWriters.erase(ours);
    noteMemoryWriter(ours);
    noteModules(ours);
    programChanged();
}

void Replay::noteMemoryWriter(GLuint ours) {
    if (writesMemory(ours) && !std::exchange(c_->shared->allDrawn, true)) restoreWindowState();
}

// From now on the window is drawn as with tiling exact. What its tile holds stays; raster position and
// polygon stipple, where they were set before, stay the tile's.
void Replay::widenToWindow(Window& w) {
    w.widens = false;
    auto made = platform_->createSurface(surfaceConfig(w.config, std::max(w.whole.w, 1), std::max(w.whole.h, 1)));
    if (!made) {
        out_.log("fragment shaders write to memory, which needs a framebuffer of the whole window (" + std::to_string(w.whole.w) + "x" + std::to_string(w.whole.h) +
                 "), and none can be made: their memory holds this node's part only: " + made.error().message);
        return;
    }
    const std::unique_ptr<gl::Surface> tile = std::exchange(w.surface, std::move(*made));
    w.lean = false;
    dropFront(w);
    if (tile && gl.glBlitFramebuffer) aside([&] { copyTile(w, *tile); });
    (void)bindSurfaces();
}

// Into the window's new framebuffer, whatever the program has set. That one becomes current; buffers are chosen
// again, the scissor by whoever asked for this.
void Replay::copyTile(const Window& w, gl::Surface& from) {
    if (!platform_->makeCurrent(c_->context.get(), w.surface.get(), &from)) return;
    const bool desktop = c_->api == wire::Api::Desktop;
    gl.glBindFramebuffer(GL_FRAMEBUFFER, 0);
    gl.glDisable(GL_SCISSOR_TEST);
    const bool srgb = desktop && gl.glIsEnabled(GL_FRAMEBUFFER_SRGB);
    if (srgb) gl.glDisable(GL_FRAMEBUFFER_SRGB);
    GLboolean deep = GL_TRUE; // what other tiles hold is not known: the program's cleared depth is likely
    gl.glGetBooleanv(GL_DEPTH_WRITEMASK, &deep);
    gl.glDepthMask(GL_TRUE);
    gl.glClear(GL_DEPTH_BUFFER_BIT);
    gl.glDepthMask(deep);
    const PixelViewport& r = w.region;
    const auto blit = [&](GLbitfield planes) { gl.glBlitFramebuffer(0, 0, r.w, r.h, r.x, r.y, r.right(), r.top(), planes, GL_NEAREST); };
    for (const GLenum buffer : {GL_FRONT, GL_BACK}) {
        if (buffer == GL_FRONT ? !desktop : desktop && (from.singleBuffered() || !w.config.doubleBuffer)) continue;
        if (desktop) gl.glReadBuffer(windowBuffer(buffer, &w));
        if (desktop) gl.glDrawBuffer(windowBuffer(buffer, &w));
        blit(GL_COLOR_BUFFER_BIT);
    }
    blit(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    if (desktop) gl.glReadBuffer(windowBuffer(c_->readBuffer0, &w));
    if (desktop) gl.glDrawBuffer(windowBuffer(c_->drawBuffer0, &w));
    if (srgb) gl.glEnable(GL_FRAMEBUFFER_SRGB);
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, name(Kind::Framebuffer, c_->readFramebuffer));
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name(Kind::Framebuffer, c_->drawFramebuffer));
}

// The current program, or the pipeline's fragment stage, is another one.
void Replay::programChanged() {
    GLint fragment = 0;
    if (c_->program) {
        fragment = static_cast<GLint>(name(Kind::Program, c_->program));
    } else if (gl.glGetProgramPipelineiv && bound_ && (c_->api != wire::Api::Desktop ? c_->version >= 31 : c_->version >= 41)) {
        GLint pipeline = 0;
        gl.glGetIntegerv(GL_PROGRAM_PIPELINE_BINDING, &pipeline);
        if (pipeline) gl.glGetProgramPipelineiv(static_cast<GLuint>(pipeline), GL_FRAGMENT_SHADER, &fragment);
    }
    noteMemoryWriter(static_cast<GLuint>(fragment)); // one that was not linked here
}

} // namespace mural
