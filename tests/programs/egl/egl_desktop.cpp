// Desktop OpenGL with EGL, linked to libOpenGL and libEGL: a core profile and, in a second window, the compatibility
// profile.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/matrix.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

GLuint program, vertexArray, buffer;

void setUpCore() {
    program = buildProgram(
        {{GL_VERTEX_SHADER, "#version 330\nlayout(location=0) in vec3 place; uniform mat4 matrix; out vec3 tint;\n"
                            "void main() { tint = place + 0.5; gl_Position = matrix * vec4(place, 1); }\n"},
         {GL_FRAGMENT_SHADER,
          "#version 330\nin vec3 tint; out vec4 result; void main() { result = vec4(tint, 1); }\n"}});
    GLfloat places[36 * 3];
    int count = 0;
    for (int axis = 0; axis < 3; ++axis) {
        for (int side = 0; side < 2; ++side) {
            const int order[] = {0, 1, 2, 2, 1, 3};
            for (const int corner : order) {
                GLfloat point[3];
                point[axis] = float(side) - 0.5F;
                point[(axis + 1) % 3] = float(corner & 1) - 0.5F;
                point[(axis + 2) % 3] = float(corner >> 1) - 0.5F;
                for (const GLfloat value : point) {
                    places[count++] = value;
                }
            }
        }
    }
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, sizeof places, places, GL_STATIC_DRAW);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(0);
}

void drawCore(int frame) {
    glClearColor(0.1F, 0.1F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glUseProgram(program);
    for (int i = 0; i < 4; ++i) {
        const Matrix view =
            multiply(translation(float(i) * 1.4F - 2.1F, 0, -5), rotationY(0.5F + 0.2F * float(frame + i)));
        const Matrix matrix = multiply(perspective(0.6F, 0.45F, 1, 20), view);
        glUniformMatrix4fv(glGetUniformLocation(program, "matrix"), 1, GL_FALSE, matrix.data());
        glDrawArrays(GL_TRIANGLES, 0, 36);
    }
}

void drawCompatible(int frame) {
    glClearColor(0.2F, 0.1F, 0.1F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glLoadIdentity();
    glRotatef(float(frame) * 13, 0, 0, 1);
    glBegin(GL_TRIANGLE_FAN);
    for (int i = 0; i < 6; ++i) {
        Sequence numbers{unsigned(i)};
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(numbers.unit() * 1.6F - 0.8F, numbers.unit() * 1.6F - 0.8F);
    }
    glEnd();
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    WindowSpec spec = {Profile::Core, 3, 3};
    const auto core = openEglWindow(spec, options.width, options.height);
    spec = {};
    spec.x = options.width;
    const auto compatible = openEglWindow(spec, options.width / 2, options.height / 2);
    core->makeCurrent();
    setUpCore();
    for (int frame = 0; frame < options.frames; ++frame) {
        core->makeCurrent();
        drawCore(frame);
        checkNoError("in the core profile");
        core->swap();
        compatible->makeCurrent();
        drawCompatible(frame);
        checkNoError("in the compatibility profile");
        compatible->swap();
    }
    return 0;
}
