// Programs from SPIR-V modules: specialised twice from one module, with uniforms, blocks, samplers and gl_FragCoord; a
// compute module that writes point positions; a fragment module that counts.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/support/spirv_modules.hpp"

using namespace programs;

namespace {

GLuint plain, patterned, places, counting;
GLuint vertexArray, corners, block, points, counter, image;

struct Module {
    GLenum type;
    const std::uint32_t* words;
    std::size_t bytes;
    GLuint index = 0, value = 0; // index and value of a specialisation constant
    bool specialized = false;
};

GLuint build(std::initializer_list<Module> modules) {
    const GLuint program = glCreateProgram();
    for (const Module& m : modules) {
        const GLuint shader = glCreateShader(m.type);
        glShaderBinary(1, &shader, GL_SHADER_BINARY_FORMAT_SPIR_V, m.words, GLsizei(m.bytes));
        glSpecializeShader(shader, "main", m.specialized ? 1 : 0, &m.index, &m.value);
        GLint done = 0;
        glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
        if (done == 0) {
            fail("a module is not specialised");
        }
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked == 0) {
        fail("modules do not link");
    }
    return program;
}

void makePrograms() {
    const Module vertex = {GL_VERTEX_SHADER, modules::kVertex, sizeof modules::kVertex};
    const Module smaller = {GL_VERTEX_SHADER, modules::kVertex, sizeof modules::kVertex, 3, 0x3E99999A /* 0.3 */, true};
    const Module fragment = {GL_FRAGMENT_SHADER, modules::kFragment, sizeof modules::kFragment};
    const Module byPlace = {GL_FRAGMENT_SHADER, modules::kFragment, sizeof modules::kFragment, 0, 1, true};
    plain = build({vertex, fragment});
    patterned = build({smaller, byPlace});
    places = build({{GL_COMPUTE_SHADER, modules::kCompute, sizeof modules::kCompute}});
    counting = build({smaller, {GL_FRAGMENT_SHADER, modules::kCounting, sizeof modules::kCounting}});
}

void setUp() {
    makePrograms();
    const GLfloat square[] = {-1, -1, 1, -1, -1, 1, 1, 1};
    const GLfloat scale[] = {0.9F, 0.8F, 1, 1};
    GLubyte texels[64];
    Sequence numbers(4);
    for (GLubyte& t : texels) {
        t = numbers.byte();
    }
    glCreateVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    glEnableVertexAttribArray(0);
    GLuint buffers[4];
    glCreateBuffers(4, buffers);
    corners = buffers[0], block = buffers[1], points = buffers[2], counter = buffers[3];
    glNamedBufferStorage(corners, sizeof square, square, 0);
    glNamedBufferStorage(block, sizeof scale, scale, 0);
    glNamedBufferStorage(points, 64 * 8, nullptr, 0);
    glNamedBufferStorage(counter, 4, nullptr, GL_DYNAMIC_STORAGE_BIT);
    glBindBufferBase(GL_UNIFORM_BUFFER, 1, block);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, points);
    glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 0, counter);
    glCreateTextures(GL_TEXTURE_2D, 1, &image);
    glTextureStorage2D(image, 1, GL_RGBA8, 4, 4);
    glTextureSubImage2D(image, 0, 0, 0, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    glBindTextureUnit(2, image);
}

void attributesFrom(GLuint buffer) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void drawSquare(GLuint program, GLfloat x, GLfloat y, int frame) {
    glUseProgram(program);
    attributesFrom(corners);
    glUniform2f(2, x, y);
    glUniform4f(4, 1, 0.7F + float(frame) * 0.1F, 0.9F, 1);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void drawPoints(int frame) {
    glUseProgram(places);
    glUniform1f(1, float(frame) + 0.5F);
    glDispatchCompute(8, 1, 1);
    glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
    glUseProgram(patterned);
    glUniform2f(2, 0.5F, -0.5F);
    glUniform4f(4, 0.6F, 1, 0.6F, 1);
    attributesFrom(points);
    glPointSize(5);
    glDrawArrays(GL_POINTS, 0, 64);
}

void drawCounted() {
    const GLuint zero = 0;
    GLuint count = 0;
    glNamedBufferSubData(counter, 0, 4, &zero);
    glUseProgram(counting);
    attributesFrom(corners);
    glUniform2f(2, -0.6F, -0.6F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(counter, 0, 4, &count);
    showBits(1, count);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 5};
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.12F, 0.2F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            drawSquare(plain, -0.3F, 0.2F, frame);
            drawSquare(patterned, 0.4F, 0.4F, frame);
            drawPoints(frame);
            if (frame > 1) {
                drawCounted();
            }
        });
}
