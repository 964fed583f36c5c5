// Clears the picture, makes it visible, and reads it.
#include "tests/fuzz/random_gl/recipes.hpp"

namespace fuzz {
namespace {

void disable(World& w, std::initializer_list<GLenum> capabilities) {
    for (const GLenum capability : capabilities) {
        GL(glDisable, capability);
    }
}

void plainPixelStore(World& w) {
    if (w.profile == Profile::Es1) {
        GL(glPixelStorei, GL_PACK_ALIGNMENT, 4);
        return;
    }
    GL(glBindBuffer, GL_PIXEL_PACK_BUFFER, 0);
    for (const GLenum value : {GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS}) {
        GL(glPixelStorei, value, 0);
    }
    GL(glPixelStorei, GL_PACK_ALIGNMENT, 4);
    if (!w.es()) {
        for (const GLenum value : {GL_PACK_IMAGE_HEIGHT, GL_PACK_SKIP_IMAGES, GL_PACK_SWAP_BYTES, GL_PACK_LSB_FIRST}) {
            GL(glPixelStorei, value, 0);
        }
    }
}

void calmMatrices(World& w) {
    GL(glActiveTexture, GL_TEXTURE0);
    for (const GLenum mode : {GL_TEXTURE, GL_PROJECTION, GL_MODELVIEW}) {
        GL(glMatrixMode, mode);
        GL(glLoadIdentity);
    }
    if (w.random.chance(40)) {
        GL(glRotatef, w.random.around() * 60.0F, w.random.around(), w.random.around(), 1.0F);
    }
}

} // namespace

void calm(World& w) {
    if (w.shaders()) {
        GL(glBindFramebuffer, GL_FRAMEBUFFER, 0);
        GL(glDisable, GL_RASTERIZER_DISCARD);
        GL(glUseProgram, 0);
    }
    disable(w, {GL_CULL_FACE, GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE});
    if (w.random.chance(50)) {
        disable(w, {GL_DEPTH_TEST, GL_BLEND, GL_COLOR_LOGIC_OP});
    }
    if (!w.es()) {
        GL(glDrawBuffer, GL_BACK);
        GL(glPolygonMode, GL_FRONT_AND_BACK, w.random.chance(85) ? GL_FILL : GL_LINE);
    }
    if (w.fixedFunction()) {
        disable(w, {GL_ALPHA_TEST, GL_CLIP_PLANE0, GL_CLIP_PLANE1, GL_FOG});
        calmMatrices(w);
    }
    if (w.profile == Profile::Compat) {
        disable(w, {GL_VERTEX_PROGRAM_ARB, GL_FRAGMENT_PROGRAM_ARB});
    }
    GL(glColorMask, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    GL(glDepthMask, GL_TRUE);
    GL(glViewport, 0, 0, kWidth, kHeight);
}

void clearAll(World& w) {
    if (w.shaders()) {
        GL(glBindFramebuffer, GL_FRAMEBUFFER, 0);
        GL(glDisable, GL_RASTERIZER_DISCARD);
    }
    if (!w.es()) {
        GL(glDrawBuffer, GL_BACK);
    }
    GL(glDisable, GL_SCISSOR_TEST);
    GL(glColorMask, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    GL(glDepthMask, GL_TRUE);
    GL(glStencilMask, ~0U);
    GL(glClear, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT |
                    (w.profile == Profile::Compat ? GL_ACCUM_BUFFER_BIT : 0));
}

void pointAll(World& w, bool buffered) {
    const void* const memory = buffered ? nullptr : vertexMemory(w.random);
    GLuint buffer = 0;
    if (buffered) {
        GL(glGenBuffers, 1, &buffer);
        GL(glBindBuffer, GL_ARRAY_BUFFER, buffer);
        GL(glBufferData, GL_ARRAY_BUFFER, 4096, inputOf(Type::Float, w.random), GL_STATIC_DRAW);
    }
    for (GLuint i = 0; w.shaders() && i < 16; ++i) {
        GL(glVertexAttribPointer, i, 4, GL_FLOAT, GL_FALSE, 0, memory);
    }
    if (w.fixedFunction()) {
        GL(glVertexPointer, 4, GL_FLOAT, 0, memory);
        GL(glColorPointer, 4, GL_FLOAT, 0, memory);
        GL(glTexCoordPointer, 4, GL_FLOAT, 0, memory);
        GL(glNormalPointer, GL_FLOAT, 0, memory);
    }
    if (w.profile == Profile::Compat) {
        GL(glSecondaryColorPointer, 3, GL_FLOAT, 0, memory);
        GL(glFogCoordPointer, GL_FLOAT, 0, memory);
        GL(glIndexPointer, GL_FLOAT, 0, memory);
        GL(glEdgeFlagPointer, 0, memory);
        for (GLenum unit = GL_TEXTURE7; unit >= GL_TEXTURE0; --unit) {
            GL(glClientActiveTexture, unit);
            GL(glTexCoordPointer, 4, GL_FLOAT, 0, memory);
        }
    }
}

void begin(World& w) {
    if (w.profile == Profile::Core) {
        GL(glGenVertexArrays, 1, &w.programVertexArray);
        GL(glBindVertexArray, w.programVertexArray);
    }
    pointAll(w, w.profile == Profile::Core);
    if (!w.es()) {
        for (const GLenum buffer : {GL_FRONT, GL_BACK}) {
            GL(glDrawBuffer, buffer);
            GL(glClear, GL_COLOR_BUFFER_BIT);
        }
    }
    clearAll(w);
}

void observePixels(World& w, int x, int y, int width, int height, GLenum format, GLenum type) {
    plainPixelStore(w);
    const std::size_t bytes = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4 + 4096;
    void* const out = outputMemory(bytes);
    GL(glReadPixels, x, y, width, height, format, type, out);
    w.observe(out, bytes);
}

void observeTargets(World& w) {
    if (w.shaders()) {
        GL(glBindFramebuffer, GL_FRAMEBUFFER, 0);
    }
    if (!w.es()) {
        GL(glReadBuffer, GL_BACK);
    }
    observePixels(w, 0, 0, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE);
    if (!w.es()) {
        observePixels(w, 0, 0, kWidth, kHeight, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
        observePixels(w, 0, 0, kWidth, kHeight, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE);
    }
}

} // namespace fuzz
