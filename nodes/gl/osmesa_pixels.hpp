// Copies the contents of OSMesa's default framebuffer from one context to another.
//
// OSMesa keeps the buffers in the context, not in the memory that the caller passes. A second surface of the same size
// would show the picture of the first. A surface of another size or in another context would be empty. These copies
// make surfaces behave as in EGL and GLX. They change no other GL state.
//
// Colours, stencil and 16-bit depth are restored exactly. A third of the 24-bit depths come back one unit off. A blit
// converts them to floats, which lack 6 % of the values (measured over all values).
#pragma once

#include <cstddef>
#include <vector>

#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>

#include "nodes/gl/gl_platform.hpp"

namespace mural::gl {

struct SavedPixels {
    bool valid = false;
    std::vector<std::byte> color, depthStencil;
};

class OsmesaPixels {
public:
    explicit OsmesaPixels(decltype(&OSMesaGetProcAddress) getProcAddress);

    // Precondition of save() and restore(): a context is current with a framebuffer of these bits. compatibility: not a
    // core profile.
    SavedPixels save(const SurfaceConfig& config, bool compatibility) const;
    void restore(const SurfaceConfig& config, bool compatibility, const SavedPixels& pixels) const;
    // Sets colours, depth and stencil to 0 and alpha to `alpha`. Ignores the masks of the context.
    void clearNew(const SurfaceConfig& config, bool compatibility, GLfloat alpha) const;

private:
    struct Functions {
        PFNGLBINDBUFFERPROC bindBuffer;
        PFNGLBINDFRAMEBUFFERPROC bindFramebuffer;
        PFNGLBLITFRAMEBUFFERPROC blitFramebuffer;
        PFNGLDELETEFRAMEBUFFERSPROC deleteFramebuffers;
        PFNGLGENFRAMEBUFFERSPROC genFramebuffers;
        PFNGLFRAMEBUFFERTEXTURE2DPROC framebufferTexture2D;
        PFNGLCLEARBUFFERFVPROC clearBufferfv;
        PFNGLCLEARBUFFERIVPROC clearBufferiv;
        PFNGLCOLORMASKIPROC colorMaski;
        PFNGLGETBOOLEANI_VPROC getBooleani;
        PFNGLENABLEIPROC enablei;
        PFNGLDISABLEIPROC disablei;
        PFNGLISENABLEDIPROC isEnabledi;
        void (*bindTexture)(GLenum, GLuint);
        void (*deleteTextures)(GLsizei, const GLuint*);
        void (*depthMask)(GLboolean);
        void (*disable)(GLenum);
        void (*drawBuffer)(GLenum);
        void (*enable)(GLenum);
        void (*genTextures)(GLsizei, GLuint*);
        void (*getFloatv)(GLenum, GLfloat*);
        void (*getIntegerv)(GLenum, GLint*);
        GLboolean (*isEnabled)(GLenum);
        void (*pixelStorei)(GLenum, GLint);
        void (*pixelTransferf)(GLenum, GLfloat);
        void (*readBuffer)(GLenum);
        void (*stencilMaskSeparate)(GLenum, GLuint);
        void (*readPixels)(GLint, GLint, GLsizei, GLsizei, GLenum, GLenum, void*);
        void (*texImage2D)(GLenum, GLint, GLint, GLsizei, GLsizei, GLint, GLenum, GLenum, const void*);
    };
    class NeutralState;

    [[nodiscard]] GLint get(GLenum name) const;
    // Draws one plane of saved pixels into the default framebuffer.
    void restorePlane(const SurfaceConfig& config, GLbitfield mask, const std::vector<std::byte>& pixels) const;

    Functions gl_{};
};

} // namespace mural::gl
