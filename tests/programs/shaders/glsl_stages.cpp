// Tessellation, geometry shaders with all kinds of input, and transform feedback (separate, interleaved, paused,
// several streams) drawn again with glDrawTransformFeedback.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <string>

using namespace programs;

namespace {

GLuint vertexArray, tessellated, isolines, defaultLevels, grass, adjacency, capturing, drawing;
GLuint feedback, feedbackBuffer, secondFeedback, secondBuffer, controlPoints;

const char* const kPass =
    "#version 400\nlayout(location=0) in vec2 place; void main() { gl_Position = vec4(place, 0, 1); }\n";
const char* const kPaint = "#version 400\nin vec3 tint; out vec4 result; void main() { result = vec4(tint, 1); }\n";

void makeTessellation() {
    const char* const control =
        "#version 400\nlayout(vertices=4) out; uniform float level; void main() {\n"
        "gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;\n"
        "gl_TessLevelOuter[0] = level; gl_TessLevelOuter[1] = level + 1.0; gl_TessLevelOuter[2] = 3.0;\n"
        "gl_TessLevelOuter[3] = 5.0; gl_TessLevelInner[0] = level; gl_TessLevelInner[1] = 4.0; }\n";
    const char* const bilinear = " in; out vec3 tint; void main() {\n"
                                 "vec4 a = mix(gl_in[0].gl_Position, gl_in[1].gl_Position, gl_TessCoord.x);\n"
                                 "vec4 b = mix(gl_in[3].gl_Position, gl_in[2].gl_Position, gl_TessCoord.x);\n"
                                 "tint = vec3(gl_TessCoord.xy, 0.4); gl_Position = mix(a, b, gl_TessCoord.y);\n"
                                 "gl_Position.y += sin(gl_TessCoord.x * 6.0) * 0.05; }\n";
    const std::string quads = std::string("#version 400\nlayout(quads, fractional_odd_spacing, ccw)") + bilinear;
    const std::string lines = std::string("#version 400\nlayout(isolines, equal_spacing)") + bilinear;
    tessellated = buildProgram({{GL_VERTEX_SHADER, kPass},
                                {GL_TESS_CONTROL_SHADER, control},
                                {GL_TESS_EVALUATION_SHADER, quads.c_str()},
                                {GL_FRAGMENT_SHADER, kPaint}});
    isolines = buildProgram({{GL_VERTEX_SHADER, kPass},
                             {GL_TESS_CONTROL_SHADER, control},
                             {GL_TESS_EVALUATION_SHADER, lines.c_str()},
                             {GL_FRAGMENT_SHADER, kPaint}});
    defaultLevels = buildProgram(
        {{GL_VERTEX_SHADER, kPass},
         {GL_TESS_EVALUATION_SHADER,
          "#version 400\nlayout(triangles, fractional_even_spacing, point_mode) in; out vec3 tint; void main() {\n"
          "tint = gl_TessCoord; gl_Position = gl_TessCoord.x * gl_in[0].gl_Position + gl_TessCoord.y * "
          "gl_in[1].gl_Position\n"
          "+ gl_TessCoord.z * gl_in[2].gl_Position; gl_PointSize = 3.0; }\n"},
         {GL_FRAGMENT_SHADER, kPaint}});
}

void makeGeometry() {
    grass = buildProgram(
        {{GL_VERTEX_SHADER, kPass},
         {GL_GEOMETRY_SHADER,
          "#version 400\nlayout(points, invocations=3) in; layout(triangle_strip, max_vertices=5) out;\n"
          "out vec3 tint; uniform float sway; void main() { vec4 p = gl_in[0].gl_Position;\n"
          "float s = float(gl_InvocationID) * 0.05; for (int i = 0; i < 5; ++i) {\n"
          "tint = vec3(0.2, 0.2 * float(i), s * 6.0); gl_PrimitiveID = gl_PrimitiveIDIn;\n"
          "gl_Position = p + vec4(s + float(i % 2) * 0.03 + sway * float(i) * 0.02, float(i) * 0.05, 0, 0);\n"
          "EmitVertex(); } EndPrimitive(); }\n"},
         {GL_FRAGMENT_SHADER, kPaint}});
    adjacency = buildProgram(
        {{GL_VERTEX_SHADER, kPass},
         {GL_GEOMETRY_SHADER,
          "#version 400\nlayout(triangles_adjacency) in; layout(line_strip, max_vertices=8) out; out vec3 tint;\n"
          "void main() { for (int i = 0; i < 6; ++i) { tint = vec3(float(i) / 5.0, 0.9, 0.3);\n"
          "gl_Position = gl_in[i].gl_Position; EmitVertex(); } EndPrimitive(); }\n"},
         {GL_FRAGMENT_SHADER, kPaint}});
}

void makeFeedback() {
    capturing = buildProgram(
        {{GL_VERTEX_SHADER, "#version 400\nuniform float turn; out vec2 moved; out vec3 hue; void main() {\n"
                            "float a = float(gl_VertexID) * 1.9 + turn; moved = vec2(cos(a), sin(a)) * (0.1 + 0.01 * "
                            "float(gl_VertexID));\n"
                            "hue = vec3(fract(a), 0.7, fract(a * 0.3)); gl_Position = vec4(moved, 0, 1); }\n"},
         {GL_FRAGMENT_SHADER, "#version 400\nout vec4 r; void main() { r = vec4(1); }\n"}},
        [](unsigned program) {
            const char* const varyings[] = {"moved", "gl_SkipComponents1", "hue"};
            glTransformFeedbackVaryings(program, 3, varyings, GL_INTERLEAVED_ATTRIBS);
        });
    drawing = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 400\nlayout(location=0) in vec2 place; layout(location=1) in vec3 hue; out vec3 tint;\n"
          "uniform vec2 offset; void main() { tint = hue; gl_Position = vec4(place + offset, 0, 1); }\n"},
         {GL_FRAGMENT_SHADER, kPaint}});
    const GLfloat zeros[24 * 6 * 2] = {};
    GLuint names[2];
    glGenTransformFeedbacks(2, names);
    feedback = names[0], secondFeedback = names[1];
    glGenBuffers(2, names);
    feedbackBuffer = names[0], secondBuffer = names[1];
    for (int i = 0; i < 2; ++i) {
        glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, i == 0 ? feedback : secondFeedback);
        glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, names[i]);
        glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, sizeof zeros, zeros, GL_DYNAMIC_COPY);
        glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, names[i]);
    }
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
}

