#include "native/runtime/gl_calls.hpp"

#include "native/runtime/gl_loader.hpp"

namespace mural::native {

Result<GlCalls> GlCalls::load(gl::Platform& platform) {
    GlCalls calls;
    GlLoader loader([&platform](const char* name) { return platform.getProcAddress(name); });
    loader.load("glGetError", calls.getError);
    loader.load("glGetString", calls.getString);
    loader.load("glGetIntegerv", calls.getIntegerv);
    loader.load("glEnable", calls.enable);
    loader.load("glDisable", calls.disable);
    loader.load("glViewport", calls.viewport);
    loader.load("glScissor", calls.scissor);
    loader.load("glClear", calls.clear);
    loader.load("glClearColor", calls.clearColor);
    loader.load("glClearDepth", calls.clearDepth);
    loader.load("glClearStencil", calls.clearStencil);
    loader.load("glColorMask", calls.colorMask);
    loader.load("glDepthMask", calls.depthMask);
    loader.load("glStencilMask", calls.stencilMask);
    loader.load("glDrawBuffer", calls.drawBuffer);
    loader.load("glReadBuffer", calls.readBuffer);
    loader.load("glPixelStorei", calls.pixelStorei);
    loader.load("glReadPixels", calls.readPixels);
    loader.load("glFinish", calls.finish);
    loader.load("glBindBuffer", calls.bindBuffer);
    loader.load("glBindFramebuffer", calls.bindFramebuffer);
    loader.load("glGenFramebuffers", calls.genFramebuffers);
    loader.load("glDeleteFramebuffers", calls.deleteFramebuffers);
    loader.load("glFramebufferTexture2D", calls.framebufferTexture2D);
    loader.load("glBlitFramebuffer", calls.blitFramebuffer);
    loader.load("glCheckFramebufferStatus", calls.checkFramebufferStatus);
    loader.load("glGenTextures", calls.genTextures);
    loader.load("glDeleteTextures", calls.deleteTextures);
    loader.load("glBindTexture", calls.bindTexture);
    loader.load("glActiveTexture", calls.activeTexture);
    loader.load("glTexImage2D", calls.texImage2D);
    loader.load("glTexParameteri", calls.texParameteri);
    if (auto complete = loader.result("OpenGL 3.0 is required"); !complete) return complete.error();
    return calls;
}

} // namespace mural::native
