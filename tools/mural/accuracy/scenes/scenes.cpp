#define GL_GLEXT_PROTOTYPES
#include "tools/mural/accuracy/scenes/scenes.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include "common/geometry/matrix4.hpp"
#include "tools/mural/accuracy/scenes/scene_names.hpp"

namespace mural::scenes {

namespace {

constexpr int kTriangles = 300;
constexpr int kTextureSize = 256;

// identical on every machine
double unit(std::mt19937& numbers) { return static_cast<double>(numbers()) / 4294967296.0; }

Matrix4 turned(double aroundY, double aroundZ) {
    Matrix4 y, z;
    y.m[0][0] = y.m[2][2] = std::cos(aroundY);
    y.m[0][2] = std::sin(aroundY);
    y.m[2][0] = -y.m[0][2];
    z.m[0][0] = z.m[1][1] = std::cos(aroundZ);
    z.m[1][0] = std::sin(aroundZ);
    z.m[0][1] = -z.m[1][0];
    return y * z;
}

std::array<float, 16> columnsOf(const Matrix4& m) {
    std::array<float, 16> columns{};
    for (size_t r = 0; r < 4; ++r)
        for (size_t c = 0; c < 4; ++c) columns[4 * c + r] = static_cast<float>(m.m[r][c]);
    return columns;
}

std::array<float, 16> fixedMatrix(GLenum which) {
    std::array<float, 16> values{};
    glGetFloatv(which, values.data());
    return values;
}

unsigned shaderOf(unsigned stage, const char* text) {
    const unsigned shader = glCreateShader(stage);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    return shader;
}

unsigned programOf(const char* vertex, const char* fragment) {
    const unsigned program = glCreateProgram();
    glAttachShader(program, shaderOf(GL_VERTEX_SHADER, vertex));
    glAttachShader(program, shaderOf(GL_FRAGMENT_SHADER, fragment));
    glBindAttribLocation(program, 0, "place");
    glBindAttribLocation(program, 1, "tone");
    glLinkProgram(program);
    int linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked == GL_FALSE) throw std::runtime_error("a GLSL 1.20 program does not link; the scenes need OpenGL 2.1");
    return program;
}

// Squares of 8 texels, with lines of one texel between some: detail at all scales.
unsigned chequeredTexture() {
    std::vector<unsigned char> texels;
    for (int y = 0; y < kTextureSize; ++y)
        for (int x = 0; x < kTextureSize; ++x) {
            const bool light = (x / 8 + y / 8) % 2 != 0, line = x % 32 == 0 || y % 32 == 0;
            for (const int value : {line    ? 255
                                    : light ? 230
                                            : 40,
                                    line    ? 80
                                    : light ? 220
                                            : 60,
                                    light ? 200 : 120 + x / 4})
                texels.push_back(static_cast<unsigned char>(value));
        }
    unsigned texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexParameteri(GL_TEXTURE_2D, GL_GENERATE_MIPMAP, GL_TRUE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, kTextureSize, kTextureSize, 0, GL_RGB, GL_UNSIGNED_BYTE, texels.data());
    return texture;
}

std::vector<float> triangleSoup() {
    std::mt19937 numbers(11);
    std::vector<float> values;
    for (int i = 0; i < kTriangles; ++i) {
        const double middle[3] = {unit(numbers) * 8 - 4, unit(numbers) * 6 - 3, unit(numbers) * 6 - 3};
        for (int corner = 0; corner < 3; ++corner) {
            for (const double at : middle) values.push_back(static_cast<float>(at + unit(numbers) * 1.6 - 0.8));
            for (int k = 0; k < 3; ++k) values.push_back(static_cast<float>(0.2 + 0.8 * unit(numbers)));
        }
    }
    return values;
}

} // namespace

Scenes::Scenes(int width, int height, const View& view)
    : width_(width), height_(height), view_(view), soup_(triangleSoup()) {
    int major = 0;
    if (const auto* version = reinterpret_cast<const char*>(glGetString(GL_VERSION))) major = version[0] - '0';
    if (major < 4 && (view.moveX != 0 || view.moveY != 0))
        throw std::runtime_error("fractional viewports need OpenGL 4.1");
    program_ =
        programOf("#version 120\nattribute vec3 place; attribute vec3 tone; uniform mat4 whole; varying vec3 tint;\n"
                  "void main() { tint = tone; gl_Position = whole * vec4(place, 1.0); }\n",
                  "#version 120\nvarying vec3 tint; void main() { gl_FragColor = vec4(tint, 1.0); }\n");
    texture_ = chequeredTexture();
}