void setPlaces(const GLfloat* places, GLsizeiptr count) {
    glBindBuffer(GL_ARRAY_BUFFER, controlPoints);
    glBufferData(GL_ARRAY_BUFFER, count * 8, places, GL_STREAM_DRAW);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(0);
}

void drawTessellation(int frame) {
    const GLfloat patches[] = {-0.95F, 0.1F, -0.4F, 0.15F, -0.45F, 0.8F,  -0.9F,  0.9F,
                               -0.3F,  0.1F, 0.25F, 0.15F, 0.3F,   0.85F, -0.25F, 0.8F};
    setPlaces(patches, 8);
    glPatchParameteri(GL_PATCH_VERTICES, 4);
    glUseProgram(tessellated);
    glUniform1f(glGetUniformLocation(tessellated, "level"), 2.0F + 0.7F * float(frame));
    glDrawArrays(GL_PATCHES, 0, 4);
    glUseProgram(isolines);
    glUniform1f(glGetUniformLocation(isolines, "level"), 4.0F + float(frame));
    glDrawArrays(GL_PATCHES, 4, 4);
    const GLfloat outer[] = {5, 3.5F + float(frame), 4, 1};
    const GLfloat inner[] = {4.5F, 1};
    glPatchParameterfv(GL_PATCH_DEFAULT_OUTER_LEVEL, outer);
    glPatchParameterfv(GL_PATCH_DEFAULT_INNER_LEVEL, inner);
    glPatchParameteri(GL_PATCH_VERTICES, 3);
    const GLfloat triangle[] = {0.4F, 0.1F, 0.95F, 0.2F, 0.6F, 0.9F};
    setPlaces(triangle, 3);
    glUseProgram(defaultLevels);
    glEnable(GL_PROGRAM_POINT_SIZE);
    glDrawArrays(GL_PATCHES, 0, 3);
    glDisable(GL_PROGRAM_POINT_SIZE);
}

