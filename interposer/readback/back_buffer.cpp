#include "interposer/readback/back_buffer.hpp"

#include <GL/glext.h>
#include <bit>
#include <cstdlib>
#include <utility>

#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/memory/pixel_store.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/readback/window_colours.hpp"
#include "streamcodec/wire/control_records.hpp"

extern "C" void mural_glBindFramebuffer(GLenum target, GLuint framebuffer);
extern "C" void mural_glReadBuffer(GLenum buffer);

namespace mural {

namespace {

// An object that another context of the share group has deleted may still be bound here.
bool canBindAgain(GLint framebuffer) {
    return !framebuffer || !gReal.glIsFramebuffer || gReal.glIsFramebuffer(static_cast<GLuint>(framebuffer));
}

bool isExiting = false;

// Mesa looks up formats of unpacked types in a table. It creates the table at the first such read and frees it when the
// process begins to exit. Reads after that crash. The packed type yields the same bytes without the table; OpenGL ES
// lacks it.
GLenum withoutTable(const Context& context, GLenum type) {
    static_assert(std::endian::native == std::endian::little);
    return type == GL_UNSIGNED_BYTE && context.api == wire::Api::Desktop ? GL_UNSIGNED_INT_8_8_8_8_REV : type;
}

bool isTooLate(const Context& context, const Window& window) {
    static bool registered = false;
    if (!std::exchange(registered, true)) std::atexit([] { isExiting = true; });
    const GLenum type = withoutTable(context, colourReadsOf(context, window).type);
    return isExiting && context.isMesa && (type == GL_UNSIGNED_BYTE || type == GL_FLOAT);
}

// Errors of the program take precedence over ours.
Context& withErrorsStashed(Context& context) {
    stashError(context, driverError());
    return context;
}

} // namespace

BackBufferRead::BackBufferRead(Context& context, const Window& window, Where where)
    : context_(withErrorsStashed(context)), where_(where), pack_(context) {
    const bool twoTargets = context.version >= 30;
    target_ = twoTargets ? GL_READ_FRAMEBUFFER : GL_FRAMEBUFFER;
    if (gReal.glBindFramebuffer)
        gReal.glGetIntegerv(twoTargets ? GL_READ_FRAMEBUFFER_BINDING : GL_FRAMEBUFFER_BINDING, &framebuffer_);
    ready_ = pack_.ready() && canBindAgain(framebuffer_) && !isTooLate(context, window);
    if (ready_) bindWindow(window);
}

BackBufferRead::~BackBufferRead() {
    if (ready_) {
        if (readBuffer_)
            (where_ == Where::NodesToo ? mural_glReadBuffer : gReal.glReadBuffer)(static_cast<GLenum>(readBuffer_));
        if (framebuffer_)
            (where_ == Where::NodesToo ? mural_glBindFramebuffer
                                       : gReal.glBindFramebuffer)(target_, static_cast<GLuint>(framebuffer_));
    }
    driverError(); // discards our own error, if any
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
    gReal.glReadPixels(x, y, width, height, GL_RGBA, withoutTable(context_, type), into);
}

} // namespace mural
