// Queries: occlusion, boolean occlusion, primitives (also of streams), timers, pipeline statistics, results in a
// buffer, conditional rendering, and queries that never began. Repeatable results are drawn: counts as bits and bars.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

GLuint vertexArray, program, streamsProgram, names[15], resultBuffer, feedbackBuffer, indirectBuffer;

void box(float x, float y, float w, float h, float depth) {
    glUniform4f(0, x, y, w, h);
    glUniform1f(1, depth);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

GLuint waitFor(GLuint query) {
    GLuint result = 0;
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &result);
    return result;
}

// Counts samples of a box partly hidden by another one.
void countSamples(int frame) {
    box(-0.9F, -0.9F, 0.5F, 0.6F, 0.2F);
    glBeginQuery(GL_SAMPLES_PASSED, names[0]);
    box(-0.7F, -0.7F + 0.05F * float(frame), 0.6F, 0.5F, 0.6F);
    glEndQuery(GL_SAMPLES_PASSED);
    glBeginQuery(GL_ANY_SAMPLES_PASSED, names[1]);
    box(-0.85F, -0.85F, 0.1F, 0.1F, 0.7F); // hidden
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    glBeginQuery(GL_ANY_SAMPLES_PASSED_CONSERVATIVE, names[2]);
    box(0, -0.9F, 0.2F, 0.3F, 0.3F);
    glEndQuery(GL_ANY_SAMPLES_PASSED_CONSERVATIVE);
    showBits(37, waitFor(names[0]));
    showBits(36, waitFor(names[1]) * 2 + (waitFor(names[2]) != 0 ? 1U : 0U));
    showBar(35, waitFor(names[0]) / 40);
}

void countPrimitives(int frame) {
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, feedbackBuffer);
    glBeginQuery(GL_PRIMITIVES_GENERATED, names[3]);
    glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, names[4]);
    glBeginTransformFeedback(GL_TRIANGLES);
    glUniform4f(0, 0.3F, -0.9F, 0.5F, 0.4F);
    glDrawArraysInstanced(GL_TRIANGLES, 0, 3, 2 + frame * 2); // in the last frames more than the buffer holds
    glEndTransformFeedback();
    glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
    glEndQuery(GL_PRIMITIVES_GENERATED);
    showBits(34, waitFor(names[3]) * 256 + waitFor(names[4]));
}

// Counts primitives of a geometry shader's two streams: one query after the other with one name, then both at once.
void countStreams(int frame) {
    glUseProgram(streamsProgram);
    glUniform1i(0, 2 + frame);
    glEnable(GL_RASTERIZER_DISCARD);
    GLuint readBack[4] = {};
    for (GLuint stream = 0; stream < 2; ++stream) {
        glBeginQueryIndexed(GL_PRIMITIVES_GENERATED, stream, names[13]);
        // Mesa 22.3 counts the first stream again: different numbers of points reveal it
        glDrawArrays(GL_POINTS, 0, stream == 0 ? 1 : 3);
        glEndQueryIndexed(GL_PRIMITIVES_GENERATED, stream);
        readBack[stream] = waitFor(names[13]);
    }
    for (GLuint stream = 0; stream < 2; ++stream)
        glBeginQueryIndexed(GL_PRIMITIVES_GENERATED, stream, names[13 + stream]);
    glDrawArrays(GL_POINTS, 0, 1);
    for (GLuint stream = 0; stream < 2; ++stream) glEndQueryIndexed(GL_PRIMITIVES_GENERATED, stream);
    for (GLuint stream = 0; stream < 2; ++stream) readBack[2 + stream] = waitFor(names[13 + stream]);
    glDisable(GL_RASTERIZER_DISCARD);
    glUseProgram(program);
    showBits(24, readBack[0] | readBack[1] << 8 | readBack[2] << 16 | readBack[3] << 24);
}

