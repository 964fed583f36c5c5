// Textures in the style of OpenGL 1 and 2 programs: 1D, 2D, 3D, cube, rectangle; odd pixel store; pixel buffer uploads;
// sub-images; generated and uploaded mipmaps; copies from the window; reads; residency.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

GLuint names[16];
int cellIndex;

std::vector<GLubyte> noise(std::size_t count, unsigned seed) {
    std::vector<GLubyte> bytes(count);
    Sequence numbers(seed);
    for (GLubyte& value : bytes) {
        value = numbers.byte();
    }
    return bytes;
}

void use(GLenum target, int name, GLint filter) {
    glBindTexture(target, names[name]);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

// Draws a quad of 36×28 units in the next cell; `far` is the largest texture coordinate.
void drawQuad(GLenum target, float far, float depth = 0.3F) {
    const float x = 4.0F + float(cellIndex % 6) * 41;
    const float y = 4.0F + float(cellIndex / 6) * 31;
    ++cellIndex;
    glEnable(target);
    glBegin(GL_QUADS);
    glTexCoord3f(0, 0, depth), glVertex2f(x, y);
    glTexCoord3f(far, 0, depth), glVertex2f(x + 36, y);
    glTexCoord3f(far, far, depth), glVertex2f(x + 36, y + 28);
    glTexCoord3f(0, far, depth), glVertex2f(x, y + 28);
    glEnd();
    glDisable(target);
}

void drawOneAndTwoDimensions(unsigned frame) {
    use(GL_TEXTURE_1D, 0, GL_NEAREST);
    glTexImage1D(GL_TEXTURE_1D, 0, GL_RGB8, 16, 0, GL_RGB, GL_UNSIGNED_BYTE, noise(48, 1 + frame).data());
    glTexSubImage1D(GL_TEXTURE_1D, 0, 3, 5, GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4, noise(10, 2).data());
    drawQuad(GL_TEXTURE_1D, 1);
    use(GL_TEXTURE_2D, 1, GL_NEAREST);
    // Rows of 13 pixels of 3 bytes with alignment 2, from the middle of a larger picture.
    glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 13);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, 2);
    glPixelStorei(GL_UNPACK_SKIP_ROWS, 3);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, 8, 8, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 noise(13 * 3 * 12 + 40, 3 + frame).data());
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, 0);
    glPixelStorei(GL_UNPACK_SKIP_ROWS, 0);
    // Without a row length: Mesa 22 swaps only the beginning of a larger picture.
    glPixelStorei(GL_UNPACK_SWAP_BYTES, GL_TRUE);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 1, 2, 3, 4, GL_RGBA, GL_UNSIGNED_SHORT, noise(1000, 4).data());
    glPixelStorei(GL_UNPACK_SWAP_BYTES, GL_FALSE);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    drawQuad(GL_TEXTURE_2D, 1.5F);
}

// Uploads one small sub-image in each client format and type, one after the other in a row of texels.
void drawFormats(unsigned frame) {
    const GLenum kinds[][2] = {{GL_RGBA, GL_UNSIGNED_BYTE},
                               {GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV},
                               {GL_BGR, GL_UNSIGNED_BYTE},
                               {GL_RGB, GL_UNSIGNED_SHORT_5_6_5},
                               {GL_RGB, GL_UNSIGNED_BYTE_3_3_2},
                               {GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1},
                               {GL_BGRA, GL_UNSIGNED_SHORT_1_5_5_5_REV},
                               {GL_RGBA, GL_UNSIGNED_INT_10_10_10_2},
                               {GL_LUMINANCE, GL_UNSIGNED_BYTE},
                               {GL_LUMINANCE_ALPHA, GL_SHORT},
                               {GL_RED, GL_UNSIGNED_INT},
                               {GL_GREEN, GL_BYTE},
                               {GL_BLUE, GL_UNSIGNED_SHORT},
                               {GL_RGB, GL_INT},
                               {GL_ALPHA, GL_UNSIGNED_BYTE},
                               {GL_RG, GL_UNSIGNED_BYTE}};
    use(GL_TEXTURE_2D, 2, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 16, 16, 0, GL_RGBA, GL_UNSIGNED_BYTE, noise(1024, 5).data());
    int index = 0;
    for (const auto& kind : kinds) {
        glTexSubImage2D(GL_TEXTURE_2D, 0, (index % 4) * 4, (index / 4) * 4, 3, 3, kind[0], kind[1],
                        noise(256, unsigned(index) + frame).data());
        ++index;
    }
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    drawQuad(GL_TEXTURE_2D, 1);
    const GLfloat halfs[] = {0.1F, 0.5F, 0.9F, 0.3F * float(frame % 3), 1, 0.2F};
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 2, 1, GL_RGB, GL_FLOAT, halfs);
    drawQuad(GL_TEXTURE_2D, 0.5F);
}

