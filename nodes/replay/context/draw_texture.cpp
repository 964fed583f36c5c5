// Textured rectangles in window coordinates: glDrawTex*OES and glDrawTextureNV bypass the vertex pipeline and the
// viewport. The fixed-point, integer and short variants are replayed as floats. Drivers convert their arguments in the
// same way. Source: OES_draw_texture, NV_draw_texture.
#include <algorithm>

#include "gl_opcodes.hpp"
#include "nodes/replay/engine/replay.hpp"

namespace mural {

namespace {
constexpr GLfloat fromFixed(GLint value) { return static_cast<GLfloat>(value) / 65536; }
} // namespace

void Replay::drawTexture(const std::array<GLfloat, 5>& rectangle) {
    if (!gl.glDrawTexfOES) return (void)lacking(op::glDrawTexfOES);
    const auto [x, y, z, width, height] = rectangle;
    gl.glDrawTexfOES(windowX(x), windowY(y), z, width, height);
}

void Replay::glDrawTexfOES(GLfloat x, GLfloat y, GLfloat z, GLfloat width, GLfloat height) {
    drawTexture({x, y, z, width, height});
}

void Replay::glDrawTexiOES(GLint x, GLint y, GLint z, GLint width, GLint height) {
    const GLint values[] = {x, y, z, width, height};
    glDrawTexivOES(values);
}

void Replay::glDrawTexsOES(GLshort x, GLshort y, GLshort z, GLshort width, GLshort height) {
    const GLshort values[] = {x, y, z, width, height};
    glDrawTexsvOES(values);
}

void Replay::glDrawTexxOES(GLint x, GLint y, GLint z, GLint width, GLint height) {
    const GLint values[] = {x, y, z, width, height};
    glDrawTexxvOES(values);
}

void Replay::glDrawTexfvOES(const GLfloat* coords) {
    std::array<GLfloat, 5> rectangle{};
    std::copy_n(coords, rectangle.size(), rectangle.begin());
    drawTexture(rectangle);
}

void Replay::glDrawTexivOES(const GLint* coords) {
    std::array<GLfloat, 5> rectangle{};
    std::transform(coords, coords + rectangle.size(), rectangle.begin(),
                   [](GLint value) { return static_cast<GLfloat>(value); });
    drawTexture(rectangle);
}

void Replay::glDrawTexsvOES(const GLshort* coords) {
    std::array<GLfloat, 5> rectangle{};
    std::transform(coords, coords + rectangle.size(), rectangle.begin(),
                   [](GLshort value) { return static_cast<GLfloat>(value); });
    drawTexture(rectangle);
}

void Replay::glDrawTexxvOES(const GLint* coords) {
    std::array<GLfloat, 5> rectangle{};
    std::transform(coords, coords + rectangle.size(), rectangle.begin(), fromFixed);
    drawTexture(rectangle);
}

void Replay::glDrawTextureNV(GLuint texture, GLuint sampler, GLfloat x0, GLfloat y0, GLfloat x1, GLfloat y1, GLfloat z,
                             GLfloat s0, GLfloat t0, GLfloat s1, GLfloat t1) {
    if (!gl.glDrawTextureNV) return (void)lacking(op::glDrawTextureNV);
    gl.glDrawTextureNV(name(Kind::Texture, texture), name(Kind::Sampler, sampler), windowX(x0), windowY(y0),
                       windowX(x1), windowY(y1), z, s0, t0, s1, t1);
}

} // namespace mural
