// The pixel paths into the window: glDrawPixels, glBitmap, glCopyPixels with zoom, maps, scale and bias, glRasterPos in
// all forms, glWindowPos, stencil and depth pixels.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

std::vector<GLubyte> noise(std::size_t count, unsigned seed) {
    std::vector<GLubyte> bytes(count);
    Sequence numbers(seed);
    for (GLubyte& value : bytes) {
        value = numbers.byte();
    }
    return bytes;
}

void drawFormats(unsigned frame) {
    const GLenum kinds[][2] = {{GL_RGB, GL_UNSIGNED_BYTE},
                               {GL_RGBA, GL_UNSIGNED_BYTE},
                               {GL_BGRA, GL_UNSIGNED_BYTE},
                               {GL_LUMINANCE, GL_UNSIGNED_BYTE},
                               {GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE},
                               {GL_RED, GL_BYTE},
                               {GL_GREEN, GL_UNSIGNED_SHORT},
                               {GL_RGB, GL_SHORT},
                               {GL_RGBA, GL_UNSIGNED_INT},
                               {GL_RGB, GL_UNSIGNED_SHORT_5_6_5},
                               {GL_RGBA, GL_UNSIGNED_INT_8_8_8_8},
                               {GL_BGRA, GL_UNSIGNED_SHORT_4_4_4_4_REV},
                               {GL_BGR, GL_INT}};
    int index = 0;
    for (const auto& kind : kinds) {
        glWindowPos2i(3 + (index % 7) * 20, 3 + (index / 7) * 14);
        glDrawPixels(17, 11, kind[0], kind[1], noise(17 * 11 * 16 + 64, frame + unsigned(index)).data());
        ++index;
    }
    GLfloat floats[12 * 3];
    for (int i = 0; i < 36; ++i) {
        floats[i] = float((i * 5 + int(frame)) % 13) / 12.0F;
    }
    glWindowPos2f(145, 5);
    glDrawPixels(4, 3, GL_RGB, GL_FLOAT, floats);
}

// Draws a part of a larger picture, with odd rows, first bits and swapped bytes.
void drawWithPixelStore(unsigned frame) {
    glPushClientAttrib(GL_CLIENT_PIXEL_STORE_BIT);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 29);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, 3);
    glPixelStorei(GL_UNPACK_SKIP_ROWS, 2);
    glWindowPos2i(160, 5);
    glDrawPixels(19, 13, GL_RGB, GL_UNSIGNED_BYTE, noise(29 * 3 * 16, 90 + frame).data());
    glPixelStorei(GL_UNPACK_LSB_FIRST, GL_TRUE);
    glColor3f(0.3F, 1, 0.6F);
    glWindowPos2i(210, 5);
    glBitmap(21, 17, 2, 1, 0, 0, noise(512, 92 + frame).data());
    glPopClientAttrib();
    // Without a row length: Mesa 22 swaps only the beginning of a larger picture.
    glPixelStorei(GL_UNPACK_SWAP_BYTES, GL_TRUE);
    glWindowPos2i(185, 5);
    glDrawPixels(19, 13, GL_RGB, GL_UNSIGNED_SHORT, noise(19 * 6 * 16, 91 + frame).data());
    glPixelStorei(GL_UNPACK_SWAP_BYTES, GL_FALSE);
    glColor3f(1, 0.5F, 0.5F);
    glWindowPos2i(235, 5);
    glBitmap(11, 15, 0, 0, 0, 0, noise(64, 93 + frame).data());
}

