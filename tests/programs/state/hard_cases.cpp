// Pictures in which rounding decides much. Each frame is one of the hard cases of tests/end_to_end/hard_cases.py, in
// its order. Near and far planes, ties, tile borders across lines and points, screen positions seen by shaders and the
// raster position, matrices without reserve of precision.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <array>
#include <cmath>
#include <vector>

using namespace programs;

namespace {

using Matrix16 = std::array<double, 16>;

GLuint screenDoor, steps, rays, sprites, texture;

void colour(Sequence& s) { glColor4f(s.unit(), s.unit(), s.unit(), 1); }
float wide(Sequence& s) { return 2 * s.unit() - 1; }

// Loads a projection. farPlane 0: infinite.
void loadProjection(double nearPlane, double farPlane, bool reversed = false) {
    Matrix16 m = {};
    m[0] = m[5] = 1;
    m[11] = -1;
    const bool infinite = farPlane <= 0;
    m[10] = infinite ? -1 : -(farPlane + nearPlane) / (farPlane - nearPlane);
    m[14] = infinite ? -2 * nearPlane : -2 * farPlane * nearPlane / (farPlane - nearPlane);
    if (reversed) {
        m[10] = -m[10];
        m[14] = -m[14];
    }
    glMatrixMode(GL_PROJECTION);
    glLoadMatrixd(m.data());
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
}

// Draws planes from near to far, many side by side at one of few depths, where the last bit of depth decides.
void planes(double nearest, double farthest, int count) {
    Sequence s(7);
    for (int i = 0; i < count; ++i) {
        const double z = -nearest * std::pow(farthest / nearest, s.next() % 16 / 15.0), x = wide(s), y = wide(s);
        glBegin(GL_TRIANGLES);
        for (int k = 0; k < 3; ++k) {
            colour(s);
            glVertex3d((x + 0.4 * wide(s)) * -z, (y + 0.4 * wide(s)) * -z, z * (1 + 1e-6 * wide(s)));
        }
        glEnd();
    }
}

// Draws two tessellations of one plane: the last bit of each pixel's depth decides which is in front.
void coplanar(GLenum function) {
    glDepthFunc(function);
    loadProjection(1, 100);
    glRotated(33, 0.3, 1, 0.1);
    glTranslated(0.2, -0.3, -7);
    for (int layer = 0; layer < 3; ++layer) {
        const int n = 3 + 4 * layer;
        Sequence s(static_cast<unsigned>(layer));
        for (int i = 0; i < n; ++i) {
            glBegin(GL_TRIANGLE_STRIP);
            for (int k = 0; k <= n; ++k)
                for (int side = 0; side < 2; ++side) {
                    colour(s);
                    glVertex3d(12. * (i + side) / n - 6, 12. * k / n - 6, 0);
                }
            glEnd();
        }
    }
}

// Draws a world 10^6 units from its origin; the program multiplies matrices itself, in floats.
void farWorld() {
    constexpr double kFar = 1e6;
    loadProjection(1, 100);
    std::array<float, 16> p{};
    glGetFloatv(GL_PROJECTION_MATRIX, p.data());
    for (int row = 0; row < 4; ++row)
        p[static_cast<size_t>(12 + row)] +=
            static_cast<float>(-kFar) * (p[static_cast<size_t>(row)] + p[static_cast<size_t>(8 + row)]);
    glMatrixMode(GL_PROJECTION);
    glLoadMatrixf(p.data());
    glMatrixMode(GL_MODELVIEW);
    Sequence s(3);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 300; ++i) {
        colour(s);
        glVertex3d(kFar + 8 * wide(s), 8 * wide(s), kFar - 5 - 5 * s.unit());
    }
    glEnd();
}

// Draws a wall of 6 m, seen from 1 cm.
void wallFromACentimetre() {
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glFrustum(-3.4 * 0.1, 2.6 * 0.1, -1.7 * 0.1, 1.3 * 0.1, 0.001, 100);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    Sequence s(5);
    for (int i = 0; i < 400; ++i) {
        const double x = -3.4 + 6 * s.unit(), y = -1.7 + 3 * s.unit(), size = 0.3 * s.unit();
        colour(s);
        glBegin(GL_TRIANGLES);
        glVertex3d(x, y, -0.01 - 1e-4 * s.unit());
        glVertex3d(x + size, y, -0.01);
        glVertex3d(x, y + size, -0.012);
        glEnd();
    }
}