// Integer coordinates if nothing is moved, as programs use them.
void Scenes::useViewport() const {
    if (view_.moveX == 0 && view_.moveY == 0)
        glViewport(0, 0, width_, height_);
    else
        glViewportIndexedf(0, view_.moveX, view_.moveY, static_cast<float>(width_), static_cast<float>(height_));
}

void Scenes::usePerspective(double nearPlane, double farPlane, int round) const {
    const double halfHeight = 0.6 * nearPlane, halfWidth = halfHeight * width_ / height_;
    // An off-centre eye looks through the same frame at its focus distance.
    const double shift = -static_cast<double>(view_.eye) * nearPlane / static_cast<double>(view_.focus);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glFrustum(shift - halfWidth, shift + halfWidth, -halfHeight, halfHeight, nearPlane, farPlane);
    glTranslatef(-view_.eye, 0, 0);
    // For Mesa an equal reloaded matrix stays the same object, with properties derived by earlier draws, which changes
    // the rounding of lit colours (docs/measurements/accuracy.md). A distinct matrix is independent of earlier frames.
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glLoadMatrixf(columnsOf(Matrix4::translation({0.2, -0.1, -7}) * turned(0.35 * round + 0.2, 0.1 * round)).data());
}

void Scenes::draw(int frame) const {
    const int scenes = static_cast<int>(kSceneNames.size()), round = frame / scenes;
    useViewport();
    glClearColor(0.1F, 0.15F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    usePerspective(1.5, 40, round);
    switch (frame % scenes) {
    case 0: drawTriangles(round); break;
    case 1: drawLighting(round); break;
    case 2: drawTextures(round); break;
    case 3: drawLines(round); break;
    case 4: drawBlending(round); break;
    default: drawDepths(round); break;
    }
}

// With a shader and one matrix, as in current programs.
void Scenes::drawTriangles(int) const {
    const auto projection = fixedMatrix(GL_PROJECTION_MATRIX), modelView = fixedMatrix(GL_MODELVIEW_MATRIX);
    std::array<float, 16> whole{};
    for (size_t c = 0; c < 4; ++c)
        for (size_t r = 0; r < 4; ++r)
            for (size_t i = 0; i < 4; ++i) whole[4 * c + r] += projection[4 * i + r] * modelView[4 * c + i];
    glUseProgram(program_);
    glUniformMatrix4fv(glGetUniformLocation(program_, "whole"), 1, GL_FALSE, whole.data());
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 24, soup_.data());
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, 24, soup_.data() + 3);
    glEnableVertexAttribArray(0);
    glEnableVertexAttribArray(1);
    glDrawArrays(GL_TRIANGLES, 0, 3 * kTriangles);
    glDisableVertexAttribArray(0);
    glDisableVertexAttribArray(1);
    glUseProgram(0);
}

// A ring of small lit faces, with fixed function.
void Scenes::drawLighting(int) const {
    const float light[] = {3, 4, 6, 1}, shine[] = {1, 1, 1, 1}, tone[] = {0.8F, 0.4F, 0.2F, 1};
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glLightfv(GL_LIGHT0, GL_POSITION, light);
    glMaterialfv(GL_FRONT_AND_BACK, GL_SPECULAR, shine);
    glMaterialfv(GL_FRONT_AND_BACK, GL_AMBIENT_AND_DIFFUSE, tone);
    glMaterialf(GL_FRONT_AND_BACK, GL_SHININESS, 30);
    glRotatef(50, 1, 0, 0);
    glScalef(1.3F, 1.3F, 1.3F);
    constexpr int kAround = 64, kAcross = 24;
    constexpr double kTurn = 6.283185307179586;
    for (int i = 0; i < kAround; ++i) {
        glBegin(GL_TRIANGLE_STRIP);
        for (int j = 0; j <= kAcross; ++j)
            for (int k = 0; k < 2; ++k) {
                const double a = kTurn * (i + k) / kAround, b = kTurn * j / kAcross;
                glNormal3d(std::cos(a) * std::cos(b), std::sin(b), std::sin(a) * std::cos(b));
                glVertex3d(std::cos(a) * (2.2 + 0.9 * std::cos(b)), 0.9 * std::sin(b),
                           std::sin(a) * (2.2 + 0.9 * std::cos(b)));
            }
        glEnd();
    }
    glDisable(GL_LIGHTING);
    glDisable(GL_LIGHT0);
}

