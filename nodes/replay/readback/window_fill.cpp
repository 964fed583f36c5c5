// Writes depth and stencil of other tiles into windows. This needs glDrawPixels, which core and ES contexts lack. In
// the program's own context, it would also depend on bound programs, pipelines and discarding. The node therefore draws
// into the same window with a context of its own. ES 1 contexts need it for colours too, because they lack blits.
#include "common/log/log.hpp"
#include "nodes/replay/engine/replay.hpp"

namespace mural {

// Depth arrives as 32 bits that contain the window's bits, and in any case passes through a float on its way back. The
// nearest float restores all bits (measured with Mesa, all of 2^19 values). Mesa's own conversion from 32 bits
// truncates some.
const GLfloat* Replay::depthAsFloats(const Window& w, const PixelViewport& r, const void* pixels) {
    const int bits = w.config.depth == 0 || w.config.depth > 32 ? 32 : w.config.depth;
    const double largest = static_cast<double>((uint64_t{1} << bits) - 1);
    depths_.resize(static_cast<size_t>(r.area()));
    for (size_t i = 0; i < depths_.size(); ++i) {
        uint32_t value = 0;
        std::memcpy(&value, static_cast<const std::byte*>(pixels) + 4 * i, 4);
        depths_[i] = static_cast<GLfloat>(static_cast<double>(value >> (32 - bits)) / largest);
    }
    return depths_.data();
}

gl::Context* Replay::fillerOf(Window& w) {
    if (w.filler) return w.filler.get();
    gl::ContextConfig contextConfig;
    contextConfig.major = 2;
    contextConfig.minor = 1;
    contextConfig.surface = surfaceConfig(w.config, 1, 1);
    auto made = platform_->createContext(contextConfig, nullptr);
    if (!made) {
        log::warning(log::Topic::Replay,
                     "cannot combine the depth of other tiles; copies of depth across tiles are incomplete: " +
                         made.error().message);
        return nullptr;
    }
    w.filler = std::move(*made);
    return w.filler.get();
}

void Replay::fillByOtherContext(const PixelViewport& r, GLbitfield plane, const void* pixels, GLenum colourType) {
    Window& w = *boundRead_;
    gl::Context* const filler = fillerOf(w);
    gl::Surface* const deep = w.deep ? w.deep : w.surface.get();
    if (!filler || !platform_->makeCurrent(filler, deep, deep)) return;
    const bool depth = plane == GL_DEPTH_BUFFER_BIT, colour = plane == GL_COLOR_BUFFER_BIT;
    if (gl.glDrawPixels && gl.glWindowPos2i) {
        gl.glColorMask(colour, colour, colour, colour);
        depth ? gl.glEnable(GL_DEPTH_TEST) : gl.glDisable(GL_DEPTH_TEST);
        gl.glDepthFunc(GL_ALWAYS);
        gl.glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        gl.glWindowPos2i(r.x, r.y);
        if (depth)
            gl.glDrawPixels(r.w, r.h, GL_DEPTH_COMPONENT, GL_FLOAT, depthAsFloats(w, r, pixels));
        else if (colour)
            gl.glDrawPixels(r.w, r.h, GL_RGBA, colourType, pixels);
        else
            gl.glDrawPixels(r.w, r.h, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, pixels);
        gl.glFlush();
    }
    (void)platform_->makeCurrent(c_->context.get(), drawSurface_, readSurface_);
}

} // namespace mural
