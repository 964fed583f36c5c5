// Uniform blocks (all layouts, arrays, ranges), storage blocks read by vertex shaders, subroutines, separable programs
// in pipelines, program interface queries.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <cstring>
#include <vector>

using namespace programs;

namespace {

GLuint vertexArray, blocks, storage, subroutines;
GLuint pipeline, separateVertex, separateFragments[2];
GLuint uniformBuffer, storageBuffer;
GLint alignment;

void makePrograms() {
    blocks = buildProgram({{GL_VERTEX_SHADER, R"(#version 430
layout(std140) uniform Places { vec2 offset; float scale; mat2 turn; vec3 list[3]; } places[2];
flat out int which;
void main() { which = gl_InstanceID; vec2 c = vec2(gl_VertexID & 1, gl_VertexID >> 1);
vec2 p = gl_InstanceID == 0 ? places[0].turn * c * places[0].scale + places[0].offset + places[0].list[2].xy
                            : places[1].turn * c * places[1].scale + places[1].offset + places[1].list[1].xy;
gl_Position = vec4(p, 0, 1); })"},
                           {GL_FRAGMENT_SHADER, R"(#version 430
flat in int which; out vec4 result;
layout(std140, row_major, binding=4) uniform Colors { mat3 mixes; vec4 tints[2]; float last; };
void main() { result = vec4(mixes * tints[which].rgb, 1) * last; })"}});
    storage = buildProgram(
        {{GL_VERTEX_SHADER, R"(#version 430
struct Item { vec2 place; float size; uint color; };
layout(std430, binding=2) readonly buffer Items { uint count; float pad[3]; Item items[]; };
out vec4 tint;
void main() { Item item = items[gl_InstanceID]; vec2 c = vec2(gl_VertexID & 1, gl_VertexID >> 1);
tint = unpackUnorm4x8(item.color) + vec4(float(items.length()) * 0.01 + float(count) * 0.01);
gl_Position = vec4(item.place + c * item.size, 0, 1); })"},
         {GL_FRAGMENT_SHADER, "#version 430\nin vec4 tint; out vec4 result; void main() { result = tint; }\n"}});
    subroutines = buildProgram({{GL_VERTEX_SHADER, R"(#version 430
subroutine vec2 Mover(vec2 p); subroutine uniform Mover mover; uniform vec2 offset;
subroutine(Mover) vec2 straight(vec2 p) { return p; }
subroutine(Mover) vec2 slanted(vec2 p) { return p + vec2(p.y * 0.4, 0); }
void main() { vec2 c = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 0.25; gl_Position = vec4(mover(c) + offset, 0, 1); })"},
                                {GL_FRAGMENT_SHADER, R"(#version 430
subroutine vec4 Painter(); subroutine uniform Painter painters[2]; out vec4 result;
subroutine(Painter) vec4 red() { return vec4(0.9, 0.1, 0.1, 1); }
subroutine(Painter) vec4 green() { return vec4(0.1, 0.8, 0.2, 1); }
subroutine(Painter) vec4 coordinates() { return vec4(fract(gl_FragCoord.xy / 16.0), 0.3, 1); }
void main() { result = painters[0]() * 0.5 + painters[1]() * 0.5; })"}});
}

void makePipeline() {
    const char* const vertex =
        "#version 430\nout gl_PerVertex { vec4 gl_Position; }; layout(location=3) out vec3 tint;\n"
        "uniform vec2 offset; void main() { vec2 c = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
        "tint = vec3(c, 0.5); gl_Position = vec4(c * 0.25 + offset, 0, 1); }\n";
    const char* const fragments[] = {
        "#version 430\nlayout(location=3) in vec3 tint; uniform float gain; out vec4 result;\n"
        "void main() { result = vec4(tint * gain, 1); }\n",
        "#version 430\nlayout(location=3) in vec3 tint; uniform float gain; out vec4 result;\n"
        "void main() { result = vec4(gain - tint.bgr, 1); }\n"};
    separateVertex = glCreateShaderProgramv(GL_VERTEX_SHADER, 1, &vertex);
    for (int i = 0; i < 2; ++i) {
        separateFragments[i] = glCreateShaderProgramv(GL_FRAGMENT_SHADER, 1, fragments + i);
    }
    glGenProgramPipelines(1, &pipeline);
    glUseProgramStages(pipeline, GL_VERTEX_SHADER_BIT, separateVertex);
}

void drawBlocks(int frame) {
    struct Places {
        GLfloat offset[2], scale, pad, turn[8], list[12];
    };
    const GLsizeiptr step = (GLsizeiptr(sizeof(Places)) + alignment - 1) / alignment * alignment;
    std::vector<GLubyte> bytes(std::size_t(step) * 2 + 256);
    for (int i = 0; i < 2; ++i) {
        const float t = float(frame) * 0.05F;
        const Places places = {{-0.9F + float(i) * 0.5F, 0.5F},
                               0.35F,
                               0,
                               {1, t, 0, 0, -t, 1, 0, 0},
                               {0, 0, 0, 0, 0.05F, t, 0, 0, t, 0.05F, 0, 0}};
        std::memcpy(&bytes[std::size_t(step * i)], &places, sizeof places);
    }
    const GLfloat colors[] = {0.9F, 0, 0.1F, 0,    0.2F, 0.8F, 0,    0,    0,    0.1F * float(frame),
                              0.7F, 0, 0.8F, 0.5F, 0.9F, 1,    0.3F, 0.9F, 0.6F, 1,
                              0.9F, 0, 0,    0};
    std::memcpy(&bytes[std::size_t(step * 2)], colors, sizeof colors);
    glBindBuffer(GL_UNIFORM_BUFFER, uniformBuffer);
    glBufferData(GL_UNIFORM_BUFFER, GLsizeiptr(bytes.size()), bytes.data(), GL_DYNAMIC_DRAW);
    glUseProgram(blocks);
    glUniformBlockBinding(blocks, glGetUniformBlockIndex(blocks, "Places[0]"), 1);
    glUniformBlockBinding(blocks, glGetUniformBlockIndex(blocks, "Places[1]"), 2);
    glBindBufferRange(GL_UNIFORM_BUFFER, 1, uniformBuffer, 0, sizeof(Places));
    glBindBufferRange(GL_UNIFORM_BUFFER, 2, uniformBuffer, step, sizeof(Places));
    glBindBufferRange(GL_UNIFORM_BUFFER, 4, uniformBuffer, step * 2, sizeof colors);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, 2);
}

void drawStorage(int frame) {
    struct Item {
        GLfloat place[2], size;
        GLuint color;
    };
    struct {
        GLuint count;
        GLfloat pad[3];
        Item items[20];
    } data = {GLuint(frame), {0, 0, 0}, {}};
    Sequence numbers(unsigned(frame) + 33);
    for (Item& item : data.items) {
        item = {{numbers.unit() - 0.05F, numbers.unit() * 0.9F},
                0.03F + numbers.unit() * 0.1F,
                numbers.next() | 0xff000000U};
    }
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, storageBuffer);
    glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof data, &data, GL_DYNAMIC_DRAW);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, storageBuffer);
    glUseProgram(storage);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, 20);
}

