// OpenGL ES 1.1 through EGL: fixed-point and float entry points, arrays, matrices, lights, fog, textures.
#include <EGL/egl.h>
#include <GLES/gl.h>
#include <GLES/glext.h>

#include <cstring>

#include "tests/programs/support/program.hpp"

using namespace programs;

namespace {

GLuint texture, buffer;

constexpr GLfixed fixed(float value) { return static_cast<GLfixed>(value * 65536.0F); }

void setUp() {
    GLubyte texels[8 * 8 * 3];
    for (int i = 0; i < 192; ++i) {
        texels[i] = GLubyte((i * 83 + 11) % 256);
    }
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameterx(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, 8, 8, 0, GL_RGB, GL_UNSIGNED_BYTE, texels);
    const GLfixed places[] = {fixed(0), fixed(0), fixed(40), fixed(0), fixed(0), fixed(30), fixed(40), fixed(30)};
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, sizeof places, places, GL_STATIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void quad(float x, float y) {
    glLoadIdentity();
    glTranslatex(fixed(x), fixed(y), 0);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

template <class Function> Function find(const char* name) {
    const auto found = reinterpret_cast<Function>(eglGetProcAddress(name));
    if (!found) fail("%s is not there", name);
    return found;
}

// Calls the same commands through the names of OES_fixed_point.
void drawInFog(int frame) {
    const auto* extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
    if (!extensions || !std::strstr(extensions, "GL_OES_fixed_point")) fail("GL_OES_fixed_point is not there");
    const GLfixed colour[] = {fixed(0.2F), fixed(0.7F), fixed(0.1F * float(frame)), fixed(1)};
    find<PFNGLFOGXVOESPROC>("glFogxvOES")(GL_FOG_COLOR, colour);
    find<PFNGLFOGXOESPROC>("glFogxOES")(GL_FOG_MODE, GL_LINEAR);
    find<PFNGLFOGXOESPROC>("glFogxOES")(GL_FOG_START, fixed(-1));
    find<PFNGLMATERIALXVOESPROC>("glMaterialxvOES")(GL_FRONT_AND_BACK, GL_AMBIENT, colour);
    find<PFNGLLIGHTMODELXVOESPROC>("glLightModelxvOES")(GL_LIGHT_MODEL_AMBIENT, colour);
    glEnable(GL_FOG);
    glEnable(GL_LIGHTING);
    find<PFNGLCOLOR4XOESPROC>("glColor4xOES")(fixed(1), fixed(0.3F), 0, fixed(1));
    glLoadIdentity();
    find<PFNGLTRANSLATEXOESPROC>("glTranslatexOES")(fixed(10), fixed(120), fixed(-0.5F));
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_LIGHTING);
    glTranslatef(60, 0, 0.2F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_FOG);
}

// Draws the middle of the window, where tiles meet, again in a corner.
void drawCopyOfWindow() {
    const GLfloat corners[] = {190, 130, 240, 130, 190, 180, 240, 180};
    const GLfloat coordinates[] = {0, 0, 1, 0, 0, 1, 1, 1};
    GLint viewport[4] = {};
    glGetIntegerv(GL_VIEWPORT, viewport);
    GLuint copy = 0;
    glGenTextures(1, &copy);
    glBindTexture(GL_TEXTURE_2D, copy);
    glTexParameterx(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, viewport[2] / 2 - 32, viewport[3] / 2 - 32, 64, 64, 0);
    glLoadIdentity();
    glEnable(GL_TEXTURE_2D);
    glTexEnvx(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    glTexCoordPointer(2, GL_FLOAT, 0, coordinates);
    glVertexPointer(2, GL_FLOAT, 0, corners);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisableClientState(GL_TEXTURE_COORD_ARRAY);
    glDisable(GL_TEXTURE_2D);
    glDeleteTextures(1, &copy);
    glBindTexture(GL_TEXTURE_2D, texture);
}

// Calls evaluators, which no context of OpenGL ES has, although their names are known.
void refuseEvaluators() {
    const auto evaluate = reinterpret_cast<void (*)(GLfixed)>(eglGetProcAddress("glEvalCoord1xOES"));
    const auto vertex = reinterpret_cast<void (*)(GLfixed, GLfixed)>(eglGetProcAddress("glVertex2xOES"));
    if (evaluate == nullptr || vertex == nullptr) {
        return;
    }
    evaluate(fixed(0.5F));
    const bool one = glGetError() != GL_NO_ERROR;
    vertex(fixed(1), fixed(1));
    const bool other = glGetError() != GL_NO_ERROR;
    glClearColorx(one ? fixed(1) : 0, other ? fixed(1) : 0, fixed(0.5F), fixed(1));
    glEnable(GL_SCISSOR_TEST);
    glScissor(230, 170, 15, 15);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
}

void draw(int frame) {
    const GLbyte coordinates[] = {0, 0, 2, 0, 0, 2, 2, 2};
    const GLubyte colors[] = {255, 0, 0, 255, 0, 255, GLubyte(frame * 50), 255, 0, 0, 255, 255, 255, 255, 0, 255};
    glEnableClientState(GL_VERTEX_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glVertexPointer(2, GL_FIXED, 0, nullptr);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glColor4x(fixed(0.9F), fixed(0.4F), fixed(0.1F * float(frame)), fixed(1));
    quad(10, 10);
    glEnableClientState(GL_COLOR_ARRAY);
    glColorPointer(4, GL_UNSIGNED_BYTE, 0, colors);
    quad(60, 10);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    glTexCoordPointer(2, GL_BYTE, 0, coordinates);
    glEnable(GL_TEXTURE_2D);
    glTexEnvx(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, frame % 2 == 0 ? GL_MODULATE : GL_DECAL);
    quad(110, 10);
    glDisableClientState(GL_COLOR_ARRAY);
    glColor4ub(200, GLubyte(40 * frame), 255, 255);
    quad(160, 10);
    glDisable(GL_TEXTURE_2D);
    glDisableClientState(GL_TEXTURE_COORD_ARRAY);
    const GLfixed direction[] = {fixed(0.3F), fixed(0.2F * float(frame)), fixed(1), 0};
    glLightxv(GL_LIGHT0, GL_POSITION, direction);
    glMaterialx(GL_FRONT_AND_BACK, GL_SHININESS, fixed(12));
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glNormal3x(0, fixed(0.4F), fixed(0.9F));
    quad(10, 60);
    glDisable(GL_LIGHTING);
    const GLushort order[] = {0, 1, 3, 0, 3, 2};
    glLoadIdentity();
    glTranslatef(60, 60, 0);
    glRotatex(fixed(float(frame) * 9), 0, 0, fixed(1));
    glScalef(0.8F, 0.8F, 1);
    glPushMatrix();
    glDrawElements(GL_TRIANGLES, 6, GL_UNSIGNED_SHORT, order);
    glPopMatrix();
    glPointSizex(fixed(7));
    glTranslatef(80, 0, 0);
    glDrawArrays(GL_POINTS, 0, 4);
    glLineWidthx(fixed(3));
    glTranslatef(60, 0, 0);
    glDrawArrays(GL_LINE_LOOP, 0, 4);
    drawInFog(frame);
    drawCopyOfWindow();
    refuseEvaluators();
    glDisableClientState(GL_VERTEX_ARRAY);
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec;
    spec.profile = Profile::Es;
    spec.major = 1;
    spec.minor = 1;
    return runInEglWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window&, int frame) {
            glClearColorx(fixed(0.1F), fixed(0.2F), fixed(0.1F), fixed(1));
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            glMatrixMode(GL_PROJECTION);
            glLoadIdentity();
            glOrthof(0, 250, 0, 190, -1, 1);
            glMatrixMode(GL_MODELVIEW);
            draw(frame);
        });
}
