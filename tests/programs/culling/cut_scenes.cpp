// Scenes of the benchmark of culling. CUT_SCENE selects one: draws (many small ones), sphere, near (the sphere from
// near), shader (the sphere with a program), plain (visible to every node). CUT_TRIANGLES is its size. Without the
// variables, all scenes are drawn small.
#include <cmath>
#include <cstdlib>
#include <string>

#include "tests/programs/culling/meshes.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"

using namespace programs;

namespace {

constexpr int kTrianglesPerDraw = 12;
std::string scene;
int triangles = 6000;
GLuint vertexBuffer, indexBuffer, program;
GLsizei indexCount;

// Rows of latitude, whose triangles follow each other in blocks.
void makeSphere() {
    const int rows = static_cast<int>(std::sqrt(static_cast<double>(triangles) / 4)), columns = 2 * rows;
    std::vector<float> places;
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column <= columns; ++column) {
            const float up = 3.14159265F * static_cast<float>(row) / static_cast<float>(rows);
            const float around = 6.2831853F * static_cast<float>(column) / static_cast<float>(columns);
            places.insert(places.end(),
                          {std::sin(up) * std::cos(around), std::cos(up), std::sin(up) * std::sin(around)});
        }
    std::vector<GLuint> indices;
    constexpr int kBlock = 8;
    for (int top = 0; top < rows; top += kBlock)
        for (int column = 0; column < columns; ++column)
            for (int row = top; row < top + kBlock && row < rows; ++row) {
                const auto at = static_cast<GLuint>(row * (columns + 1) + column),
                           below = at + static_cast<GLuint>(columns) + 1;
                indices.insert(indices.end(), {at, at + 1, below, at + 1, below + 1, below});
            }
    vertexBuffer = bufferOf(GL_ARRAY_BUFFER, places.size() * 4, places.data());
    indexBuffer = bufferOf(GL_ELEMENT_ARRAY_BUFFER, indices.size() * 4, indices.data());
    indexCount = static_cast<GLsizei>(indices.size());
}

void setUp(Window&) {
    const char* const wanted = std::getenv("CUT_SCENE");
    const char* const size = std::getenv("CUT_TRIANGLES");
    if (wanted) scene = wanted;
    if (size) triangles = std::atoi(size);
    makeSphere();
    program = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 120\nuniform mat4 view; uniform mat4 model; attribute vec3 place; varying vec3 lit;\n"
          "void main() { vec3 n = mat3(model) * place; lit = vec3(0.2) + 0.8 * max(dot(n, vec3(0.5)), 0.0) * "
          "abs(place);\n"
          "  gl_Position = view * model * vec4(place, 1.0); }"},
         {GL_FRAGMENT_SHADER, "#version 120\nvarying vec3 lit; void main() { gl_FragColor = vec4(lit, 1.0); }"}},
        [](unsigned p) { glBindAttribLocation(p, 0, "place"); });
}

void useLight() {
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glEnable(GL_COLOR_MATERIAL);
    glEnable(GL_CULL_FACE);
    glColor3f(0.9F, 0.7F, 0.4F);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_NORMAL_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indexBuffer);
    glVertexPointer(3, GL_FLOAT, 0, offsetOf(0));
    glNormalPointer(GL_FLOAT, 0, offsetOf(0));
}

void drawSphere() { glDrawElements(GL_TRIANGLES, indexCount, GL_UNSIGNED_INT, offsetOf(0)); }

void drawMany(int frame) {
    const int draws = triangles / kTrianglesPerDraw, side = static_cast<int>(std::sqrt(static_cast<double>(draws)));
    for (int i = 0; i < side * side; ++i) {
        glPushMatrix();
        glTranslatef(3.0F * static_cast<float>(i % side) / static_cast<float>(side) - 1.5F,
                     2.4F * static_cast<float>(i / side) / static_cast<float>(side) - 1.2F,
                     0.001F * static_cast<float>(i % 7));
        glRotatef(static_cast<float>(3 * frame + i), 0, 1, 0.3F);
        glScalef(0.08F, 0.08F, 0.08F);
        const auto at = static_cast<std::size_t>((i * 36) % (indexCount - 36));
        glDrawElements(GL_TRIANGLES, 3 * kTrianglesPerDraw, GL_UNSIGNED_INT, offsetOf(4 * (at - at % 3)));
        glPopMatrix();
    }
}

void drawShader() {
    GLfloat view[16], model[16];
    glGetFloatv(GL_PROJECTION_MATRIX, view);
    glGetFloatv(GL_MODELVIEW_MATRIX, model);
    glUseProgram(program);
    glUniformMatrix4fv(glGetUniformLocation(program, "view"), 1, GL_FALSE, view);
    glUniformMatrix4fv(glGetUniformLocation(program, "model"), 1, GL_FALSE, model);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, offsetOf(0));
    drawSphere();
    glDisableVertexAttribArray(0);
    glUseProgram(0);
}

void drawScene(const std::string& name, int frame) {
    glLoadIdentity();
    const bool isNear = name == "near";
    glTranslatef(0, 0, isNear ? -1.12F : name == "plain" ? -1.4F : -2.6F);
    if (name == "draws") return drawMany(frame);
    glRotatef(static_cast<float>(5 * frame), 0.2F, 1, 0.1F);
    if (name == "shader") return drawShader();
    drawSphere();
}

void draw(Window& window, int frame) {
    const double aspect = static_cast<double>(window.width()) / window.height();
    glClearColor(0.1F, 0.1F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glFrustum(-0.05 * aspect, 0.05 * aspect, -0.05, 0.05, 0.1, 20);
    glMatrixMode(GL_MODELVIEW);
    useLight();
    if (!scene.empty()) return drawScene(scene, frame);
    for (const char* const each : {"draws", "sphere", "shader", "near"}) drawScene(each, frame);
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, WindowSpec{}, setUp, draw); }