void drawVolumeCubeAndRectangle(unsigned frame) {
    use(GL_TEXTURE_3D, 3, GL_LINEAR);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 5);
    glPixelStorei(GL_UNPACK_SKIP_IMAGES, 1);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGB8, 4, 4, 4, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 noise(4 * 5 * 6 * 3, 6 + frame).data());
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 0);
    glPixelStorei(GL_UNPACK_SKIP_IMAGES, 0);
    glTexSubImage3D(GL_TEXTURE_3D, 0, 1, 1, 1, 2, 2, 2, GL_RGB, GL_UNSIGNED_BYTE, noise(24, 7).data());
    drawQuad(GL_TEXTURE_3D, 1, 0.3F + 0.1F * float(frame));
    use(GL_TEXTURE_CUBE_MAP, 4, GL_NEAREST);
    for (unsigned face = 0; face < 6; ++face) {
        glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGB8, 4, 4, 0, GL_RGB, GL_UNSIGNED_BYTE,
                     noise(48, 10 + face + frame).data());
    }
    drawQuad(GL_TEXTURE_CUBE_MAP, 1, 0.2F);
    drawQuad(GL_TEXTURE_CUBE_MAP, -1, -0.7F);
    use(GL_TEXTURE_RECTANGLE, 5, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_RECTANGLE, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexImage2D(GL_TEXTURE_RECTANGLE, 0, GL_RGB8, 7, 5, 0, GL_RGB, GL_UNSIGNED_BYTE, noise(105, 20 + frame).data());
    drawQuad(GL_TEXTURE_RECTANGLE, 6);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void drawMipmaps(unsigned frame) {
    use(GL_TEXTURE_2D, 6, GL_LINEAR_MIPMAP_LINEAR);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 64, 64, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 noise(64 * 64 * 4, 30 + frame).data());
    glGenerateMipmap(GL_TEXTURE_2D);
    drawQuad(GL_TEXTURE_2D, 2);
    use(GL_TEXTURE_2D, 7, GL_NEAREST_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_GENERATE_MIPMAP, GL_TRUE);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 32, 32, 0, GL_RGBA, GL_UNSIGNED_BYTE, noise(4096, 31).data());
    glTexSubImage2D(GL_TEXTURE_2D, 0, 3, 3, 20, 20, GL_RGBA, GL_UNSIGNED_BYTE, noise(1600, 32 + frame).data());
    glTexEnvf(GL_TEXTURE_FILTER_CONTROL, GL_TEXTURE_LOD_BIAS, 0.5F * float(frame % 4));
    drawQuad(GL_TEXTURE_2D, 3);
    glTexEnvf(GL_TEXTURE_FILTER_CONTROL, GL_TEXTURE_LOD_BIAS, 0);
    // All levels uploaded, only levels 1 to 3 used.
    use(GL_TEXTURE_2D, 8, GL_NEAREST_MIPMAP_LINEAR);
    for (int level = 0; level < 5; ++level) {
        const int size = 16 >> level;
        glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA, size, size, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     noise(std::size_t(size * size * 4), 40 + unsigned(level) + frame).data());
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, 1);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 3);
    drawQuad(GL_TEXTURE_2D, 4);
}

