// glPushAttrib and glPushClientAttrib with each group: state is changed inside and must be restored afterwards.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

GLuint textures[2];

void shape(int cell) {
    const float x = 6 + float(cell % 6) * 40;
    const float y = 6 + float(cell / 6) * 30;
    glBegin(GL_TRIANGLE_FAN);
    glNormal3f(0, 0.3F, 1);
    glTexCoord2f(0, 0), glVertex3f(x, y, 0.1F);
    glTexCoord2f(1, 0), glVertex3f(x + 34, y + 2, 0.2F);
    glTexCoord2f(1, 1), glVertex3f(x + 30, y + 24, -0.3F);
    glTexCoord2f(0, 1), glVertex3f(x + 3, y + 20, 0.5F);
    glEnd();
}

// Changes much of the state of the group. glPopAttrib must restore all of it.
void change(GLbitfield group, Window& window, int frame) {
    const GLfloat color[] = {0.9F, 0.3F, 0.1F * float(frame), 1};
    switch (group) {
    case GL_CURRENT_BIT: glColor4fv(color); break;
    case GL_POINT_BIT: glPointSize(7); break;
    case GL_LINE_BIT: glLineWidth(4), glEnable(GL_LINE_STIPPLE), glLineStipple(2, 0x5a5a); break;
    case GL_POLYGON_BIT: glPolygonMode(GL_FRONT_AND_BACK, GL_LINE), glFrontFace(GL_CW); break;
    case GL_POLYGON_STIPPLE_BIT: {
        GLubyte pattern[128];
        Sequence numbers{unsigned(frame)};
        for (GLubyte& value : pattern) {
            value = numbers.byte();
        }
        glPolygonStipple(pattern);
        break;
    }
    case GL_LIGHTING_BIT:
        glEnable(GL_LIGHTING), glEnable(GL_LIGHT3), glLightfv(GL_LIGHT3, GL_DIFFUSE, color);
        glShadeModel(GL_FLAT);
        break;
    case GL_FOG_BIT: glEnable(GL_FOG), glFogfv(GL_FOG_COLOR, color), glFogf(GL_FOG_DENSITY, 0.9F); break;
    case GL_DEPTH_BUFFER_BIT: glEnable(GL_DEPTH_TEST), glDepthFunc(GL_GREATER), glClearDepth(0.2); break;
    case GL_STENCIL_BUFFER_BIT: glEnable(GL_STENCIL_TEST), glStencilFunc(GL_NEVER, 1, 1); break;
    case GL_VIEWPORT_BIT: glViewport(0, 0, window.width() / 2, window.height() / 2), glDepthRange(0.3, 0.4); break;
    case GL_TRANSFORM_BIT: glMatrixMode(GL_TEXTURE), glEnable(GL_CLIP_PLANE1); break;
    case GL_ENABLE_BIT: glEnable(GL_BLEND), glEnable(GL_TEXTURE_2D), glEnable(GL_CULL_FACE); break;
    case GL_COLOR_BUFFER_BIT:
        glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE), glEnable(GL_BLEND), glBlendFunc(GL_ONE, GL_ONE);
        glClearColor(1, 1, 1, 1);
        break;
    case GL_TEXTURE_BIT:
        glBindTexture(GL_TEXTURE_2D, textures[1]), glEnable(GL_TEXTURE_2D);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        break;
    case GL_SCISSOR_BIT: glEnable(GL_SCISSOR_TEST), glScissor(0, 0, window.width() / 2, window.height() / 2); break;
    case GL_PIXEL_MODE_BIT: glPixelTransferf(GL_RED_SCALE, 0.1F), glPixelZoom(2, 2); break;
    case GL_HINT_BIT: glHint(GL_FOG_HINT, GL_NICEST); break;
    case GL_LIST_BIT: glListBase(77); break;
    case GL_MULTISAMPLE_BIT: glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE); break;
    default: break;
    }
}

void pushEach(Window& window, int frame) {
    const GLbitfield groups[] = {
        GL_CURRENT_BIT,    GL_POINT_BIT,  GL_LINE_BIT,         GL_POLYGON_BIT,        GL_POLYGON_STIPPLE_BIT,
        GL_LIGHTING_BIT,   GL_FOG_BIT,    GL_DEPTH_BUFFER_BIT, GL_STENCIL_BUFFER_BIT, GL_VIEWPORT_BIT,
        GL_TRANSFORM_BIT,  GL_ENABLE_BIT, GL_COLOR_BUFFER_BIT, GL_TEXTURE_BIT,        GL_SCISSOR_BIT,
        GL_PIXEL_MODE_BIT, GL_HINT_BIT,   GL_LIST_BIT,         GL_MULTISAMPLE_BIT};
    int cell = 0;
    for (const GLbitfield group : groups) {
        glColor3f(0.3F, 0.3F + 0.03F * float(cell), 0.8F);
        glPushAttrib(group);
        change(group, window, frame);
        shape(cell);
        glPopAttrib();
        ++cell;
    }
    for (int i = 0; i < 4; ++i) {
        glColor3f(0.9F, 0.9F, 0.2F * float(i));
        shape(20 + i); // in the initial state
    }
}

