// Framebuffer objects, draw buffers and read buffers. Window buffers map to those that the surface has.
#include <algorithm>
#include <utility>

#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

void Replay::bindFramebuffer(GLenum target, GLuint framebuffer, void (*bind)(GLenum, GLuint)) {
    bind(target, name(Kind::Framebuffer, framebuffer));
    if (target != GL_READ_FRAMEBUFFER) c_->drawFramebuffer = framebuffer;
    if (target != GL_DRAW_FRAMEBUFFER) c_->readFramebuffer = framebuffer;
    if (target != GL_READ_FRAMEBUFFER) restoreWindowState();
}
void Replay::glBindFramebuffer(GLenum target, GLuint framebuffer) {
    bindFramebuffer(target, framebuffer, gl.glBindFramebuffer ? gl.glBindFramebuffer : gl.glBindFramebufferEXT);
}
void Replay::glBindFramebufferEXT(GLenum target, GLuint framebuffer) {
    bindFramebuffer(target, framebuffer, gl.glBindFramebufferEXT ? gl.glBindFramebufferEXT : gl.glBindFramebuffer);
}
void Replay::glBindFramebufferOES(GLenum target, GLuint framebuffer) {
    bindFramebuffer(target, framebuffer, gl.glBindFramebufferOES ? gl.glBindFramebufferOES : gl.glBindFramebuffer);
}

void Replay::glDeleteFramebuffers(GLsizei n, const Data& framebuffers) {
    deleteFramebuffers(n, framebuffers, gl.glDeleteFramebuffers);
}
void Replay::glDeleteFramebuffersOES(GLsizei n, const Data& framebuffers) {
    deleteFramebuffers(n, framebuffers,
                       gl.glDeleteFramebuffersOES ? gl.glDeleteFramebuffersOES : gl.glDeleteFramebuffers);
}

void Replay::deleteFramebuffers(GLsizei n, const Data& framebuffers, void (*remove)(GLsizei, const GLuint*)) {
    if (n <= 0 || !framebuffers.pointer()) return;
    const auto* app = framebuffers.as<GLuint>();
    remove(n, names(Kind::Framebuffer, app, n));
    for (GLsizei i = 0; i < n; ++i) { // deleting a bound framebuffer binds the window
        if (app[i] != 0 && app[i] == c_->drawFramebuffer) c_->drawFramebuffer = 0;
        if (app[i] != 0 && app[i] == c_->readFramebuffer) c_->readFramebuffer = 0;
    }
    forget(Kind::Framebuffer, app, n);
    restoreWindowState();
}

// A node has one eye of a stereo window: the eye of its pass, or the left one. Draws to the other eye alone have no
// effect here (GL 4.6 17.4.1). Programs that draw both eyes themselves thus keep their own eyes.
GLenum Replay::bufferOfEye(GLenum buffer, const Window* w) const {
    if (!w || !w->config.stereo || c_->api != wire::Api::Desktop) return buffer;
    const bool right = config_.pass.eye == Eye::Right;
    switch (buffer) {
    case GL_LEFT:
    case GL_BACK_LEFT:
    case GL_FRONT_LEFT: return right ? GLenum{GL_NONE} : buffer;
    case GL_RIGHT: return right ? GL_LEFT : GL_NONE;
    case GL_BACK_RIGHT: return right ? GL_BACK_LEFT : GL_NONE;
    case GL_FRONT_RIGHT: return right ? GL_FRONT_LEFT : GL_NONE;
    default: return buffer;
    }
}
// Replaces a buffer of the other eye by that of this node's eye, the only one here. The read must not be an error.
GLenum Replay::readBufferOfEye(GLenum buffer, const Window* w) const {
    const GLenum here = bufferOfEye(buffer, w);
    if (here != GL_NONE || buffer == GL_NONE) return here;
    return buffer == GL_FRONT_LEFT || buffer == GL_FRONT_RIGHT ? GL_FRONT_LEFT : GL_BACK_LEFT;
}