void throughTheNearPlane() {
    loadProjection(0.1, 1000);
    glBegin(GL_QUADS); // ground of size 10^5
    for (const auto& [x, z] : {std::pair(-1e5, 1e5), {1e5, 1e5}, {1e5, -1e5}, {-1e5, -1e5}}) {
        glColor3d(x > 0, 0.5, z > 0);
        glVertex3d(x, -0.3, z);
    }
    glEnd();
    Sequence s(11);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 600; ++i) {
        colour(s);
        glVertex3d(3 * wide(s), 3 * wide(s), i % 3 == 0 ? 2 * s.unit() : -6 * s.unit());
    }
    glEnd();
}

void linesAndPoints(float width) {
    Sequence s(13);
    glLineWidth(width);
    for (const GLenum mode : {GL_LINES, GL_LINE_STRIP}) {
        glBegin(mode);
        for (int i = 0; i < 60; ++i) {
            colour(s);
            glVertex3f(1.2F * wide(s), 1.2F * wide(s), wide(s));
        }
        glEnd();
    }
    glPointSize(width == 1 ? 1 : 9);
    glBegin(GL_POINTS);
    for (int i = 0; i < 300; ++i) {
        colour(s);
        glVertex3f(1.05F * wide(s), 1.05F * wide(s), wide(s));
    }
    glEnd();
    glLineWidth(1);
}

void stippledLines() {
    glEnable(GL_LINE_STIPPLE);
    glLineStipple(3, 0x2d6b);
    linesAndPoints(3);
    glLineStipple(1, 0x00ff);
    linesAndPoints(1);
    glDisable(GL_LINE_STIPPLE);
}

void smoothLines() {
    glEnable(GL_LINE_SMOOTH);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDisable(GL_DEPTH_TEST);
    linesAndPoints(2.5F);
    glDisable(GL_BLEND);
    glDisable(GL_LINE_SMOOTH);
}

void quad() {
    glBegin(GL_QUADS);
    for (const auto& [x, y] : {std::pair(-1.F, -1.F), {1.F, -1.F}, {1.F, 1.F}, {-1.F, 1.F}}) {
        glTexCoord2f(4 * x, 40 * y);
        glVertex3f(x, y, 0);
    }
    glEnd();
}

// Draws mipmaps up to the horizon, and a shader with derivatives above them.
void derivatives(Window& window) {
    glEnable(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, texture);
    glColor3f(1, 1, 1);
    loadProjection(0.1, 1000);
    glPushMatrix();
    glTranslated(0, -0.4, -30);
    glRotated(-88, 1, 0, 0);
    glScaled(30, 30, 1);
    quad();
    glPopMatrix();
    glDisable(GL_TEXTURE_2D);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glMatrixMode(GL_MODELVIEW);
    glUseProgram(steps);
    glViewport(0, window.height() / 2, window.width(), (window.height() + 1) / 2);
    quad();
    glViewport(0, 0, window.width(), window.height());
    glUseProgram(0);
}

