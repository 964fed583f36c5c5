#include "tests/gl/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <set>

namespace mural::test {
namespace {

// Equal numbers on all platforms, unlike the standard library's.
class Random {
public:
    float unit() {
        state_ = state_ * 1664525u + 1013904223u;
        return static_cast<float>(state_ >> 8) / 16777216.0f;
    }
    float between(float low, float high) { return low + (high - low) * unit(); }

private:
    uint32_t state_ = 12345;
};

struct Vertex {
    float x, y, z, r, g, b, a, s, t;
};

std::vector<Vertex> triangles(Random& random, int count, float size, float alpha) {
    std::vector<Vertex> vertices;
    for (int i = 0; i < count; i++) {
        const float x = random.between(-1, 1), y = random.between(-1, 1), z = random.between(-0.9f, 0.9f);
        for (int corner = 0; corner < 3; corner++)
            vertices.push_back({x + random.between(-size, size), y + random.between(-size, size),
                                z + random.between(-0.1f, 0.1f), random.unit(), random.unit(), random.unit(), alpha,
                                random.between(0, 3), random.between(0, 3)});
    }
    return vertices;
}

std::vector<uint8_t> noise(Random& random, size_t count) {
    std::vector<uint8_t> bytes(count);
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random.between(0, 255.99f));
    return bytes;
}

void setUp(const GlFunctions& gl, const gl::SurfaceConfig& config) {
    gl.viewport(0, 0, config.width, config.height);
    gl.clearColor(0.2f, 0.3f, 0.45f, 0.6f);
    gl.clearStencil(0);
    gl.clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    gl.enable(GL_DEPTH_TEST);
    gl.enable(GL_STENCIL_TEST);
    gl.stencilFunc(GL_ALWAYS, 1, 0xff);
    gl.stencilOp(GL_KEEP, GL_INCR, GL_REPLACE);
}

GLuint makeTexture(const GlFunctions& gl, bool mipmaps) {
    Random random;
    const std::vector<uint8_t> texels = noise(random, 64 * 64 * 4);
    GLuint texture = 0;
    gl.genTextures(1, &texture);
    gl.bindTexture(GL_TEXTURE_2D, texture);
    gl.texParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, mipmaps ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
    gl.texImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 64, 64, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    if (mipmaps) gl.generateMipmap(GL_TEXTURE_2D);
    return texture;
}

// Blending reads the framebuffer's alpha: 1 if there is none.
void blendWithTarget(const GlFunctions& gl) {
    gl.enable(GL_BLEND);
    gl.blendFunc(GL_DST_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
}

void immediate(const GlFunctions& gl, GLenum mode, const std::vector<Vertex>& vertices) {
    gl.begin(mode);
    for (const Vertex& v : vertices) {
        gl.color4f(v.r, v.g, v.b, v.a);
        gl.texCoord2f(v.s, v.t);
        gl.vertex3f(v.x, v.y, v.z);
    }
    gl.end();
}

void drawLinesAndPoints(const GlFunctions& gl, Random& random) {
    gl.enable(GL_LINE_STIPPLE);
    gl.lineStipple(2, 0x3c5f);
    gl.lineWidth(3);
    immediate(gl, GL_LINE_STRIP, triangles(random, 10, 0.8f, 0.8f));
    gl.disable(GL_LINE_STIPPLE);
    gl.lineWidth(1);
    immediate(gl, GL_LINES, triangles(random, 10, 0.5f, 1));
    gl.enable(GL_LINE_SMOOTH);
    gl.lineWidth(2.5f);
    immediate(gl, GL_LINE_LOOP, triangles(random, 4, 0.5f, 0.7f));
    gl.disable(GL_LINE_SMOOTH);
    gl.pointSize(7);
    immediate(gl, GL_POINTS, triangles(random, 20, 0.2f, 0.9f));
}

// Bitmap text: 8 rows of bits at a raster position.
void drawText(const GlFunctions& gl, Random& random) {
    gl.disable(GL_TEXTURE_2D);
    gl.pixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.color4f(1, 1, 0.5f, 1);
    for (int line = 0; line < 4; line++) {
        gl.rasterPos2f(-0.9f, 0.7f - 0.31f * static_cast<float>(line));
        for (int letter = 0; letter < 12; letter++) gl.bitmap(8, 8, 0, 0, 9, 0, noise(random, 8).data());
    }
    gl.rasterPos2f(0.2f, -0.6f);
    gl.drawPixels(20, 11, GL_RGBA, GL_UNSIGNED_BYTE, noise(random, 20 * 11 * 4).data());
}

void accumulate(const GlFunctions& gl) {
    gl.accum(GL_LOAD, 0.6f);
    gl.accum(GL_ACCUM, 0.3f);
    gl.accum(GL_RETURN, 1);
}

void drawFixedFunction(const GlFunctions& gl, const gl::SurfaceConfig& config) {
    Random random;
    gl.matrixMode(GL_PROJECTION);
    gl.loadIdentity();
    gl.matrixMode(GL_MODELVIEW);
    gl.loadIdentity();
    setUp(gl, config);
    immediate(gl, GL_TRIANGLES, triangles(random, 40, 0.5f, 0.5f));
    gl.enable(GL_POLYGON_STIPPLE);
    gl.polygonStipple(noise(random, 128).data());
    immediate(gl, GL_TRIANGLES, triangles(random, 8, 0.9f, 1));
    gl.disable(GL_POLYGON_STIPPLE);
    makeTexture(gl, true);
    gl.enable(GL_TEXTURE_2D);
    blendWithTarget(gl);
    immediate(gl, GL_TRIANGLES, triangles(random, 12, 0.7f, 0.6f));
    drawLinesAndPoints(gl, random);
    drawText(gl, random);
    gl.disable(GL_BLEND);
    gl.disable(GL_DEPTH_TEST);
    if (config.accum > 0) accumulate(gl);
}

void drawEs1(const GlFunctions& gl, const gl::SurfaceConfig& config) {
    Random random;
    setUp(gl, config);
    gl.enableClientState(GL_VERTEX_ARRAY);
    gl.enableClientState(GL_COLOR_ARRAY);
    gl.enableClientState(GL_TEXTURE_COORD_ARRAY);
    auto arrays = [&](GLenum mode, const std::vector<Vertex>& vertices) {
        gl.vertexPointer(3, GL_FLOAT, sizeof(Vertex), &vertices[0].x);
        gl.colorPointer(4, GL_FLOAT, sizeof(Vertex), &vertices[0].r);
        gl.texCoordPointer(2, GL_FLOAT, sizeof(Vertex), &vertices[0].s);
        gl.drawArrays(mode, 0, static_cast<GLsizei>(vertices.size()));
    };
    arrays(GL_TRIANGLES, triangles(random, 40, 0.5f, 0.5f));
    makeTexture(gl, false);
    gl.enable(GL_TEXTURE_2D);
    blendWithTarget(gl);
    arrays(GL_TRIANGLES, triangles(random, 12, 0.7f, 0.6f));
    gl.lineWidth(2);
    arrays(GL_LINES, triangles(random, 10, 0.5f, 1));
    gl.pointSize(5);
    arrays(GL_POINTS, triangles(random, 10, 0.5f, 1));
}

// GLSL 1.00 works in ES 2 and 3; core profiles use equal shaders in 1.50.
std::array<std::string, 2> shaders(bool core) {
    const std::string in = core ? "in" : "attribute", to = core ? "out" : "varying", from = core ? "in" : "varying";
    const std::string sample = core ? "texture" : "texture2D", color = core ? "result" : "gl_FragColor";
    const std::string vertex = std::string(core ? "#version 150\n" : "#version 100\n") + in + " vec3 position; " + in +
                               " vec4 color; " + in + " vec2 place; " + to + " vec4 shade; " + to +
                               " vec2 at; void main() { shade = color; at = place; gl_PointSize = 6.0;"
                               " gl_Position = vec4(position, 1.0); }";
    const std::string fragment =
        std::string(core ? "#version 150\nout vec4 result; " : "#version 100\nprecision highp float; ") + from +
        " vec4 shade; " + from + " vec2 at; uniform sampler2D image; void main() { " + color + " = shade * (0.3 + " +
        sample +
        "(image, at))"
        " + vec4(fract(gl_FragCoord.xy / 37.0) * 0.2, gl_FragCoord.z * 0.2, 0.0); }";
    return {vertex, fragment};
}

std::string useProgram(const GlFunctions& gl, bool core) {
    const GLuint program = gl.createProgram();
    const auto sources = shaders(core);
    char log[512] = "";
    for (size_t i = 0; i < 2; i++) {
        const GLuint shader = gl.createShader(i == 0 ? GL_VERTEX_SHADER : GL_FRAGMENT_SHADER);
        const char* source = sources[i].c_str();
        gl.shaderSource(shader, 1, &source, nullptr);
        gl.compileShader(shader);
        gl.getShaderInfoLog(shader, sizeof log, nullptr, log);
        gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, "position");
    gl.bindAttribLocation(program, 1, "color");
    gl.bindAttribLocation(program, 2, "place");
    gl.linkProgram(program);
    GLint linked = 0;
    gl.getProgramiv(program, GL_LINK_STATUS, &linked);
    gl.useProgram(program);
    return linked ? "" : std::string("shader: ") + log;
}

std::string drawShaded(const GlFunctions& gl, const gl::SurfaceConfig& config, bool core) {
    Random random;
    setUp(gl, config);
    if (core) {
        GLuint array = 0;
        gl.genVertexArrays(1, &array);
        gl.bindVertexArray(array);
    }
    const std::string failed = useProgram(gl, core);
    makeTexture(gl, true);
    GLuint buffer = 0;
    gl.genBuffers(1, &buffer);
    gl.bindBuffer(GL_ARRAY_BUFFER, buffer);
    const std::array<GLint, 3> sizes{3, 4, 2};
    size_t offset = 0;
    for (GLuint i = 0; i < sizes.size(); i++) {
        gl.vertexAttribPointer(i, sizes[i], GL_FLOAT, GL_FALSE, sizeof(Vertex), reinterpret_cast<const void*>(offset));
        gl.enableVertexAttribArray(i);
        offset += sizeof(float) * static_cast<size_t>(sizes[i]);
    }
    auto draw = [&](GLenum mode, const std::vector<Vertex>& vertices) {
        gl.bufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(),
                      GL_STATIC_DRAW);
        gl.drawArrays(mode, 0, static_cast<GLsizei>(vertices.size()));
    };
    draw(GL_TRIANGLES, triangles(random, 40, 0.5f, 0.5f));
    blendWithTarget(gl);
    draw(GL_TRIANGLES, triangles(random, 12, 0.7f, 0.6f));
    draw(GL_LINE_STRIP, triangles(random, 8, 0.7f, 0.6f));
    draw(GL_POINTS, triangles(random, 8, 0.7f, 0.6f));
    return failed;
}

// Reads through a framebuffer object with one sample, as a swap resolves into the window.
std::vector<uint8_t> readResolved(const GlFunctions& gl, const gl::SurfaceConfig& config) {
    std::vector<uint8_t> color(static_cast<size_t>(config.width) * static_cast<size_t>(config.height) * 4);
    GLuint renderbuffer = 0, framebuffer = 0;
    gl.genRenderbuffers(1, &renderbuffer);
    gl.bindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
    gl.renderbufferStorage(GL_RENDERBUFFER, config.alpha ? GL_RGBA8 : GL_RGB8, config.width, config.height);
    gl.genFramebuffers(1, &framebuffer);
    gl.bindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    gl.framebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffer);
    gl.blitFramebuffer(0, 0, config.width, config.height, 0, 0, config.width, config.height, GL_COLOR_BUFFER_BIT,
                       GL_NEAREST);
    gl.bindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl.readPixels(0, 0, config.width, config.height, GL_RGBA, GL_UNSIGNED_BYTE, color.data());
    gl.bindFramebuffer(GL_FRAMEBUFFER, 0);
    gl.deleteFramebuffers(1, &framebuffer);
    gl.deleteRenderbuffers(1, &renderbuffer);
    return color;
}