// Shows only that there are times, because they differ between runs.
void measureTime() {
    glBeginQuery(GL_TIME_ELAPSED, names[5]);
    box(0.5F, -0.3F, 0.3F, 0.3F, 0.4F);
    glEndQuery(GL_TIME_ELAPSED);
    glQueryCounter(names[6], GL_TIMESTAMP);
    GLuint64 elapsed = 0;
    GLuint64 stamp = 0;
    glGetQueryObjectui64v(names[5], GL_QUERY_RESULT, &elapsed);
    glGetQueryObjectui64v(names[6], GL_QUERY_RESULT, &stamp);
    GLint64 now = 0;
    glGetInteger64v(GL_TIMESTAMP, &now);
    GLint bits = 0;
    glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &bits);
    showBits(33, (stamp != 0 ? 1U : 0U) | (GLuint64(now) >= stamp ? 2U : 0U) | (bits >= 30 ? 4U : 0U));
}

void renderConditionally(int frame) {
    // Hidden and visible in alternation.
    glBeginQuery(GL_SAMPLES_PASSED, names[7]);
    box(-0.85F, -0.85F, 0.2F, 0.2F, frame % 2 == 0 ? 0.9F : 0.1F);
    glEndQuery(GL_SAMPLES_PASSED);
    glBeginConditionalRender(names[7], GL_QUERY_WAIT);
    box(-0.9F, 0, 0.3F, 0.3F, 0.2F);
    glEndConditionalRender();
    glBeginConditionalRender(names[7], GL_QUERY_WAIT_INVERTED);
    box(-0.5F, 0, 0.3F, 0.3F, 0.2F);
    glClear(0);
    glEndConditionalRender();
    glBeginConditionalRender(names[2], GL_QUERY_BY_REGION_WAIT);
    box(-0.1F, 0, 0.3F, 0.3F, 0.2F);
    glEndConditionalRender();
}

// Writes a result into a buffer without leaving GL, and reads the buffer.
void resultIntoBuffer(int frame) {
    glBindBuffer(GL_QUERY_BUFFER, resultBuffer);
    glBeginQuery(GL_SAMPLES_PASSED, names[8]);
    box(0.3F, 0.05F * float(frame), 0.4F, 0.3F, 0.1F);
    glEndQuery(GL_SAMPLES_PASSED);
    glFinish(); // llvmpipe writes 0 into the buffer when it is not ready
    glGetQueryObjectuiv(names[8], GL_QUERY_RESULT, nullptr);
    glGetQueryObjectuiv(names[8], GL_QUERY_RESULT_AVAILABLE, reinterpret_cast<GLuint*>(8));
    GLuint readBack[4] = {};
    glGetBufferSubData(GL_QUERY_BUFFER, 0, sizeof readBack, readBack);
    glBindBuffer(GL_QUERY_BUFFER, 0);
    showBits(32, readBack[0]);
}

// Writes a result into memory that only GL may write. The next draw reads its instance count from it.
void resultIntoImmutableBuffer(int frame) {
    glGenBuffers(1, &indirectBuffer);
    glBindBuffer(GL_QUERY_BUFFER, indirectBuffer);
    const GLuint draw[4] = {4, 7, 0, 0}; // vertices, instances, first vertex, first instance
    glBufferStorage(GL_QUERY_BUFFER, sizeof draw, draw, 0);
    glBeginQuery(GL_ANY_SAMPLES_PASSED, names[11]);
    box(0.35F, 0.6F, 0.05F, 0.05F, frame % 2 == 0 ? 0.1F : 2.0F);
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    glFinish();
    glGetQueryObjectuiv(names[11], GL_QUERY_RESULT, reinterpret_cast<GLuint*>(4));
    glBindBuffer(GL_QUERY_BUFFER, 0);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, indirectBuffer);
    glUniform4f(0, 0.45F, 0.5F, 0.3F, 0.2F);
    glUniform1f(1, 0.3F);
    glDrawArraysIndirect(GL_TRIANGLE_STRIP, nullptr);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
    glDeleteBuffers(1, &indirectBuffer);
    checkNoError("with a result in an immutable buffer");
}

