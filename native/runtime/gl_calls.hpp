// The few GL commands that Mural itself issues in the context of a renderer.
#pragma once

#include <GL/glcorearb.h>

#include "common/base/result.hpp"
#include "nodes/gl/gl_platform.hpp"

namespace mural::native {

struct GlCalls {
    PFNGLGETERRORPROC getError = nullptr;
    PFNGLGETSTRINGPROC getString = nullptr;
    PFNGLGETINTEGERVPROC getIntegerv = nullptr;
    PFNGLENABLEPROC enable = nullptr;
    PFNGLDISABLEPROC disable = nullptr;
    PFNGLVIEWPORTPROC viewport = nullptr;
    PFNGLSCISSORPROC scissor = nullptr;
    PFNGLCLEARPROC clear = nullptr;
    PFNGLCLEARCOLORPROC clearColor = nullptr;
    PFNGLCLEARDEPTHPROC clearDepth = nullptr;
    PFNGLCLEARSTENCILPROC clearStencil = nullptr;
    PFNGLCOLORMASKPROC colorMask = nullptr;
    PFNGLDEPTHMASKPROC depthMask = nullptr;
    PFNGLSTENCILMASKPROC stencilMask = nullptr;
    PFNGLDRAWBUFFERPROC drawBuffer = nullptr;
    PFNGLREADBUFFERPROC readBuffer = nullptr;
    PFNGLPIXELSTOREIPROC pixelStorei = nullptr;
    PFNGLREADPIXELSPROC readPixels = nullptr;
    PFNGLFINISHPROC finish = nullptr;
    PFNGLBINDBUFFERPROC bindBuffer = nullptr;
    PFNGLBINDFRAMEBUFFERPROC bindFramebuffer = nullptr;
    PFNGLGENFRAMEBUFFERSPROC genFramebuffers = nullptr;
    PFNGLDELETEFRAMEBUFFERSPROC deleteFramebuffers = nullptr;
    PFNGLFRAMEBUFFERTEXTURE2DPROC framebufferTexture2D = nullptr;
    PFNGLBLITFRAMEBUFFERPROC blitFramebuffer = nullptr;
    PFNGLCHECKFRAMEBUFFERSTATUSPROC checkFramebufferStatus = nullptr;
    PFNGLGENTEXTURESPROC genTextures = nullptr;
    PFNGLDELETETEXTURESPROC deleteTextures = nullptr;
    PFNGLBINDTEXTUREPROC bindTexture = nullptr;
    PFNGLACTIVETEXTUREPROC activeTexture = nullptr;
    PFNGLTEXIMAGE2DPROC texImage2D = nullptr;
    PFNGLTEXPARAMETERIPROC texParameteri = nullptr;

    // Requires a current context. Errors: names a missing command.
    static Result<GlCalls> load(gl::Platform& platform);
};

} // namespace mural::native