// A plane to the horizon, which uses all mipmap levels.
void Scenes::drawTextures(int) const {
    glEnable(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glColor3f(1, 1, 1);
    glBegin(GL_QUADS);
    for (const auto& [x, z] : {std::pair(-30, 8), std::pair(30, 8), std::pair(30, -30), std::pair(-30, -30)}) {
        glTexCoord2d(x / 3.0, z / 3.0);
        glVertex3d(x, -1.4, z);
    }
    glEnd();
    glDisable(GL_TEXTURE_2D);
}

// Lines of one and five pixels, stippled and smooth lines, and points, across every tile border.
void Scenes::drawLines(int) const {
    std::mt19937 numbers(12);
    const auto corner = [&] {
        glColor3d(0.3 + 0.7 * unit(numbers), 0.3 + 0.7 * unit(numbers), 0.3 + 0.7 * unit(numbers));
        const double x = unit(numbers) * 9 - 4.5, y = unit(numbers) * 6 - 3, z = unit(numbers) * 4 - 2;
        glVertex3d(x, y, z);
    };
    for (int kind = 0; kind < 4; ++kind) {
        glLineWidth(kind == 1 ? 5 : 1);
        if (kind == 2) {
            glEnable(GL_LINE_STIPPLE);
            glLineStipple(3, 0x3f07);
        }
        if (kind == 3) {
            glEnable(GL_LINE_SMOOTH);
            glEnable(GL_BLEND);
            glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        }
        glBegin(kind == 2 ? GL_LINE_STRIP : GL_LINES);
        for (int i = 0; i < 40; ++i) corner();
        glEnd();
        glDisable(GL_LINE_STIPPLE);
        glDisable(GL_LINE_SMOOTH);
        glDisable(GL_BLEND);
    }
    glLineWidth(1);
    for (const int size : {1, 9}) {
        glPointSize(static_cast<float>(size));
        glBegin(GL_POINTS);
        for (int i = 0; i < 60; ++i) corner();
        glEnd();
    }
    glPointSize(1);
}

// Ordered translucent triangles. 0.35 of 255 is between two bytes; 0.3 would be 76.5, which rounds either way by the
// last bit of an interpolation.
void Scenes::drawBlending(int) const {
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glBegin(GL_TRIANGLES);
    for (size_t i = 0; i < soup_.size(); i += 6) {
        glColor4f(soup_[i + 3], soup_[i + 4], soup_[i + 5], 0.35F);
        glVertex3f(soup_[i], soup_[i + 1], soup_[i + 2]);
    }
    glEnd();
    glDisable(GL_BLEND);
}

// Nearly coplanar planes, with a near plane at 10^-3 and a far plane at 10^7: depths that differ in the last bit, or
// are equal.
void Scenes::drawDepths(int round) const {
    usePerspective(0.001, 1e7, round);
    for (int layer = 0; layer < 4; ++layer) {
        glDepthFunc(layer % 2 ? GL_LEQUAL : GL_LESS);
        glBegin(GL_TRIANGLES);
        for (size_t i = 0; i < soup_.size(); i += 18 * 8)
            for (size_t corner = i; corner < i + 18; corner += 6) {
                const double z = static_cast<double>(soup_[corner + 2]) + 1e-5 * layer;
                glColor3d(0.25 * layer + 0.2, static_cast<double>(soup_[corner + 4]), 1 - 0.25 * layer);
                glVertex3d(static_cast<double>(soup_[corner]) * 2, static_cast<double>(soup_[corner + 1]) * 2, z);
            }
        glEnd();
    }
}

} // namespace mural::scenes
