#include "native/runtime/gl_calls.hpp"

#include <string>

namespace mural::native {

Result<GlCalls> GlCalls::load(gl::Platform& platform) {
    GlCalls calls;
    std::string missing;
    const auto load = [&](const char* name, auto& call) {
        call = reinterpret_cast<std::remove_reference_t<decltype(call)>>(platform.getProcAddress(name));
        if (!call && missing.empty()) missing = name;
    };
    load("glGetError", calls.getError);
    load("glGetString", calls.getString);
    load("glGetIntegerv", calls.getIntegerv);
    load("glEnable", calls.enable);
    load("glDisable", calls.disable);
    load("glViewport", calls.viewport);
    load("glScissor", calls.scissor);
    load("glClear", calls.clear);
    load("glClearColor", calls.clearColor);
    load("glClearDepth", calls.clearDepth);
    load("glClearStencil", calls.clearStencil);
    load("glColorMask", calls.colorMask);
    load("glDepthMask", calls.depthMask);
    load("glStencilMask", calls.stencilMask);
    load("glDrawBuffer", calls.drawBuffer);
    load("glReadBuffer", calls.readBuffer);
    load("glPixelStorei", calls.pixelStorei);
    load("glReadPixels", calls.readPixels);
    load("glFinish", calls.finish);
    load("glBindBuffer", calls.bindBuffer);
    load("glBindFramebuffer", calls.bindFramebuffer);
    load("glGenFramebuffers", calls.genFramebuffers);
    load("glDeleteFramebuffers", calls.deleteFramebuffers);
    load("glFramebufferTexture2D", calls.framebufferTexture2D);
    load("glBlitFramebuffer", calls.blitFramebuffer);
    load("glGenTextures", calls.genTextures);
    load("glDeleteTextures", calls.deleteTextures);
    load("glBindTexture", calls.bindTexture);
    load("glActiveTexture", calls.activeTexture);
    load("glTexImage2D", calls.texImage2D);
    load("glTexParameteri", calls.texParameteri);
    if (!missing.empty()) return Error{"the GL driver lacks " + missing + "; OpenGL 3.0 is required"};
    return calls;
}

} // namespace mural::native
