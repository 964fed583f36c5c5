// Takes the contents of OSMesa's default framebuffer out of one context and puts them into another.
//
// OSMesa keeps the buffers in the context, not with the memory that it is given: a second surface of
// the same size would show the first one's picture, one of another size or in another context an
// empty one. These copies make surfaces behave as those of EGL and GLX. Nothing else of GL's state
// changes. Colours, stencil and 16-bit depth come back exactly; of 24-bit depths a third comes back one
// unit off (measured over all values: a blit takes them through floats, which miss 6 % of the values).
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

    // Both: a context is current with a framebuffer of these bits. compatibility: not a core profile.
    SavedPixels save(const SurfaceConfig& config, bool compatibility) const;
    void restore(const SurfaceConfig& config, bool compatibility, const SavedPixels& pixels) const;
    // Colours, depth and stencil 0, alpha as given, whatever the context's masks are.
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
