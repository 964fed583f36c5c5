#include "native/runtime/gl_calls.hpp"

#include <string>

namespace mural::native {

Result<GlCalls> GlCalls::load(gl::Platform& platform) {
    GlCalls calls;
    std::string missing;
    const auto find = [&](const char* name, auto& call) {
        call = reinterpret_cast<std::remove_reference_t<decltype(call)>>(platform.getProcAddress(name));
        if (!call && missing.empty()) missing = name;
    };
    find("glGetError", calls.getError);
    find("glGetString", calls.getString);
    find("glGetIntegerv", calls.getIntegerv);
    find("glEnable", calls.enable);
    find("glDisable", calls.disable);
    find("glViewport", calls.viewport);
    find("glScissor", calls.scissor);
    find("glClear", calls.clear);
    find("glClearColor", calls.clearColor);
    find("glClearDepth", calls.clearDepth);
    find("glClearStencil", calls.clearStencil);
    find("glColorMask", calls.colorMask);
    find("glDepthMask", calls.depthMask);
    find("glStencilMask", calls.stencilMask);
    find("glDrawBuffer", calls.drawBuffer);
    find("glReadBuffer", calls.readBuffer);
    find("glPixelStorei", calls.pixelStorei);
    find("glReadPixels", calls.readPixels);
    find("glFinish", calls.finish);
    find("glBindBuffer", calls.bindBuffer);
    find("glBindFramebuffer", calls.bindFramebuffer);
    find("glGenFramebuffers", calls.genFramebuffers);
    find("glDeleteFramebuffers", calls.deleteFramebuffers);
    find("glFramebufferTexture2D", calls.framebufferTexture2D);
    find("glBlitFramebuffer", calls.blitFramebuffer);
    find("glGenTextures", calls.genTextures);
    find("glDeleteTextures", calls.deleteTextures);
    find("glBindTexture", calls.bindTexture);
    find("glActiveTexture", calls.activeTexture);
    find("glTexImage2D", calls.texImage2D);
    find("glTexParameteri", calls.texParameteri);
    if (!missing.empty()) return Error{"the GL driver lacks " + missing + "; OpenGL 3.0 is required"};
    return calls;
}

} // namespace mural::native