// Sets raster positions in all ways; a bitmap shows each position.
void drawRasterPositions(unsigned frame) {
    const GLubyte cross[] = {0x18, 0x18, 0x18, 0xff, 0xff, 0x18, 0x18, 0x18};
    const auto mark = [&] { glBitmap(8, 8, 4, 4, 12, 0, cross); };
    const auto x = GLfloat(frame);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glColor3f(1, 1, 0.4F);
    glRasterPos2f(10.5F + x, 40), mark(), mark();
    glRasterPos2d(40.25 + double(x), 40), mark();
    glRasterPos2i(60, 40 + GLint(frame)), mark();
    glRasterPos2s(80, 40), mark();
    glColor3f(0.4F, 1, 1);
    glRasterPos3f(100, 40, 0.2F), mark();
    glRasterPos3d(120, 40, -0.2), mark();
    glRasterPos3i(140, 40, 0), mark();
    glRasterPos4f(160, 40, 0, 1), mark();
    glRasterPos4s(360, 80, 0, 2), mark();
    const GLfloat place[] = {200, 40.5F};
    glRasterPos2fv(place), mark();
    const GLint place4[] = {220, 40, 0, 1};
    glRasterPos4iv(place4), mark();
    // Outside the window on the left: invalid, so nothing may appear.
    glRasterPos2i(-1, 40), mark();
    glWindowPos2d(10, 50.6), mark();
    glWindowPos3f(30, 50, 0.5F), mark();
    glWindowPos2s(50, 50), mark();
    const GLint window[] = {70, 50, 0};
    glWindowPos3iv(window), mark();
    // Moved beyond the left edge by an empty bitmap: the position stays valid.
    glWindowPos2i(2, 60);
    glBitmap(0, 0, 0, 0, -6, 0, nullptr);
    mark();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    GLfloat readBack[4];
    glGetFloatv(GL_CURRENT_RASTER_POSITION, readBack);
    showBits(37, readBack[0]);
}

