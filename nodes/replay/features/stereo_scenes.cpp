// Programs that draw their scene into a framebuffer object and then show it. A pass must transform the scene, not the
// quad or blit that shows it. Heuristic: a framebuffer object with a depth buffer and a viewport of the window's size
// contains the scene. Shadow maps, textures and filters have other sizes or no depth buffer, and are not transformed.
#include <utility>

#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

// Stereo applies to windows and to scenes in framebuffer objects.
bool Replay::isSeen() const { return drawsWindow() || c_->sceneSized; }

// Sample offsets apply to scenes: to depth-tested draws, and in windows to all draws while no scene is drawn elsewhere.
bool Replay::drawsScene() const {
    if (!drawsWindow()) return c_->sceneSized && c_->depthTested;
    return c_->depthTested || !c_->draw || !(c_->draw->sceneElsewhere || c_->draw->sceneWasElsewhere);
}

bool Replay::hasDepthAttached() {
    if (!c_->attachmentsKnown) {
        GLint type = GL_NONE;
        const GLenum target = c_->api == wire::Api::Desktop || c_->version >= 30 ? GL_DRAW_FRAMEBUFFER : GL_FRAMEBUFFER;
        if (gl.glGetFramebufferAttachmentParameteriv)
            gl.glGetFramebufferAttachmentParameteriv(target, GL_DEPTH_ATTACHMENT, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE,
                                                     &type);
        c_->depthAttached = type != GL_NONE;
        c_->attachmentsKnown = true;
    }
    return c_->depthAttached;
}

// Called before each draw command.
void Replay::onScene() {
    if (!c_->draw) return;
    const auto& v = c_->viewports[0];
    const PixelViewport& window = c_->draw->whole;
    const bool sized = !drawsWindow() && v[2] == static_cast<GLfloat>(window.w) &&
                       v[3] == static_cast<GLfloat>(window.h) && hasDepthAttached();
    const bool tested = gl.glIsEnabled(GL_DEPTH_TEST) == GL_TRUE;
    if (sized && tested) c_->draw->sceneElsewhere = true;
    const bool wasSized = std::exchange(c_->sceneSized, sized), wasTested = std::exchange(c_->depthTested, tested);
    if (wasSized == sized && wasTested == tested) return;
    if (movesPicture()) applyViewports();
    applyTileValues();
}

} // namespace mural