// Draws with screen positions: shader inputs, stipples, the raster position.
void places(Window& window) {
    glDisable(GL_DEPTH_TEST);
    glUseProgram(screenDoor);
    glUniform2f(glGetUniformLocation(screenDoor, "size"), static_cast<float>(window.width()),
                static_cast<float>(window.height()));
    quad();
    glUseProgram(0);
    std::array<GLubyte, 128> pattern{};
    Sequence s(17);
    for (GLubyte& b : pattern) b = s.byte();
    glPolygonStipple(pattern.data());
    glEnable(GL_POLYGON_STIPPLE);
    glColor3f(0.1F, 0.2F, 0.9F);
    glRectf(-0.9F, -0.8F, 0.1F, 0.9F);
    glDisable(GL_POLYGON_STIPPLE);
    const std::array<GLubyte, 8> bits{0xff, 0x81, 0xbd, 0xa5, 0xa5, 0xbd, 0x81, 0xff};
    std::vector<GLubyte> pixels(size_t{4} * 24 * 24);
    for (GLubyte& b : pixels) b = s.byte();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (int i = 0; i < 24; ++i) {
        glRasterPos2f(1.1F * wide(s), 1.1F * wide(s));
        if (i % 2 == 0)
            glDrawPixels(24, 24, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        else
            glBitmap(8, 8, 3.5F, -2.25F, 1, 1, bits.data());
    }
}

void raysAndSprites(Window& window) {
    for (const GLuint program : {rays, sprites}) {
        glUseProgram(program);
        glUniform2f(glGetUniformLocation(program, "size"), static_cast<float>(window.width()),
                    static_cast<float>(window.height()));
        if (program == rays) {
            quad();
            continue;
        }
        Sequence s(19);
        glBegin(GL_QUADS);
        for (int i = 0; i < 80; ++i) {
            const float x = wide(s), y = wide(s);
            colour(s);
            for (const auto& [u, v] : {std::pair(0.F, 0.F), {1.F, 0.F}, {1.F, 1.F}, {0.F, 1.F}}) {
                glTexCoord2f(u * 13, v * 7); // pixels
                glVertex3f(x, y, -0.5F);
            }
        }
        glEnd();
    }
    glUseProgram(0);
}

void fourViews(Window& window) {
    const int w = window.width() / 2 - 3, h = window.height() / 2 - 5;
    for (int i = 0; i < 4; ++i) {
        const int x = 3 + i % 2 * (w + 1), y = 5 + i / 2 * (h + 2);
        glViewport(x, y, w, h);
        glScissor(x + 2, y + 3, w > 7 ? w - 7 : 1, h > 9 ? h - 9 : 1);
        glEnable(GL_SCISSOR_TEST);
        glClearColor(0.2F * static_cast<float>(i), 0.3F, 0.5F, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        loadProjection(0.5, 50);
        planes(0.6, 40, 40);
        glDisable(GL_SCISSOR_TEST);
    }
    glViewport(0, 0, window.width(), window.height());
}

// Draws into depths of 32-bit floating point, and from there onto the whole window.
void throughATexture(Window& window) {
    GLuint names[2], frame;
    glGenTextures(2, names);
    const std::array<GLenum, 2> formats{GL_RGBA8, GL_DEPTH_COMPONENT32F}, kinds{GL_RGBA, GL_DEPTH_COMPONENT};
    for (size_t i = 0; i < 2; ++i) {
        glBindTexture(GL_TEXTURE_2D, names[i]);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(formats[i]), window.width(), window.height(), 0, kinds[i],
                     GL_FLOAT, nullptr);
    }
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, names[0], 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, names[1], 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    coplanar(GL_LEQUAL);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glEnable(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, names[0]);
    glColor3f(1, 1, 1);
    glBegin(GL_QUADS);
    for (const auto& [x, y] : {std::pair(0.F, 0.F), {1.F, 0.F}, {1.F, 1.F}, {0.F, 1.F}}) {
        glTexCoord2f(x, y);
        glVertex2f(2 * x - 1, 2 * y - 1);
    }
    glEnd();
    glDisable(GL_TEXTURE_2D);
    glDeleteFramebuffers(1, &frame);
    glDeleteTextures(2, names);
}

void flatShading() {
    glShadeModel(GL_FLAT);
    Sequence s(23);
    for (const GLenum vertex : {GL_FIRST_VERTEX_CONVENTION, GL_LAST_VERTEX_CONVENTION}) {
        glProvokingVertex(vertex);
        glBegin(GL_TRIANGLE_STRIP);
        for (int i = 0; i < 60; ++i) {
            colour(s);
            glVertex3f(1.1F * wide(s), 1.1F * wide(s), wide(s));
        }
        glEnd();
    }
    glShadeModel(GL_SMOOTH);
}

void layers(GLenum source, GLenum destination, float alpha) {
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(source, destination);
    Sequence s(29);
    for (int i = 0; i < 200; ++i) {
        const float x = wide(s), y = wide(s);
        glColor4f(s.unit(), s.unit(), s.unit(), alpha);
        glRectf(x, y, x + 0.8F * wide(s), y + 0.8F * wide(s));
    }
    glDisable(GL_BLEND);
}

void setUp() {
    const char* const vertex =
        "#version 120\nvarying vec2 place; void main() { place = gl_Vertex.xy; gl_Position = gl_Vertex; }";
    screenDoor = buildProgram(
        {{GL_VERTEX_SHADER, vertex},
         {GL_FRAGMENT_SHADER, "#version 120\nuniform vec2 size; void main() { if (mod(gl_FragCoord.x + 2.0 * "
                              "gl_FragCoord.y, 5.0) < 1.0) discard;\n"
                              "gl_FragColor = vec4(fract(gl_FragCoord.xy / 32.0), gl_FragCoord.x / size.x, 1); }"}});
    steps = buildProgram(
        {{GL_VERTEX_SHADER, vertex},
         {GL_FRAGMENT_SHADER,
          "#version 120\nvarying vec2 place; void main() { vec2 p = fract(place * place.yx * 30.0);\n"
          "gl_FragColor = vec4(fwidth(p) * 4.0, smoothstep(0.0, fwidth(place.x) * 3.0, abs(p.x - 0.5)), 1); }"}});
    rays = buildProgram(
        {{GL_VERTEX_SHADER, vertex},
         {GL_FRAGMENT_SHADER,
          "#version 120\nuniform vec2 size; void main() {\n"
          "vec3 ray = normalize(vec3(gl_FragCoord.xy / size * 2.0 - 1.0, -1.3)); float t = 1.0 / max(0.001, -ray.y);\n"
          "gl_FragColor = ray.y < 0.0 ? vec4(fract(ray.xz * t), 0.3, 1) : vec4(ray * 0.5 + 0.5, 1); }"}});
    sprites =
        buildProgram({{GL_VERTEX_SHADER, "#version 120\nuniform vec2 size; void main() { gl_Position = gl_Vertex + "
                                         "vec4(gl_MultiTexCoord0.xy * 2.0 / size, 0, 0); gl_FrontColor = gl_Color; }"},
                      {GL_FRAGMENT_SHADER, "#version 120\nvoid main() { gl_FragColor = gl_Color; }"}});
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_GENERATE_MIPMAP, GL_TRUE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MAX_ANISOTROPY_EXT, 8);
    std::vector<GLubyte> pixels;
    for (int i = 0; i < 64 * 64; ++i) {
        const bool light = (i / 8 + i / 512) % 2 != 0;
        pixels.insert(pixels.end(), {static_cast<GLubyte>(light ? 255 : i % 251),
                                     static_cast<GLubyte>(light ? 200 : 30), static_cast<GLubyte>(i / 16), 255});
    }
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 64, 64, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
}