// The name is also valid for glDrawBuffers, which accepts GL_BACK as the only name for several buffers.
GLenum Replay::onlyBuffer(const gl::Surface& surface) {
    return surface.colorBuffers() == gl::ColorBuffers::OneNamedBack ? GL_BACK : GL_FRONT_LEFT;
}
// Returns the only colour buffer of the surface that contains the window's buffer (front_buffer.cpp).
GLenum Replay::windowBuffer(GLenum buffer, const Window* w) const {
    if (!w || !w->surface || !w->surface->singleBuffered() || c_->api != wire::Api::Desktop) return buffer;
    switch (buffer) {
    case GL_BACK:
    case GL_BACK_LEFT:
    case GL_FRONT:
    case GL_FRONT_LEFT:
    case GL_LEFT:
    case GL_FRONT_AND_BACK: return onlyBuffer(*w->surface);
    default: return buffer;
    }
}
void Replay::drawBufferOfWindow(GLenum buffer) {
    buffersChanged(std::exchange(c_->drawBuffer0, buffer));
    if (moves()) restoreWindowState(); // the front buffer may be divided differently
}
void Replay::readBufferOfWindow(GLenum buffer) {
    c_->readBuffer0 = buffer;
    buffersChanged(c_->drawBuffer0);
}
void Replay::glDrawBuffer(GLenum buf) {
    if (drawsWindow()) buf = bufferOfEye(buf, c_->draw);
    gl.glDrawBuffer(drawsWindow() ? windowBuffer(buf, c_->draw) : buf);
    if (drawsWindow()) drawBufferOfWindow(buf);
}
// `call` passes the buffers to the driver.
void Replay::drawBuffers(bool ofWindow, GLsizei n, const Data& bufs, const std::function<void(const GLenum*)>& call) {
    if (n < 0 || (n > 0 && !bufs.pointer())) return;
    std::vector<GLenum> list(bufs.as<GLenum>(), bufs.as<GLenum>() + n); // no buffers: draws have no effect
    if (!ofWindow) return call(list.data());
    for (GLenum& b : list) b = bufferOfEye(b, c_->draw);
    // The first buffer selects the surface; in stereo, the first buffer of this node's eye.
    const auto chosen = c_->draw && c_->draw->config.stereo
                            ? std::ranges::find_if(list, [](GLenum b) { return b != GL_NONE; })
                            : list.begin();
    const GLenum first = chosen == list.end() ? GLenum{GL_NONE} : *chosen;
    for (GLenum& b : list) b = windowBuffer(b, c_->draw);
    call(list.data());
    drawBufferOfWindow(first);
}
void Replay::glDrawBuffers(GLsizei n, const Data& bufs) {
    if (gl.glDrawBuffers)
        drawBuffers(drawsWindow(), n, bufs, [&](const GLenum* nodeBuffers) { gl.glDrawBuffers(n, nodeBuffers); });
}
void Replay::glReadBuffer(GLenum src) {
    if (c_->readFramebuffer == 0) src = readBufferOfEye(src, c_->read);
    gl.glReadBuffer(c_->readFramebuffer == 0 ? windowBuffer(src, c_->read) : src);
    if (c_->readFramebuffer == 0) readBufferOfWindow(src);
}
// NV_draw_buffers and NV_read_buffer of OpenGL ES 2.
void Replay::glDrawBuffersNV(GLsizei n, const Data& bufs) { glDrawBuffers(n, bufs); }
void Replay::glReadBufferNV(GLenum mode) {
    if (gl.glReadBuffer) glReadBuffer(mode);
}
void Replay::glNamedFramebufferDrawBuffer(GLuint framebuffer, GLenum buf) {
    if (framebuffer == 0) buf = bufferOfEye(buf, c_->draw);
    gl.glNamedFramebufferDrawBuffer(name(Kind::Framebuffer, framebuffer),
                                    framebuffer == 0 ? windowBuffer(buf, c_->draw) : buf);
    if (framebuffer == 0) drawBufferOfWindow(buf);
}
void Replay::glNamedFramebufferDrawBuffers(GLuint framebuffer, GLsizei n, const Data& bufs) {
    drawBuffers(framebuffer == 0, n, bufs, [&](const GLenum* nodeBuffers) {
        gl.glNamedFramebufferDrawBuffers(name(Kind::Framebuffer, framebuffer), n, nodeBuffers);
    });
}
void Replay::glNamedFramebufferReadBuffer(GLuint framebuffer, GLenum src) {
    if (framebuffer == 0) src = readBufferOfEye(src, c_->read);
    gl.glNamedFramebufferReadBuffer(name(Kind::Framebuffer, framebuffer),
                                    framebuffer == 0 ? windowBuffer(src, c_->read) : src);
    if (framebuffer == 0) readBufferOfWindow(src);
}
// The same for EXT_direct_state_access.
void Replay::glFramebufferDrawBufferEXT(GLuint framebuffer, GLenum mode) {
    if (!gl.glFramebufferDrawBufferEXT) return;
    if (framebuffer == 0) mode = bufferOfEye(mode, c_->draw);
    gl.glFramebufferDrawBufferEXT(name(Kind::Framebuffer, framebuffer),
                                  framebuffer == 0 ? windowBuffer(mode, c_->draw) : mode);
    if (framebuffer == 0) drawBufferOfWindow(mode);
}
void Replay::glFramebufferDrawBuffersEXT(GLuint framebuffer, GLsizei n, const Data& bufs) {
    if (gl.glFramebufferDrawBuffersEXT)
        drawBuffers(framebuffer == 0, n, bufs, [&](const GLenum* nodeBuffers) {
            gl.glFramebufferDrawBuffersEXT(name(Kind::Framebuffer, framebuffer), n, nodeBuffers);
        });
}
void Replay::glFramebufferReadBufferEXT(GLuint framebuffer, GLenum mode) {
    if (!gl.glFramebufferReadBufferEXT) return;
    if (framebuffer == 0) mode = readBufferOfEye(mode, c_->read);
    gl.glFramebufferReadBufferEXT(name(Kind::Framebuffer, framebuffer),
                                  framebuffer == 0 ? windowBuffer(mode, c_->read) : mode);
    if (framebuffer == 0) readBufferOfWindow(mode);
}
// Invalidation is only a hint, and could discard the pixels of another tile: ignored for windows.
void Replay::glInvalidateFramebuffer(GLenum target, GLsizei n, const Data& attachments) {
    if (!drawsWindow() && n > 0 && attachments.pointer() && gl.glInvalidateFramebuffer)
        gl.glInvalidateFramebuffer(target, n, attachments.as<GLenum>());
}
void Replay::glInvalidateSubFramebuffer(GLenum target, GLsizei n, const Data& attachments, GLint x, GLint y,
                                        GLsizei width, GLsizei height) {
    if (!drawsWindow() && n > 0 && attachments.pointer() && gl.glInvalidateSubFramebuffer)
        gl.glInvalidateSubFramebuffer(target, n, attachments.as<GLenum>(), x, y, width, height);
}
void Replay::glDiscardFramebufferEXT(GLenum target, GLsizei n, const Data& attachments) {
    if (!drawsWindow() && n > 0 && attachments.pointer() && gl.glDiscardFramebufferEXT)
        gl.glDiscardFramebufferEXT(target, n, attachments.as<GLenum>());
}

} // namespace mural
