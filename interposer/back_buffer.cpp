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

// In the order in which the versions have brought them: ES 1 and 2 have the last only, ES 3 has no swapping.
constexpr GLenum kPack[6] = {GL_PACK_SWAP_BYTES, GL_PACK_LSB_FIRST, GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS, GL_PACK_ALIGNMENT};

// What another context of the share group has deleted may still be bound here.
bool canBindAgain(GLint framebuffer, GLint packBuffer) {
    if (framebuffer && gReal.glIsFramebuffer && !gReal.glIsFramebuffer(static_cast<GLuint>(framebuffer))) return false;
    return !packBuffer || gReal.glIsBuffer(static_cast<GLuint>(packBuffer));
}

} // namespace

BackBufferRead::BackBufferRead(Context& context, const Window& window, Where where) : context_(context), where_(where) {
    const bool twoTargets = context.version >= 30;
    target_ = twoTargets ? GL_READ_FRAMEBUFFER : GL_FRAMEBUFFER;
    stashError(context, driverError());
    if (gReal.glBindFramebuffer) gReal.glGetIntegerv(twoTargets ? GL_READ_FRAMEBUFFER_BINDING : GL_FRAMEBUFFER_BINDING, &framebuffer_);
    if (packBufferBound(context)) gReal.glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &packBuffer_);
    ready_ = canBindAgain(framebuffer_, packBuffer_);
    if (!ready_) return;
    bindWindow(window);
    setPack();
}

BackBufferRead::~BackBufferRead() {
    if (ready_) {
        for (int i = firstPack_; i < 6; ++i) gReal.glPixelStorei(kPack[i], pack_[i]);
        if (readBuffer_) (where_ == Where::NodesToo ? mural_glReadBuffer : gReal.glReadBuffer)(static_cast<GLenum>(readBuffer_));
        if (packBuffer_) gReal.glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(packBuffer_));
        if (framebuffer_) (where_ == Where::NodesToo ? mural_glBindFramebuffer : gReal.glBindFramebuffer)(target_, static_cast<GLuint>(framebuffer_));
    }
    driverError(); // ours, if any
}

void BackBufferRead::bindWindow(const Window& window) {
    if (framebuffer_) (where_ == Where::NodesToo ? mural_glBindFramebuffer : gReal.glBindFramebuffer)(target_, 0);
    if (packBuffer_) gReal.glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    const bool choosesBuffer = context_.api == wire::Api::Desktop || context_.version >= 30;
    if (!choosesBuffer || !gReal.glReadBuffer) return;
    gReal.glGetIntegerv(GL_READ_BUFFER, &readBuffer_);
    const GLenum wanted = window.config.doubleBuffer || context_.api != wire::Api::Desktop ? GL_BACK : GL_FRONT;
    (where_ == Where::NodesToo ? mural_glReadBuffer : gReal.glReadBuffer)(wanted);
}

void BackBufferRead::setPack() {
    firstPack_ = context_.api == wire::Api::Desktop ? 0 : context_.version >= 30 ? 2 : 5;
    for (int i = firstPack_; i < 6; ++i) {
        gReal.glGetIntegerv(kPack[i], &pack_[i]);
        gReal.glPixelStorei(kPack[i], i == 5 ? 1 : 0);
    }
}

void BackBufferRead::pixels(GLint x, GLint y, GLsizei width, GLsizei height, void* into) const {
    gReal.glReadPixels(x, y, width, height, GL_RGBA, GL_UNSIGNED_BYTE, into);
}

} // namespace mural