void drawZoomed(unsigned frame) {
    const auto pixels = noise(9 * 7 * 4, 100 + frame);
    const GLfloat zooms[][2] = {{1.5F, 1.5F}, {3, 2}, {-2, 1}, {2, -1.7F}, {0.6F, 0.5F}};
    GLint x = 10;
    for (const auto& zoom : zooms) {
        glPixelZoom(zoom[0], zoom[1]);
        glWindowPos2i(x + (zoom[0] < 0 ? 20 : 0), 70 + (zoom[1] < 0 ? 12 : 0));
        glDrawPixels(9, 7, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        x += 32;
    }
    glPixelZoom(1, 1);
}

void drawTransferred(unsigned frame) {
    const auto pixels = noise(16 * 12 * 4, 110 + frame);
    glPixelTransferf(GL_RED_SCALE, 0.5F);
    glPixelTransferf(GL_GREEN_BIAS, 0.3F);
    glPixelTransferf(GL_BLUE_SCALE, -1);
    glPixelTransferf(GL_BLUE_BIAS, 1);
    glWindowPos2i(10, 95);
    glDrawPixels(16, 12, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    glPixelTransferf(GL_RED_SCALE, 1);
    glPixelTransferf(GL_GREEN_BIAS, 0);
    glPixelTransferf(GL_BLUE_SCALE, 1);
    glPixelTransferf(GL_BLUE_BIAS, 0);
    GLfloat map[16];
    GLushort shorts[8];
    GLuint ints[4];
    for (int i = 0; i < 16; ++i) {
        map[i] = float((i * 7 + int(frame)) % 16) / 15.0F;
        shorts[i / 2] = GLushort(65535 - i * 4000);
        ints[i / 4] = GLuint(i) << 28;
    }
    glPixelMapfv(GL_PIXEL_MAP_R_TO_R, 16, map);
    glPixelMapusv(GL_PIXEL_MAP_G_TO_G, 8, shorts);
    glPixelMapuiv(GL_PIXEL_MAP_B_TO_B, 4, ints);
    GLuint buffer = 0; // the last but one again, from a buffer
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    glBufferData(GL_PIXEL_UNPACK_BUFFER, sizeof shorts, shorts, GL_STATIC_DRAW);
    glPixelMapusv(GL_PIXEL_MAP_G_TO_G, 4, reinterpret_cast<const GLushort*>(8));
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glDeleteBuffers(1, &buffer);
    glPixelTransferi(GL_MAP_COLOR, GL_TRUE);
    glWindowPos2i(35, 95);
    glDrawPixels(16, 12, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    glPixelTransferi(GL_MAP_COLOR, GL_FALSE);
    // Maps turn colour indices into colours.
    for (const GLenum name : {GL_PIXEL_MAP_I_TO_R, GL_PIXEL_MAP_I_TO_G, GL_PIXEL_MAP_I_TO_B}) {
        map[frame % 16] = 0.5F;
        glPixelMapfv(name, 16, map);
        map[(frame + 3) % 16] = 1;
    }
    glPixelTransferi(GL_INDEX_SHIFT, 1);
    glPixelTransferi(GL_INDEX_OFFSET, 3);
    glWindowPos2i(60, 95);
    glDrawPixels(16, 12, GL_COLOR_INDEX, GL_UNSIGNED_BYTE, pixels.data());
    glPixelTransferi(GL_INDEX_SHIFT, 0);
    glPixelTransferi(GL_INDEX_OFFSET, 0);
}

void copyPixels(Window& window, unsigned frame) {
    const int w = window.width();
    const int h = window.height();
    glWindowPos2i(w / 3, h * 2 / 3);
    glCopyPixels(3, 3, 60, 30, GL_COLOR);
    glPixelZoom(-1.5F, 1.25F);
    glWindowPos2i(w - 10, h * 2 / 3);
    glCopyPixels(int(frame) * 3, 60, 40, 30, GL_COLOR);
    glPixelZoom(1, 1);
    glPixelTransferf(GL_GREEN_SCALE, 0.4F);
    glWindowPos2i(5, h * 2 / 3);
    glCopyPixels(w / 2, 30, 50, 20, GL_COLOR);
    glPixelTransferf(GL_GREEN_SCALE, 1);
    // A copy that overlaps itself.
    glWindowPos2i(8, 8);
    glCopyPixels(3, 3, 40, 22, GL_COLOR);
}

// Draws stencil and depth pixels, and makes them visible by drawing through the tests.
void drawStencilAndDepth(unsigned frame) {
    glEnable(GL_STENCIL_TEST);
    glWindowPos2i(90, 95);
    glDrawPixels(24, 20, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, noise(480, 120 + frame).data());
    glWindowPos2i(116, 95);
    glCopyPixels(90, 95, 20, 15, GL_STENCIL);
    glStencilFunc(GL_LESS, 100, 0xff);
    glColor3f(0.9F, 0.2F, 0.9F);
    glRecti(90, 95, 140, 115);
    glDisable(GL_STENCIL_TEST);
    GLfloat depths[24 * 20];
    for (int i = 0; i < 480; ++i) {
        depths[i] = float((i * 37 + int(frame) * 11) % 97) / 96.0F;
    }
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glWindowPos2i(145, 95);
    glDrawPixels(24, 20, GL_DEPTH_COMPONENT, GL_FLOAT, depths);
    glWindowPos2i(172, 95);
    glCopyPixels(145, 95, 20, 15, GL_DEPTH);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthFunc(GL_LESS);
    glBegin(GL_QUADS);
    glColor3f(0.2F, 0.9F, 0.9F);
    glVertex3f(145, 95, -1), glVertex3f(195, 95, 1), glVertex3f(195, 115, 1), glVertex3f(145, 115, -1);
    glEnd();
    glDisable(GL_DEPTH_TEST);
}

// Blits stencil values of a draw. They must reach other tiles completely, for any mask and transfer.
void blitStencil(int width, int height) {
    const int left = width / 2 - 20;
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 0xff, ~0U);
    glStencilOp(GL_REPLACE, GL_REPLACE, GL_REPLACE);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glRecti(left, 5, left + 40, 20);
    glStencilMaskSeparate(GL_FRONT, 0xb7);
    glPixelTransferi(GL_INDEX_OFFSET, 9);
    glBlitFramebuffer(left, 5, left + 40, 20, 20, height - 30, 60, height - 15, GL_STENCIL_BUFFER_BIT, GL_NEAREST);
    glPixelTransferi(GL_INDEX_OFFSET, 0);
    glStencilMask(~0U);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glStencilFunc(GL_EQUAL, 0xff, ~0U);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    glColor3f(0.3F, 0.8F, 0.4F);
    glRecti(0, 0, width, height);
    glStencilFunc(GL_ALWAYS, 0, ~0U);
    glDisable(GL_STENCIL_TEST);
}

// Reads a texture after bitmaps. Mesa collects bitmaps and draws them when a texture is read. Before that it must have
// read the current program's sampler, which the query for samples causes.
void readBehindBitmaps(GLuint program) {
    const std::vector<GLubyte> bits(16, 0xd7);
    std::vector<GLubyte> seen(16 * 16 * 4);
    GLuint framebuffer = 0;
    GLuint texture = 0;
    GLint samples = 0;
    glGenFramebuffers(1, &framebuffer);
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 16, 16, 0, GL_RGBA, GL_UNSIGNED_BYTE, seen.data());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glColor3f(0.9F, 0.9F, 0.2F);
    glWindowPos2i(3, 3);
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "image"), 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glBitmap(8, 8, 0, 0, 3, 0, bits.data());
    glUniform1i(glGetUniformLocation(program, "image"), 3);
    glDrawBuffer(GL_COLOR_ATTACHMENT0);
    glGetIntegerv(GL_SAMPLES, &samples);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, seen.data());
    glUseProgram(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glWindowPos2i(220, 5);
    glDrawPixels(16, 16, GL_RGBA, GL_UNSIGNED_BYTE, seen.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(1, &texture);
}

// Reads a shader's results after bitmaps. Bitmaps are drawn with the program's uniforms of that time, and the read does
// not cause the draw.
void queryBehindBitmaps(GLuint tinting, GLuint writing, GLuint buffer) {
    const std::vector<GLubyte> bits(16, 0xe9);
    GLfloat written[4] = {};
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
    glUseProgram(writing);
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glUseProgram(tinting);
    const GLint tint = glGetUniformLocation(tinting, "tint");
    glUniform4f(tint, 1, 0.2F, 0.1F, 1);
    glWindowPos2i(200, 30);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glBitmap(8, 8, 0, 0, 0, 0, bits.data());
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof written, written);
    glUniform4fv(tint, 1, written);
    glFlush();
    glUseProgram(0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

} // namespace

int main(int argc, char** argv) {
    static GLuint sampling, tinting, writing, written;
    return runInGlxWindow(
        argc, argv, {},
        [](Window&) {
            const char* const fragment = R"(#version 130
                uniform usampler2D image;
                void main() { gl_FragColor = vec4(texelFetch(image, ivec2(0), 0) + 1u) * 0.5; })";
            const char* const vertex = "void main() { gl_Position = gl_Vertex; }";
            sampling = buildProgram({{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}});
            tinting = buildProgram({{GL_VERTEX_SHADER, vertex},
                                    {GL_FRAGMENT_SHADER, "uniform vec4 tint; void main() { gl_FragColor = tint; }"}});
            writing = buildProgram({{GL_COMPUTE_SHADER, R"(#version 430
                layout(local_size_x = 4) in;
                layout(std430) buffer Values { float values[]; };
                void main() { values[gl_LocalInvocationID.x] = 1.0 - 0.2 * float(gl_LocalInvocationID.x); })"}});
            glGenBuffers(1, &written);
            glBindBuffer(GL_SHADER_STORAGE_BUFFER, written);
            glBufferData(GL_SHADER_STORAGE_BUFFER, 4 * sizeof(GLfloat), nullptr, GL_DYNAMIC_COPY);
        },
        [](Window& window, int frame) {
            glClearColor(0.1F, 0.1F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
            glMatrixMode(GL_PROJECTION);
            glLoadIdentity();
            glOrtho(0, window.width(), 0, window.height(), -1, 1);
            const auto number = unsigned(frame);
            drawFormats(number);
            drawWithPixelStore(number);
            drawRasterPositions(number);
            drawZoomed(number);
            drawTransferred(number);
            drawStencilAndDepth(number);
            blitStencil(window.width(), window.height());
            copyPixels(window, number);
            readBehindBitmaps(sampling);
            queryBehindBitmaps(tinting, writing, written);
        });
}
