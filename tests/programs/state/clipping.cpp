// Clipping: clip planes of the fixed function, gl_ClipVertex, gl_ClipDistance, gl_CullDistance, near and far planes,
// depth clamp, several viewports and scissors, glClipControl.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

GLuint clipVertex, clipDistance, cullDistance, severalViewports;

void setUp() {
    const char* const oldFragment = "#version 120\nvarying vec4 tint; void main() { gl_FragColor = tint; }\n";
    const char* const newFragment =
        "#version 450 compatibility\nin vec4 tint; out vec4 result; void main() { result = tint; }\n";
    clipVertex = buildProgram(
        {{GL_VERTEX_SHADER, "#version 120\nvarying vec4 tint; void main() { tint = gl_Color;\n"
                            "gl_ClipVertex = gl_ModelViewMatrix * gl_Vertex; gl_Position = ftransform(); }\n"},
         {GL_FRAGMENT_SHADER, oldFragment}});
    clipDistance = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 450 compatibility\nout vec4 tint; uniform float shift; void main() { tint = gl_Color;\n"
          "gl_ClipDistance[0] = gl_Vertex.x - 20.0 - shift; gl_ClipDistance[1] = 48.0 - gl_Vertex.x - gl_Vertex.y * "
          "0.3;\n"
          "gl_Position = ftransform(); }\n"},
         {GL_FRAGMENT_SHADER, newFragment}});
    cullDistance = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 450 compatibility\nout vec4 tint; uniform float shift; void main() { tint = gl_Color;\n"
          "gl_CullDistance[0] = gl_Vertex.x - 25.0 - shift; gl_Position = ftransform(); }\n"},
         {GL_FRAGMENT_SHADER, newFragment}});
    severalViewports = buildProgram(
        {{GL_VERTEX_SHADER, "#version 450 compatibility\nout vec4 color; void main() { color = gl_Color; gl_Position = "
                            "ftransform(); }\n"},
         {GL_GEOMETRY_SHADER, "#version 450 compatibility\nlayout(triangles, invocations=4) in;\n"
                              "layout(triangle_strip, max_vertices=3) out; in vec4 color[]; out vec4 tint;\n"
                              "void main() { for (int i = 0; i < 3; ++i) { gl_ViewportIndex = gl_InvocationID;\n"
                              "tint = color[i] * vec4(1, 0.4 + 0.2 * float(gl_InvocationID), 1, 1);\n"
                              "gl_Position = gl_in[i].gl_Position; EmitVertex(); } EndPrimitive(); }\n"},
         {GL_FRAGMENT_SHADER, newFragment}});
}

// Draws triangles within 60×45 units, some through the near and far planes.
void drawTriangles(int frame) {
    Sequence numbers(unsigned(frame) + 3);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 24; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex3f(numbers.unit() * 60, numbers.unit() * 45, numbers.unit() * 3.4F - 1.7F);
    }
    glEnd();
}

// Draws triangles, a line and points.
void drawShapes(int frame) {
    drawTriangles(frame);
    glLineWidth(3);
    glPointSize(6);
    glBegin(GL_LINES);
    glColor3f(1, 1, 1);
    glVertex3f(2, 40, 0), glVertex3f(58, 5, 0);
    glEnd();
    glBegin(GL_POINTS);
    for (int i = 0; i < 6; ++i) {
        glVertex3f(float(i) * 11 + 1, 22, 0);
    }
    glEnd();
}

void enterCell(int cell) {
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glTranslatef(3 + float(cell % 4) * 62, 3 + float(cell / 4) * 47, 0);
}

void drawPlanes(int frame) {
    enterCell(0);
    const GLdouble left[] = {1, 0.2, 0, -15.0 - frame * 3};
    const GLdouble top[] = {-0.3, -1, 0, 45};
    glClipPlane(GL_CLIP_PLANE0, left);
    glClipPlane(GL_CLIP_PLANE3, top);
    glEnable(GL_CLIP_PLANE0);
    drawShapes(frame);
    enterCell(1);
    glClipPlane(GL_CLIP_PLANE0, left);
    glEnable(GL_CLIP_PLANE3);
    drawShapes(frame);
    glUseProgram(clipVertex);
    enterCell(2);
    glClipPlane(GL_CLIP_PLANE0, left);
    glClipPlane(GL_CLIP_PLANE3, top);
    drawShapes(frame + 1);
    glUseProgram(0);
    glDisable(GL_CLIP_PLANE0);
    glDisable(GL_CLIP_PLANE3);
    GLdouble readBack[4];
    glGetClipPlane(GL_CLIP_PLANE0, readBack);
    showBits(37, float(readBack[3]));
}

void drawDistances(int frame) {
    glUseProgram(clipDistance);
    glUniform1f(glGetUniformLocation(clipDistance, "shift"), float(frame));
    enterCell(3);
    glEnable(GL_CLIP_DISTANCE0);
    drawShapes(frame);
    enterCell(4);
    glEnable(GL_CLIP_DISTANCE1);
    drawShapes(frame);
    glDisable(GL_CLIP_DISTANCE0);
    glDisable(GL_CLIP_DISTANCE1);
    glUseProgram(cullDistance);
    glUniform1f(glGetUniformLocation(cullDistance, "shift"), float(frame));
    enterCell(5);
    drawShapes(frame + 2);
    glUseProgram(0);
    enterCell(6);
    glEnable(GL_DEPTH_CLAMP);
    glEnable(GL_DEPTH_TEST);
    drawShapes(frame);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_DEPTH_CLAMP);
}

void drawViewports(Window& window, int frame) {
    const auto w = float(window.width());
    const auto h = float(window.height());
    const auto iw = window.width();
    const auto ih = window.height();
    for (GLuint i = 0; i < 4; ++i) {
        const float x = w * (0.05F + 0.2F * float(i)) + 0.5F * float(frame);
        glViewportIndexedf(i, x, h * 0.52F, w * 0.8F, h * 0.8F);
        glScissorIndexed(i, int(i) * iw / 5 + 4, ih / 2 + int(i) * 3, iw / 6, ih / 5);
        glDepthRangeIndexed(i, 0.1 * i, 1);
        if (i != 2) {
            glEnablei(GL_SCISSOR_TEST, i);
        }
    }
    glUseProgram(severalViewports);
    enterCell(0);
    drawTriangles(frame);
    glUseProgram(0);
    glDisable(GL_SCISSOR_TEST);
    GLfloat boxes[8] = {0, 0, w, h, 0, 0, w, h};
    glViewportArrayv(0, 2, boxes);
    const GLint scissors[8] = {0, 0, iw, ih, 1, 1, iw / 2, ih / 2};
    glScissorArrayv(0, 2, scissors);
    glDepthRange(0, 1);
    glViewport(0, 0, iw, ih);
    glScissor(0, 0, iw, ih);
}

void drawUpsideDown(int frame) {
    glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_CULL_FACE);
    enterCell(frame % 4);
    drawShapes(frame + 4);
    glDisable(GL_CULL_FACE);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Compatibility, 4, 5};
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window& window, int frame) {
            glViewport(0, 0, window.width(), window.height());
            glClearColor(0.1F, 0.1F, 0.16F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            glMatrixMode(GL_PROJECTION);
            glLoadIdentity();
            glOrtho(0, 250, 0, 190, -1, 1);
            drawPlanes(frame);
            drawDistances(frame);
            drawViewports(window, frame);
            drawUpsideDown(frame);
        });
}