template <class Value>
std::string planeDifference(const char* name, const std::vector<Value>& expected, const std::vector<Value>& actual,
                            size_t perPixel, int width) {
    if (expected.size() != actual.size()) return std::string(name) + " has another size; ";
    std::set<size_t> pixels;
    double largest = 0;
    for (size_t i = 0; i < expected.size(); i++)
        if (expected[i] != actual[i]) {
            pixels.insert(i / perPixel);
            largest = std::max(largest, std::abs(static_cast<double>(expected[i]) - static_cast<double>(actual[i])));
        }
    if (pixels.empty()) return "";
    const size_t first = *pixels.begin(), w = static_cast<size_t>(width);
    return std::string(name) + ": " + std::to_string(pixels.size()) + " pixels differ, by at most " +
           std::to_string(largest) + ", first at " + std::to_string(first % w) + "," + std::to_string(first / w) + "; ";
}

} // namespace

Picture drawScene(const FindProc& find, const gl::ContextConfig& context, const gl::SurfaceConfig& config,
                  bool maskAlpha) {
    const GlFunctions gl(find);
    if (maskAlpha) gl.colorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
    std::string failed;
    if (context.api == gl::Api::Es1)
        drawEs1(gl, config);
    else if (context.api == gl::Api::Es2 || context.core)
        failed = drawShaded(gl, config, context.core);
    else
        drawFixedFunction(gl, config);
    Picture picture = readPicture(gl, context, config);
    if (!failed.empty()) picture.error = failed;
    return picture;
}