void drawFromPixelBuffer(unsigned frame) {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    glBufferData(GL_PIXEL_UNPACK_BUFFER, 2048, noise(2048, 50 + frame).data(), GL_STREAM_DRAW);
    use(GL_TEXTURE_2D, 9, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 8, 8, 0, GL_RGBA, GL_UNSIGNED_BYTE, reinterpret_cast<void*>(256));
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 9);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 2, 2, 5, 5, GL_BGRA, GL_UNSIGNED_BYTE, reinterpret_cast<void*>(40));
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    auto* mapped = static_cast<GLubyte*>(glMapBuffer(GL_PIXEL_UNPACK_BUFFER, GL_WRITE_ONLY));
    for (int i = 0; i < 64; ++i) {
        mapped[i] = GLubyte(i * 4);
    }
    glUnmapBuffer(GL_PIXEL_UNPACK_BUFFER);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 4, 2, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glDeleteBuffers(1, &buffer);
    drawQuad(GL_TEXTURE_2D, 1);
}

// Copies the lower part of the window, which is drawn by now, into textures.
void drawCopies(Window& window, unsigned frame) {
    const int w = window.width();
    const int h = window.height();
    use(GL_TEXTURE_2D, 10, GL_NEAREST);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, w / 10 + int(frame), h / 20, 64, 64, 0);
    drawQuad(GL_TEXTURE_2D, 1);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 10, 20, w / 2, h / 3, 30, 25);
    drawQuad(GL_TEXTURE_2D, 1);
    use(GL_TEXTURE_1D, 11, GL_NEAREST);
    glCopyTexImage1D(GL_TEXTURE_1D, 0, GL_RGBA, w / 3, h / 4, 64, 0);
    glCopyTexSubImage1D(GL_TEXTURE_1D, 0, 8, w / 8, h / 8, 16);
    drawQuad(GL_TEXTURE_1D, 1);
    glBindTexture(GL_TEXTURE_3D, names[3]);
    glCopyTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 1, w / 4, h / 5, 4, 4);
    drawQuad(GL_TEXTURE_3D, 1, 0.4F);
    // Depth of the window as a texture with comparison.
    use(GL_TEXTURE_2D, 12, GL_NEAREST);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT, w / 10, h / 10, 32, 32, 0);
    drawQuad(GL_TEXTURE_2D, 1);
}

void drawReadBack() {
    GLubyte texels[64 * 64 * 4] = {};
    glBindTexture(GL_TEXTURE_2D, names[10]);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_BGR, GL_UNSIGNED_BYTE, texels);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    use(GL_TEXTURE_2D, 13, GL_LINEAR);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, 64, 64, 0, GL_RGB, GL_UNSIGNED_BYTE, texels);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    drawQuad(GL_TEXTURE_2D, 1);
    GLint width = 0;
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
    showBits(36, std::uint32_t(width));
    GLboolean resident[2] = {};
    glAreTexturesResident(2, names, resident);
    const GLfloat priorities[2] = {0.5F, 1};
    glPrioritizeTextures(2, names, priorities);
    showBits(37, glIsTexture(names[13]) == GL_TRUE ? 1U : 0U);
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {}, [](Window&) { glGenTextures(16, names); },
        [](Window& window, int frame) {
            glClearColor(0.2F, 0.1F, 0.1F, 1);
            glClearDepth(0.6);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            glMatrixMode(GL_PROJECTION);
            glLoadIdentity();
            glOrtho(0, 250, 0, 190, -1, 1);
            glMatrixMode(GL_MODELVIEW);
            glLoadIdentity();
            glColor3f(1, 1, 1);
            glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, frame % 2 == 0 ? GL_MODULATE : GL_DECAL);
            cellIndex = 0;
            const auto number = unsigned(frame);
            drawOneAndTwoDimensions(number);
            drawFormats(number);
            drawVolumeCubeAndRectangle(number);
            drawMipmaps(number);
            drawFromPixelBuffer(number);
            drawCopies(window, number);
            drawReadBack();
        });
}