// Uses queries that are created and never begin. Drivers differ in the values they write, and in the effect of such a
// condition. The name is one that has counted before.
void neverBegun() {
    GLuint query = 0;
    glGenQueries(1, &query);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    box(0.85F, 0.85F, 0.1F, 0.1F, 0.1F);
    glEndQuery(GL_SAMPLES_PASSED);
    showBits(30, waitFor(query));
    glDeleteQueries(1, &query);
    glCreateQueries(GL_SAMPLES_PASSED, 1, &query);
    showBits(29, waitFor(query));

    const GLuint64 before[2] = {0x123456789abcdefULL, 0xfedcba987654321ULL};
    GLuint buffer = 0;
    glCreateBuffers(1, &buffer);
    glNamedBufferData(buffer, sizeof before, before, GL_STATIC_COPY);
    glGetQueryBufferObjectui64v(query, buffer, GL_QUERY_RESULT, 3);
    GLuint now[4] = {};
    glGetNamedBufferSubData(buffer, 0, sizeof now, now);
    for (int i = 0; i < 4; ++i) showBits(28 - i, now[i]);
    glDeleteBuffers(1, &buffer);

    glBeginConditionalRender(query, GL_QUERY_WAIT);
    box(-0.9F, 0.35F, 0.3F, 0.3F, 0.2F);
    glClear(0);
    glEndConditionalRender();
    glBeginConditionalRender(query, GL_QUERY_WAIT_INVERTED);
    box(-0.5F, 0.35F, 0.3F, 0.3F, 0.2F);
    glEndConditionalRender();
    glDeleteQueries(1, &query);
    checkNoError("with a query that never began");
}

void countStatistics() {
    glBeginQuery(GL_VERTICES_SUBMITTED_ARB, names[9]);
    glBeginQuery(GL_VERTEX_SHADER_INVOCATIONS_ARB, names[10]);
    box(0.75F, 0.1F, 0.2F, 0.2F, 0.1F);
    glEndQuery(GL_VERTEX_SHADER_INVOCATIONS_ARB);
    glEndQuery(GL_VERTICES_SUBMITTED_ARB);
    showBits(31, waitFor(names[9]) * 256 + waitFor(names[10]));
}

void setUp() {
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    program = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 430\nlayout(location=0) uniform vec4 box; layout(location=1) uniform float depth; out vec3 tint;\n"
          "void main() { vec2 c = vec2(gl_VertexID & 1, gl_VertexID >> 1); tint = vec3(c, depth);\n"
          "gl_Position = vec4(box.xy + c * box.zw + vec2(0.02) * float(gl_InstanceID), depth, 1); }\n"},
         {GL_FRAGMENT_SHADER,
          "#version 430\nin vec3 tint; out vec4 result; void main() { result = vec4(tint, 1); }\n"}},
        [](unsigned linking) {
            const char* const varying = "tint";
            glTransformFeedbackVaryings(linking, 1, &varying, GL_INTERLEAVED_ATTRIBS);
        });
    streamsProgram = buildProgram(
        {{GL_VERTEX_SHADER, "#version 430\nvoid main() { gl_Position = vec4(0); }\n"},
         {GL_GEOMETRY_SHADER, "#version 430\nlayout(points) in; layout(points, max_vertices=40) out; "
                              "layout(location=0) uniform int emitted;\n"
                              "layout(stream=0) out vec4 first; layout(stream=1) out vec4 second;\n"
                              "void main() { first = vec4(0); EmitStreamVertex(0);\n"
                              "for (int i = 0; i < emitted; ++i) { second = vec4(i); EmitStreamVertex(1); } }\n"},
         {GL_FRAGMENT_SHADER, "#version 430\nvoid main() {}\n"}},
        [](unsigned linking) {
            const char* const varyings[] = {"first", "gl_NextBuffer", "second"};
            glTransformFeedbackVaryings(linking, 3, varyings, GL_INTERLEAVED_ATTRIBS);
        });
    glGenQueries(15, names);
    const GLuint zeros[64] = {};
    glGenBuffers(1, &resultBuffer);
    glBindBuffer(GL_QUERY_BUFFER, resultBuffer);
    glBufferData(GL_QUERY_BUFFER, 64, zeros, GL_DYNAMIC_COPY);
    glBindBuffer(GL_QUERY_BUFFER, 0);
    glGenBuffers(1, &feedbackBuffer);
    glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, feedbackBuffer);
    glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, 4 * 36, zeros, GL_DYNAMIC_COPY); // four triangles
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 5};
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window&, int frame) {
            glClearColor(0.05F, 0.1F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            glEnable(GL_DEPTH_TEST);
            glUseProgram(program);
            countSamples(frame);
            countPrimitives(frame);
            countStreams(frame);
            measureTime();
            renderConditionally(frame);
            resultIntoBuffer(frame);
            resultIntoImmutableBuffer(frame);
            neverBegun();
            countStatistics();
        });
}