Picture readPicture(const GlFunctions& gl, const gl::ContextConfig& context, const gl::SurfaceConfig& config) {
    Picture picture;
    picture.width = config.width;
    picture.height = config.height;
    const size_t pixels = static_cast<size_t>(config.width) * static_cast<size_t>(config.height);
    picture.readBack.resize(pixels * 4);
    gl.pixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.readPixels(0, 0, config.width, config.height, GL_RGBA, GL_UNSIGNED_BYTE, picture.readBack.data());
    picture.color = config.samples > 1 ? readResolved(gl, config) : picture.readBack;
    if (context.api == gl::Api::Desktop && config.depth) {
        picture.depth.resize(pixels);
        gl.readPixels(0, 0, config.width, config.height, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, picture.depth.data());
    }
    if (context.api == gl::Api::Desktop && config.stencil) {
        picture.stencil.resize(pixels);
        gl.readPixels(0, 0, config.width, config.height, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, picture.stencil.data());
    }
    if (const GLenum error = gl.getError(); error != GL_NO_ERROR) picture.error = "GL error " + std::to_string(error);
    return picture;
}

std::string difference(const Picture& expected, const Picture& actual) {
    if (!expected.error.empty() || !actual.error.empty())
        return "expected: " + expected.error + ", actual: " + actual.error;
    return planeDifference("colour", expected.color, actual.color, 4, expected.width) +
           planeDifference("glReadPixels", expected.readBack, actual.readBack, 4, expected.width) +
           planeDifference("depth", expected.depth, actual.depth, 1, expected.width) +
           planeDifference("stencil", expected.stencil, actual.stencil, 1, expected.width);
}

size_t countColors(const Picture& picture) {
    std::set<uint32_t> colors;
    for (size_t i = 0; i + 3 < picture.color.size(); i += 4)
        colors.insert(static_cast<uint32_t>(picture.color[i]) << 16 | static_cast<uint32_t>(picture.color[i + 1]) << 8 |
                      picture.color[i + 2]);
    return colors.size();
}

} // namespace mural::test