void drawSubroutines(int frame) {
    glUseProgram(subroutines);
    const char* const painters[] = {"red", "green", "coordinates"};
    for (int i = 0; i < 3; ++i) {
        const GLuint mover =
            glGetSubroutineIndex(subroutines, GL_VERTEX_SHADER, (i + frame) % 2 == 0 ? "straight" : "slanted");
        GLuint chosen[2] = {};
        chosen[0] = glGetSubroutineIndex(subroutines, GL_FRAGMENT_SHADER, painters[i]);
        chosen[1] = glGetSubroutineIndex(subroutines, GL_FRAGMENT_SHADER, painters[(i + frame) % 3]);
        glUniformSubroutinesuiv(GL_VERTEX_SHADER, 1, &mover);
        glUniformSubroutinesuiv(GL_FRAGMENT_SHADER, 2, chosen);
        glUniform2f(glGetUniformLocation(subroutines, "offset"), -0.3F + 0.4F * float(i), -0.9F);
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
}

void drawPipeline(int frame) {
    glUseProgram(0);
    glBindProgramPipeline(pipeline);
    for (int i = 0; i < 2; ++i) {
        glUseProgramStages(pipeline, GL_FRAGMENT_SHADER_BIT, separateFragments[i]);
        glProgramUniform1f(separateFragments[i], glGetUniformLocation(separateFragments[i], "gain"),
                           0.7F + 0.1F * float(frame));
        glProgramUniform2f(separateVertex, glGetUniformLocation(separateVertex, "offset"), -0.3F + 0.4F * float(i),
                           -0.5F);
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
    // glUniform reaches the active program of the pipeline.
    glActiveShaderProgram(pipeline, separateVertex);
    glUniform2f(glGetUniformLocation(separateVertex, "offset"), 0.6F, -0.5F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glBindProgramPipeline(0);
}

void showInterface() {
    GLint resources = 0;
    glGetProgramInterfaceiv(storage, GL_BUFFER_VARIABLE, GL_ACTIVE_RESOURCES, &resources);
    showBits(37,
             std::uint32_t(resources) * 1000U + glGetProgramResourceIndex(storage, GL_SHADER_STORAGE_BLOCK, "Items"));
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 3};
    return runInGlxWindow(
        argc, argv, spec,
        [](Window&) {
            glGenVertexArrays(1, &vertexArray);
            glBindVertexArray(vertexArray);
            GLuint buffers[2];
            glGenBuffers(2, buffers);
            uniformBuffer = buffers[0], storageBuffer = buffers[1];
            glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
            makePrograms();
            makePipeline();
        },
        [](Window&, int frame) {
            glClearColor(0.08F, 0.1F, 0.14F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            drawBlocks(frame);
            drawStorage(frame);
            drawSubroutines(frame);
            drawPipeline(frame);
            showInterface();
        });
}
