#include "interposer/back_buffer.hpp"

#include <GL/glext.h>

#include "interposer/asking.hpp"
#include "interposer/context.hpp"
#include "interposer/pixel_store.hpp"
#include "interposer/real_gl.hpp"

extern "C" void mural_glBindFramebuffer(GLenum target, GLuint framebuffer);
extern "C" void mural_glReadBuffer(GLenum buffer);

namespace mural {

namespace {

// What another context of the share group has deleted may still be bound here.
bool canBindAgain(GLint framebuffer) {
    return !framebuffer || !gReal.glIsFramebuffer || gReal.glIsFramebuffer(static_cast<GLuint>(framebuffer));
}

// The program's own errors come before ours.
Context& withErrorsStashed(Context& context) {
    stashError(context, driverError());
    return context;
}

} // namespace

BackBufferRead::BackBufferRead(Context& context, const Window& window, Where where) : context_(withErrorsStashed(context)), where_(where), pack_(context) {
    const bool twoTargets = context.version >= 30;
    target_ = twoTargets ? GL_READ_FRAMEBUFFER : GL_FRAMEBUFFER;
    if (gReal.glBindFramebuffer) gReal.glGetIntegerv(twoTargets ? GL_READ_FRAMEBUFFER_BINDING : GL_FRAMEBUFFER_BINDING, &framebuffer_);
    ready_ = pack_.ready() && canBindAgain(framebuffer_);
    if (ready_) bindWindow(window);
}

BackBufferRead::~BackBufferRead() {
    if (ready_) {
        if (readBuffer_) (where_ == Where::NodesToo ? mural_glReadBuffer : gReal.glReadBuffer)(static_cast<GLenum>(readBuffer_));
        if (framebuffer_) (where_ == Where::NodesToo ? mural_glBindFramebuffer : gReal.glBindFramebuffer)(target_, static_cast<GLuint>(framebuffer_));
    }
    driverError(); // ours, if any
}

void BackBufferRead::bindWindow(const Window& window) {
    if (framebuffer_) (where_ == Where::NodesToo ? mural_glBindFramebuffer : gReal.glBindFramebuffer)(target_, 0);
    const bool choosesBuffer = context_.api == wire::Api::Desktop || context_.version >= 30;
    if (!choosesBuffer || !gReal.glReadBuffer) return;
    gReal.glGetIntegerv(GL_READ_BUFFER, &readBuffer_);
    const GLenum wanted = window.config.doubleBuffer || context_.api != wire::Api::Desktop ? GL_BACK : GL_FRONT;
    (where_ == Where::NodesToo ? mural_glReadBuffer : gReal.glReadBuffer)(wanted);
}

void BackBufferRead::pixels(GLint x, GLint y, GLsizei width, GLsizei height, void* into, GLenum type) const {
    gReal.glReadPixels(x, y, width, height, GL_RGBA, type, into);
}

} // namespace mural