void drawGeometry(int frame) {
    GLfloat places[24];
    for (int i = 0; i < 12; ++i) {
        places[i * 2] = -0.95F + 0.075F * float(i);
        places[i * 2 + 1] = -0.3F + 0.02F * float((i * frame) % 5);
    }
    setPlaces(places, 12);
    glUseProgram(grass);
    glUniform1f(glGetUniformLocation(grass, "sway"), float(frame) - 1);
    glDrawArrays(GL_POINTS, 0, 12);
    for (int i = 0; i < 12; ++i) {
        places[i * 2] = 0.1F + 0.07F * float((i * 5) % 12);
        places[i * 2 + 1] = -0.35F + 0.06F * float((i * 7 + frame) % 6);
    }
    setPlaces(places, 12);
    glUseProgram(adjacency);
    glDrawArrays(GL_TRIANGLES_ADJACENCY, 0, 12);
}

void capture(int frame) {
    glEnable(GL_RASTERIZER_DISCARD);
    glUseProgram(capturing);
    glUniform1f(glGetUniformLocation(capturing, "turn"), float(frame) * 0.4F);
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, feedback);
    glBeginTransformFeedback(GL_TRIANGLES);
    glDrawArrays(GL_TRIANGLES, 0, 9);
    glPauseTransformFeedback();
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, secondFeedback);
    glBeginTransformFeedback(GL_TRIANGLES); // Mesa 22 compares a resumed one with the mode that began last
    glDrawArrays(GL_TRIANGLES, 3, 9 + 3 * (frame % 2));
    glEndTransformFeedback();
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, feedback);
    glResumeTransformFeedback();
    glDrawArrays(GL_TRIANGLES, 12, 3 + 3 * (frame % 3));
    glEndTransformFeedback();
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
    glDisable(GL_RASTERIZER_DISCARD);
}

void drawCaptured() {
    glUseProgram(drawing);
    const GLint offset = glGetUniformLocation(drawing, "offset");
    glEnableVertexAttribArray(1);
    for (int i = 0; i < 2; ++i) {
        glBindBuffer(GL_ARRAY_BUFFER, i == 0 ? feedbackBuffer : secondBuffer);
        glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 24, nullptr);
        glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, 24, reinterpret_cast<void*>(12));
        glUniform2f(offset, -0.6F + float(i) * 0.6F, -0.7F);
        if (i == 0) {
            glDrawTransformFeedback(GL_TRIANGLES, feedback);
        } else {
            glPointSize(4);
            glDrawTransformFeedback(GL_POINTS, secondFeedback);
            glUniform2f(offset, 0.6F, -0.7F);
            glDrawTransformFeedbackInstanced(GL_LINE_STRIP, secondFeedback, 1);
        }
    }
    glDisableVertexAttribArray(1);
    GLuint readBack[2] = {};
    glBindBuffer(GL_ARRAY_BUFFER, feedbackBuffer);
    glGetBufferSubData(GL_ARRAY_BUFFER, 24 * 8, sizeof readBack, readBack);
    showBits(0, readBack[0]);
    showBits(1, readBack[1]);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 3};
    return runInGlxWindow(
        argc, argv, spec,
        [](Window&) {
            glGenVertexArrays(1, &vertexArray);
            glBindVertexArray(vertexArray);
            glGenBuffers(1, &controlPoints);
            makeTessellation();
            makeGeometry();
            makeFeedback();
        },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.08F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            drawTessellation(frame);
            drawGeometry(frame);
            capture(frame);
            drawCaptured();
        });
}
