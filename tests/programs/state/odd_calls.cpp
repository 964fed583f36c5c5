// Calls that few programs make, but drivers accept:
//   - client arrays enabled with glEnable;
//   - display lists inside and across glBegin and glEnd;
//   - counts and pointers without memory after them, buffers too small for a picture;
//   - the picture read pixel by pixel.
// Errors and values read are shown as bits.
#include "tests/programs/support/gl.hpp"

#include "tests/programs/draw_errors/record.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <functional>
#include <sys/mman.h>
#include <vector>

using namespace programs;

namespace {

std::uint32_t errors = 0;

void noteError() { errors = foldErrors(errors, glGetError); }

// Enables client arrays with glEnable: Mesa accepts it, other drivers report an error.
void arraysByEnable(int frame) {
    const GLfloat x = 0.1F * float(frame % 5);
    const GLfloat vertices[] = {-0.9F + x, -0.9F, -0.4F + x, -0.9F, -0.6F + x, -0.4F};
    const GLfloat colours[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    glVertexPointer(2, GL_FLOAT, 0, vertices);
    glColorPointer(3, GL_FLOAT, 0, colours);
    glEnable(GL_VERTEX_ARRAY);
    glEnable(GL_COLOR_ARRAY);
    noteError();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_COLOR_ARRAY);
    glColor3f(0.3F, 0.6F, 0.9F);
    glTranslatef(0.5F, 0, 0);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glLoadIdentity();
    glDisable(GL_VERTEX_ARRAY);
    glDisableClientState(GL_VERTEX_ARRAY);
    glDisableClientState(GL_COLOR_ARRAY);
}

GLuint compile(GLenum mode, const std::function<void()>& calls) {
    const GLuint list = glGenLists(1);
    glNewList(list, mode);
    calls();
    glEndList();
    return list;
}

void square(float x, float y) {
    glVertex2f(x, y);
    glVertex2f(x + 0.3F, y);
    glVertex2f(x + 0.3F, y + 0.3F);
    glVertex2f(x, y + 0.3F);
}

void listsInPrimitives(int frame) {
    const float y = 0.02F * float(frame % 7);
    glColor3f(0.9F, 0.7F, 0.2F);
    const GLuint vertices = compile(GL_COMPILE, [&] { square(-0.9F, y); });
    const GLuint illegal = compile(GL_COMPILE, [&] {
        square(-0.5F, y);
        glColor3f(1, 0, 0);
        glRectf(-1, -1, 1, 1);
        glBlendFunc(GL_ONE, GL_ONE);
    });
    const GLuint begins = compile(GL_COMPILE, [] { glBegin(GL_QUADS); });
    const GLuint ends = compile(GL_COMPILE, [] { glEnd(); });
    const GLuint moved = compile(GL_COMPILE, [&] { square(-0.1F, y); });
    const GLuint both = compile(GL_COMPILE_AND_EXECUTE, [&] {
        glBegin(GL_QUADS);
        glCallList(moved);
        square(0.3F, y);
        glEnd();
    });
    noteError();
    glBegin(GL_QUADS);
    glCallList(vertices);
    glEnd();
    noteError();
    glBegin(GL_QUADS);
    glCallList(illegal);
    glEnd();
    noteError();
    glColor3f(0.2F, 0.9F, 0.4F);
    glTranslatef(0, 0.35F, 0);
    glCallList(begins);
    glCallList(vertices);
    glCallList(moved);
    glCallList(ends);
    noteError();
    glCallList(both);
    glCallList(ends); // there is no primitive to end
    noteError();
    glBegin(GL_QUADS);
    glGetString(GL_EXTENSIONS);
    square(0.7F, y);
    glEnd();
    noteError();
    glLoadIdentity();
    for (const GLuint list : {vertices, illegal, begins, ends, moved, both}) glDeleteLists(list, 1);
}

// Returns a page of memory without any mapped memory after it.
const GLfloat* lastPage() {
    static GLfloat* page = nullptr;
    constexpr size_t kBytes = 4096;
    if (!page) {
        auto* both =
            static_cast<char*>(mmap(nullptr, 2 * kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
        munmap(both + kBytes, kBytes);
        page = reinterpret_cast<GLfloat*>(both);
        for (size_t i = 0; i < kBytes / sizeof(GLfloat); ++i) page[i] = float(i % 7) / 7;
    }
    return page;
}

void countsBeyondMemory(GLuint program) {
    glUseProgram(program);
    const GLint one = glGetUniformLocation(program, "one"), many = glGetUniformLocation(program, "many");
    glUniform4fv(one, 1000000, lastPage()); // not an array: an error
    noteError();
    glUniform4fv(many, 1000000, lastPage()); // limited to the array
    noteError();
    glRectf(0.5F, -0.9F, 0.9F, -0.5F);
    glUseProgram(0);
    const auto* const nowhere = reinterpret_cast<const GLchar* const*>(lastPage());
    glShaderSource(9999, 1, nowhere, nullptr);
    noteError();
    glShaderSource(program, 1, nowhere, nullptr);
    noteError();
}

void buffersTooSmall() {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    glBufferData(GL_PIXEL_UNPACK_BUFFER, 32 * 32 * 4, nullptr, GL_STREAM_DRAW);
    glDrawPixels(32, 33, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    noteError();
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    glReadPixels(0, 0, 32, 33, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    noteError();
    glReadPixels(0, 0, 32, 32, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    noteError();
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glDeleteBuffers(1, &buffer);
}

// Reads pixels one by one, with drawing in between, so that pixels read earlier are stale.
std::uint32_t pixelByPixel(const Window& window) {
    std::uint32_t sum = 0;
    for (int step = 0; step < 3; ++step) {
        for (int i = 0; i < 60; ++i) {
            GLubyte pixel[4] = {};
            glReadPixels(i * (window.width() - 1) / 59, (i * 7 % 60) * (window.height() - 1) / 59, 1, 1, GL_RGBA,
                         GL_UNSIGNED_BYTE, pixel);
            for (const GLubyte value : pixel) sum = sum * 31 + value;
        }
        GLfloat depths[4] = {};
        glReadPixels(window.width() / 2 - 1, window.height() / 2 - 1, 2, 2, GL_DEPTH_COMPONENT, GL_FLOAT, depths);
        for (const GLfloat depth : depths) sum = sum * 31 + std::uint32_t(depth * 1000);
        glColor3f(0.1F * float(step), 0.5F, 0.4F);
        glRectf(-0.2F, -0.3F + 0.2F * float(step), 0.3F, -0.2F + 0.2F * float(step));
    }
    return sum;
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openGlxWindow({}, options.width, options.height);
    window->makeCurrent();
    const GLuint program =
        buildProgram({{GL_VERTEX_SHADER, "#version 120\nvoid main() { gl_Position = gl_Vertex; }\n"},
                      {GL_FRAGMENT_SHADER, "#version 120\nuniform vec4 one; uniform vec4 many[20];\n"
                                           "void main() { gl_FragColor = many[3] * 0.5 + many[17] * 0.5 + one; }\n"}});
    for (int frame = 0; frame < options.frames; ++frame) {
        glClearColor(0.1F, 0.1F, 0.1F * float(frame % 4), 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        errors = 0;
        arraysByEnable(frame);
        listsInPrimitives(frame);
        countsBeyondMemory(program);
        buffersTooSmall();
        const std::uint32_t sum = pixelByPixel(*window);
        showBits(20, sum);
        showBits(21, errors);
        window->swap();
    }
    return 0;
}