// Pushes all groups at once, deeply nested.
void pushNested(Window& window, int frame) {
    for (int depth = 0; depth < 6; ++depth) {
        glPushAttrib(GL_ALL_ATTRIB_BITS);
        glPushClientAttrib(GL_CLIENT_ALL_ATTRIB_BITS);
        glScissor(10 + depth * 9 + frame, window.height() - 60 + depth * 7, 100 - depth * 15, 30);
        glEnable(GL_SCISSOR_TEST);
        glClearColor(0.15F * float(depth), 0.4F, 0.1F * float(frame), 1);
        glClear(GL_COLOR_BUFFER_BIT);
        glPixelStorei(GL_UNPACK_SKIP_ROWS, depth);
        glEnableClientState(GL_COLOR_ARRAY);
    }
    GLint depths[2];
    glGetIntegerv(GL_ATTRIB_STACK_DEPTH, depths);
    glGetIntegerv(GL_CLIENT_ATTRIB_STACK_DEPTH, depths + 1);
    for (int depth = 0; depth < 6; ++depth) {
        glPopClientAttrib();
        glPopAttrib();
    }
    showBits(37, std::uint32_t(depths[0] * 256 + depths[1]));
    GLint rows = -1;
    glGetIntegerv(GL_UNPACK_SKIP_ROWS, &rows);
    showBits(36, std::uint32_t(rows));
    showBits(35, glIsEnabled(GL_COLOR_ARRAY) == GL_TRUE ? 1U : 2U);
}

// Checks that the pop restores current values after a primitive, also when a texture changed in between.
void popBehindAPrimitive() {
    glPushAttrib(GL_ALL_ATTRIB_BITS);
    glBegin(GL_POINTS);
    glNormal3f(0.5F, 0.25F, 1);
    glVertex2f(3, 3);
    glEnd();
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, 4, 4, 0, GL_RED, GL_UNSIGNED_BYTE, nullptr);
    glPopAttrib();
    GLfloat normal[3] = {};
    glGetFloatv(GL_CURRENT_NORMAL, normal);
    showBits(34, normal[0]);
    glDeleteTextures(1, &texture);
}

// EXT_direct_state_access: resets the client state to its defaults, on the stack and permanently.
void defaultClientState() {
    GLubyte texels[16 * 16 * 4];
    Sequence numbers(77);
    for (GLubyte& value : texels) {
        value = numbers.byte();
    }
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    glBufferData(GL_PIXEL_UNPACK_BUFFER, sizeof texels, texels, GL_STATIC_DRAW);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 13);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, 2);
    glPushClientAttribDefaultEXT(GL_CLIENT_PIXEL_STORE_BIT);
    glWindowPos2i(5, 5);
    glDrawPixels(8, 8, GL_RGBA, GL_UNSIGNED_BYTE, texels + 64); // no buffer is bound now
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    glWindowPos2i(15, 5);
    glDrawPixels(8, 8, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glPopClientAttrib();
    glWindowPos2i(25, 5);
    glDrawPixels(8, 8, GL_RGBA, GL_UNSIGNED_BYTE, nullptr); // the buffer and its row length again
    glClientAttribDefaultEXT(GL_CLIENT_PIXEL_STORE_BIT);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    glWindowPos2i(35, 5);
    glDrawPixels(8, 8, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glDeleteBuffers(1, &buffer);
}

void setUp() {
    glGenTextures(2, textures);
    for (int i = 1; i >= 0; --i) {
        GLubyte texels[4 * 4 * 4];
        Sequence numbers(unsigned(i) + 13);
        for (GLubyte& value : texels) {
            value = numbers.byte();
        }
        glBindTexture(GL_TEXTURE_2D, textures[i]);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    }
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {}, [](Window&) { setUp(); },
        [](Window& window, int frame) {
            glViewport(0, 0, window.width(), window.height());
            glClearColor(0.1F, 0.1F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
            glMatrixMode(GL_PROJECTION);
            glLoadIdentity();
            glOrtho(0, 250, 0, 190, -1, 1);
            glMatrixMode(GL_MODELVIEW);
            defaultClientState();
            pushEach(window, frame);
            pushNested(window, frame);
            popBehindAPrimitive();
        });
}
