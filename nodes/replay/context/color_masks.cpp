// Windows without alpha on surfaces with alpha (OSMesa). Alpha stays 1, the value that blending and reads use for a
// missing channel. The colour mask prevents all writes of alpha except blits.
#include "nodes/replay/engine/replay.hpp"

namespace mural {

bool Replay::hidesAlpha() const {
    return alphaHides_ && drawsWindow() && c_->draw && c_->draw->surface && c_->draw->surface->hiddenAlpha();
}

// Called after a change of framebuffer or window, and after the program's masks are popped.
void Replay::applyColorMasks() {
    if (!bound_ || !alphaHides_ || !gl.glColorMask) return;
    const replay::ColorMasks& masks = c_->colorMasks;
    const GLboolean alpha = hidesAlpha() ? GL_FALSE : GL_TRUE;
    const auto& first = masks.buffers[0];
    if (!masks.differ || !gl.glColorMaski) return gl.glColorMask(first[0], first[1], first[2], first[3] && alpha);
    for (GLuint i = 0; i < masks.buffers.size(); ++i) {
        const auto& m = masks.buffers[i];
        gl.glColorMaski(i, m[0], m[1], m[2], m[3] && (alpha || i > 0));
    }
}

void Replay::glColorMask(GLboolean red, GLboolean green, GLboolean blue, GLboolean alpha) {
    c_->colorMasks.buffers.fill({red, green, blue, alpha});
    c_->colorMasks.differ = false;
    gl.glColorMask(red, green, blue, alpha && !hidesAlpha());
}

void Replay::glColorMaski(GLuint index, GLboolean r, GLboolean g, GLboolean b, GLboolean a) {
    if (index >= c_->colorMasks.buffers.size() || !gl.glColorMaski) return;
    c_->colorMasks.buffers[index] = {r, g, b, a};
    c_->colorMasks.differ = true;
    gl.glColorMaski(index, r, g, b, a && !(index == 0 && hidesAlpha()));
}

// Called after a blit into the window, which ignores masks.
void Replay::makeOpaque() {
    if (!gl.glColorMask || !gl.glClearBufferfv) return;
    const GLfloat opaque[4] = {0, 0, 0, 1};
    const GLboolean discards = gl.glIsEnabled(GL_RASTERIZER_DISCARD);
    if (discards) gl.glDisable(GL_RASTERIZER_DISCARD);
    gl.glDisable(GL_SCISSOR_TEST);
    gl.glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
    gl.glClearBufferfv(GL_COLOR, 0, opaque);
    if (discards) gl.glEnable(GL_RASTERIZER_DISCARD);
    applyColorMasks();
    c_->scissorsDiffer = c_->scissorsDiffer || gl.glScissorIndexed; // the enables of all viewports have changed
    applyScissors();
}

} // namespace mural
