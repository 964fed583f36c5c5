// Programs that draw their scene into a framebuffer object and then show it: what a pass moves is the scene, not the
// quad or blit that shows it. A framebuffer object with a depth buffer, through a viewport of the window's size, is taken
// for a scene's; shadow maps, textures and filters have other sizes or no depth buffer, and stay as they are.
#include <utility>

#include "nodes/replay/replay.hpp"

namespace mural {

// Eyes look at windows and at scenes elsewhere.
bool Replay::isSeen() const { return drawsWindow() || c_->sceneSized; }

// Samples are taken of scenes: of what is depth-tested, and in windows of everything while no scene is drawn elsewhere.
bool Replay::drawsScene() const {
    if (!drawsWindow()) return c_->sceneSized && c_->depthTested;
    return c_->depthTested || !c_->draw || !(c_->draw->sceneElsewhere || c_->draw->sceneWasElsewhere);
}

bool Replay::hasDepthAttached() {
    if (!c_->attachmentsKnown) {
        GLint type = GL_NONE;
        const GLenum target = c_->api == wire::Api::Desktop || c_->version >= 30 ? GL_DRAW_FRAMEBUFFER : GL_FRAMEBUFFER;
        if (gl.glGetFramebufferAttachmentParameteriv) gl.glGetFramebufferAttachmentParameteriv(target, GL_DEPTH_ATTACHMENT, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &type);
        c_->depthAttached = type != GL_NONE;
        c_->attachmentsKnown = true;
    }
    return c_->depthAttached;
}

// Before a command that draws.
void Replay::noteScene() {
    if (!c_->draw) return;
    const auto& v = c_->viewports[0];
    const PixelViewport& window = c_->draw->whole;
    const bool sized = !drawsWindow() && v[2] == static_cast<GLfloat>(window.w) && v[3] == static_cast<GLfloat>(window.h) && hasDepthAttached();
    const bool tested = gl.glIsEnabled(GL_DEPTH_TEST) == GL_TRUE;
    if (sized && tested) c_->draw->sceneElsewhere = true;
    const bool wasSized = std::exchange(c_->sceneSized, sized), wasTested = std::exchange(c_->depthTested, tested);
    if (wasSized == sized && wasTested == tested) return;
    if (movesPicture()) applyViewports();
    applyTileValues();
}

} // namespace mural
