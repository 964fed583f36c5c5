// Textures with only some pages: committed, filled, drawn into, released and committed again. The driver's page sizes
// become part of the picture. Only committed pages are read, because the rest is undefined.
#include <algorithm>
#include <vector>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/needs.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

GLuint texture, layered, program, vertexArray, framebuffer;
GLint pageWidth = 1, pageHeight = 1, pages, layerWidth = 1, layerHeight = 1;
constexpr int kColumns = 4, kRows = 3, kLayers = 4;

void fill(GLenum target, int x, int y, int layer, int width, int height, unsigned seed) {
    std::vector<GLubyte> pixels(std::size_t(width) * std::size_t(height) * 4);
    Sequence numbers(seed);
    for (GLubyte& p : pixels) {
        p = numbers.byte();
    }
    if (target == GL_TEXTURE_2D) {
        glTexSubImage2D(target, 0, x, y, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    } else {
        glTexSubImage3D(target, 0, x, y, layer, width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    }
}

void setUp(Window&) {
    needExtension("GL_ARB_sparse_texture");
    program = buildProgram(
        {{GL_VERTEX_SHADER, "#version 430\nuniform vec4 box, part; out vec2 at; void main() { vec2 corner = "
                            "vec2(gl_VertexID & 1, gl_VertexID >> 1 & 1);\n"
                            "at = part.xy + corner * part.zw; gl_Position = vec4(box.xy + corner * box.zw, 0, 1); }\n"},
         {GL_FRAGMENT_SHADER, "#version 430\nin vec2 at; uniform sampler2D image; uniform sampler2DArray images; "
                              "uniform int layer; out vec4 result;\n"
                              "void main() { result = vec4(layer < 0 ? texelFetch(image, ivec2(at), 0).rgb : "
                              "texelFetch(images, ivec3(at, layer), 0).rgb, 1); }\n"}});
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "images"), 1);
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    glGetInternalformativ(GL_TEXTURE_2D, GL_RGBA8, GL_NUM_VIRTUAL_PAGE_SIZES_ARB, 1, &pages);
    if (pages == 0) {
        fail("the driver has no page size for RGBA8");
    }
    glGetInternalformativ(GL_TEXTURE_2D, GL_RGBA8, GL_VIRTUAL_PAGE_SIZE_X_ARB, 1, &pageWidth);
    glGetInternalformativ(GL_TEXTURE_2D, GL_RGBA8, GL_VIRTUAL_PAGE_SIZE_Y_ARB, 1, &pageHeight);
    glGetInternalformativ(GL_TEXTURE_2D_ARRAY, GL_RGBA8, GL_VIRTUAL_PAGE_SIZE_X_ARB, 1, &layerWidth);
    glGetInternalformativ(GL_TEXTURE_2D_ARRAY, GL_RGBA8, GL_VIRTUAL_PAGE_SIZE_Y_ARB, 1, &layerHeight);
    GLuint textures[2];
    glGenTextures(2, textures);
    texture = textures[0], layered = textures[1];
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SPARSE_ARB, GL_TRUE);
    glTexParameteri(GL_TEXTURE_2D, GL_VIRTUAL_PAGE_SIZE_INDEX_ARB, 0);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, pageWidth * kColumns, pageHeight * kRows);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D_ARRAY, layered);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_SPARSE_ARB, GL_TRUE);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_RGBA8, layerWidth * 2, layerHeight, kLayers);
    glActiveTexture(GL_TEXTURE0);
    for (const GLenum target : {GL_TEXTURE_2D, GL_TEXTURE_2D_ARRAY}) {
        glActiveTexture(target == GL_TEXTURE_2D ? GL_TEXTURE0 : GL_TEXTURE1);
        glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
    glActiveTexture(GL_TEXTURE0);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void commit(int column, int row, bool committed) {
    glTexPageCommitmentARB(GL_TEXTURE_2D, 0, column * pageWidth, row * pageHeight, 0, pageWidth, pageHeight, 1,
                           committed ? GL_TRUE : GL_FALSE);
}

void showPart(int cell, int layer, int x, int y, int width, int height) {
    glUniform1i(glGetUniformLocation(program, "layer"), layer);
    glUniform4f(glGetUniformLocation(program, "part"), float(x), float(y), float(width), float(height));
    glUniform4f(glGetUniformLocation(program, "box"), -0.97F + 0.33F * float(cell % 6), -0.55F + 0.5F * float(cell / 6),
                0.31F, 0.46F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void drawFrame(Window& window, int frame) {
    glClearColor(0.1F, 0.12F, 0.16F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const int resident = frame % kColumns, released = (frame + 3) % kColumns;
    commit(resident, 0, true);
    commit(resident, 2, true);
    glFinish();
    fill(GL_TEXTURE_2D, resident * pageWidth, 0, 0, pageWidth, pageHeight, unsigned(frame) + 1);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer); // and one written by drawing
    glEnable(GL_SCISSOR_TEST);
    for (int i = 0; i < 8; ++i) {
        glScissor(resident * pageWidth + i * pageWidth / 8, 2 * pageHeight, pageWidth / 8,
                  pageHeight - i * pageHeight / 16);
        glClearColor(0.125F * float(i), 0.2F, 0.25F * float(frame), 1);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, window.width(), window.height());
    showPart(0, -1, resident * pageWidth, 0, pageWidth, pageHeight);
    showPart(1, -1, resident * pageWidth, 2 * pageHeight, pageWidth, pageHeight / 2);
    glActiveTexture(GL_TEXTURE1);
    const int layer = frame % kLayers;
    glTexturePageCommitmentEXT(layered, 0, layerWidth, 0, layer, layerWidth, layerHeight, 1, GL_TRUE);
    fill(GL_TEXTURE_2D_ARRAY, layerWidth, 0, layer, layerWidth, layerHeight, unsigned(frame) + 77);
    glActiveTexture(GL_TEXTURE0);
    for (int i = 0; i <= std::min(frame, kLayers - 1); ++i) {
        showPart(2 + i, i, layerWidth, 0, layerWidth, layerHeight);
    }
    showBits(0, GLuint(pageWidth) << 16U | GLuint(pageHeight));
    showBits(1, GLuint(pages));
    GLint size = 0;
    glGetIntegerv(GL_MAX_SPARSE_TEXTURE_SIZE_ARB, &size);
    showBits(2, GLuint(size));
    glTexPageCommitmentARB(GL_TEXTURE_2D, 0, 1, 0, 0, pageWidth, pageHeight, 1, GL_TRUE); // not at the start of a page
    showBits(3, glGetError());
    if (frame > 0) { // two stay committed
        glFinish();
        commit(released, 0, false);
        commit(released, 2, false);
    }
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {Profile::Core, 4, 5}, setUp, drawFrame); }
