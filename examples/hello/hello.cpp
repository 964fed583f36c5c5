// A turning ring of triangles on any wall. Every node draws its part of the picture, and its range of the triangles.
//
//   mural run --tiles 2x2 -- ./hello      mural run --db 2 -- ./hello
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <mural/mural.hpp>

namespace {

struct Scene {
    double angle = 0; // radians
    template <class Visit> void fields(Visit& visit) { visit(angle); }
};

class Hello : public mural::Application {
    mural::Next update(mural::Session& session, const mural::FrameClock& clock) override {
        session.state<Scene>().angle = .02 * static_cast<double>(clock.frame);
        return mural::Next::Frame;
    }
};

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

class Ring : public mural::Renderer {
    mural::Result<void> start(mural::Pipe&) override {
        auto program = mural::linkProgram(kVertex, kFragment);
        if (!program) return program.error();
        program_ = *program;
        glGenVertexArrays(1, &vertices_);
        return {};
    }
    void draw(mural::RenderTask& task) override {
        task.setNearFar(.1, 10);
        task.apply();
        const auto clip = mural::glMatrix(task.projection() * task.toEye() * mural::Matrix4::translation({0, 0, -5}));
        glEnable(GL_DEPTH_TEST);
        glUseProgram(program_);
        glBindVertexArray(vertices_);
        glUniformMatrix4fv(glGetUniformLocation(program_, "clip"), 1, GL_FALSE, clip.data());
        glUniform1f(glGetUniformLocation(program_, "angle"), static_cast<float>(task.state<Scene>().angle));
        const auto [first, end] = mural::itemsOf(task.context().range, kTriangles);
        glDrawArrays(GL_TRIANGLES, static_cast<int>(3 * first), static_cast<int>(3 * (end - first)));
    }
    unsigned program_ = 0;
    unsigned vertices_ = 0;
};

} // namespace

int main(int argc, char** argv) { return mural::run<Hello, Ring>(argc, argv); }
