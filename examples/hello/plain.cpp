// The program of docs/guide/native.md before it uses Mural: a turning ring of triangles in a window.
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace {

constexpr int kTriangles = 96;
constexpr const char* kVertex = R"(#version 330 core
uniform mat4 clip;
uniform float angle;
out vec3 colour;
void main() {
    int triangle = gl_VertexID / 3, corner = gl_VertexID % 3;
    float a = angle + 6.2831853 * float(triangle) / 96. + .03 * float(corner - 1);
    float radius = corner == 1 ? 1.2 : .8;
    colour = .5 + .5 * cos(a + vec3(0, 2, 4));
    gl_Position = clip * vec4(radius * cos(a), radius * sin(a), .3 * sin(3. * a), 1);
})";
constexpr const char* kFragment = R"(#version 330 core
in vec3 colour;
out vec4 pixel;
void main() { pixel = vec4(colour, 1); })";

unsigned linkProgram() {
    const unsigned program = glCreateProgram();
    const auto add = [program](unsigned type, const char* text) {
        const unsigned shader = glCreateShader(type);
        glShaderSource(shader, 1, &text, nullptr);
        glCompileShader(shader);
        glAttachShader(program, shader);
    };
    add(GL_VERTEX_SHADER, kVertex);
    add(GL_FRAGMENT_SHADER, kFragment);
    glLinkProgram(program);
    return program;
}

void draw(unsigned program, double angle, int width, int height) {
    const float x = 3.75f * static_cast<float>(height) / static_cast<float>(width), y = 3.75f;
    // Looks from 5 metres along the negative z axis; near plane .1, far plane 10.
    const float clip[16] = {x, 0, 0, 0, 0, y, 0, 0, 0, 0, -1.0202f, -1, 0, 0, 4.899f, 5};
    glViewport(0, 0, width, height);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glUseProgram(program);
    glUniformMatrix4fv(glGetUniformLocation(program, "clip"), 1, GL_FALSE, clip);
    glUniform1f(glGetUniformLocation(program, "angle"), static_cast<float>(angle));
    glDrawArrays(GL_TRIANGLES, 0, 3 * kTriangles);
}

} // namespace

int main() {
    if (!glfwInit()) return 1;
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    GLFWwindow* const window = glfwCreateWindow(640, 480, "ring", nullptr, nullptr);
    if (!window) return 1;
    glfwMakeContextCurrent(window);
    const unsigned program = linkProgram();
    unsigned vertices = 0;
    glGenVertexArrays(1, &vertices);
    glBindVertexArray(vertices);
    for (int frame = 1; !glfwWindowShouldClose(window); ++frame) {
        int width = 0, height = 0;
        glfwGetFramebufferSize(window, &width, &height);
        draw(program, .02 * frame, width, height);
        glfwSwapBuffers(window);
        glfwPollEvents();
    }
    glfwTerminate();
    return 0;
}