void frame(Window& window, int number) {
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    const bool reversed = number == 6;
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(reversed ? GL_GREATER : GL_LESS);
    glClearDepth(reversed ? 0 : 1);
    glClearColor(0.1F, 0.1F, 0.15F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    switch (number) {
    case 0: return coplanar(GL_LESS);
    case 1: return coplanar(GL_LEQUAL);
    case 2: return loadProjection(1e-3, 1e7), planes(1e-2, 1e6, 400);
    case 3: return loadProjection(1e-4, 1e6), planes(2e-4, 9e5, 400);
    case 4: return loadProjection(1e-3, 0), planes(1e-2, 1e6, 400);
    case 5: return loadProjection(1e-3, 1e9), planes(1e-2, 1e8, 400); // floats cannot represent the far plane
    case 6: return loadProjection(1e-3, 1e7, true), planes(1e-2, 1e6, 400);
    case 7: return farWorld();
    case 8: return wallFromACentimetre();
    case 9: return throughTheNearPlane();
    case 10: return linesAndPoints(1);
    case 11: return linesAndPoints(7);
    case 12: return stippledLines();
    case 13: return smoothLines();
    case 14: return derivatives(window);
    case 15: return places(window);
    case 16: return raysAndSprites(window);
    case 17: return fourViews(window);
    case 18: return throughATexture(window);
    case 19: return flatShading();
    case 20: return layers(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, 0.3F);
    case 21: return layers(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, 0.03F);
    case 22: return layers(GL_SRC_ALPHA, GL_ONE, 0.1F);
    default: return planes(0.1, 1, 10);
    }
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {.samples = MURAL_SAMPLES}, [](Window&) { setUp(); },
        [](Window& window, int number) { frame(window, number); });
}
