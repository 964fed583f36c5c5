// Display lists: nested, compile-and-execute, called through glCallLists with names of every type, and containing state
// (scissor, viewport, draw buffer, matrices, attribute stack, textures, arrays).
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <string>
#include <vector>

using namespace programs;

namespace {

GLuint glyphs; // 100 lists; each draws one small glyph and advances
GLuint scene, stateList, arrayList, pixelList, materialList;
GLuint textureList, conditionList, condition;

void drawGlyph(unsigned number) {
    Sequence numbers(number);
    glBegin(number % 3 == 0 ? GL_TRIANGLES : GL_QUADS);
    for (unsigned i = 0; i < (number % 3 == 0 ? 3U : 4U); ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        const float x = (i == 1 || i == 2) ? 7.0F : 0.0F;
        const float y = i >= 2 ? 9.0F : 0.0F;
        glVertex2f(x + numbers.unit(), y + numbers.unit());
    }
    glEnd();
    glTranslatef(8.5F, 0, 0);
}

void makeGlyphs() {
    glyphs = glGenLists(100);
    for (unsigned i = 0; i < 100; ++i) {
        glNewList(glyphs + i, GL_COMPILE);
        drawGlyph(i);
        glEndList();
    }
}

// Compiles a list from client memory, which is read during compilation. The array changes afterwards.
void makeArrayList() {
    GLfloat places[8] = {0, 0, 30, 0, 30, 20, 0, 20};
    GLubyte colors[16] = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 0, 255};
    const GLubyte order[] = {0, 1, 2, 0, 2, 3};
    arrayList = glGenLists(1);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    glVertexPointer(2, GL_FLOAT, 0, places);
    glColorPointer(4, GL_UNSIGNED_BYTE, 0, colors);
    glNewList(arrayList, GL_COMPILE);
    glDrawElements(GL_TRIANGLES, 6, GL_UNSIGNED_BYTE, order);
    glTranslatef(35, 0, 0);
    glDrawArrays(GL_LINE_LOOP, 0, 4);
    glBegin(GL_TRIANGLES);
    glArrayElement(1);
    glArrayElement(2);
    glArrayElement(3);
    glEnd();
    glEndList();
    glDisableClientState(GL_VERTEX_ARRAY);
    glDisableClientState(GL_COLOR_ARRAY);
    for (float& place : places) {
        place = -100;
    }
}

void makePixelList() {
    GLubyte pixels[9 * 7 * 3];
    GLubyte bits[20];
    Sequence numbers(11);
    for (GLubyte& value : pixels) {
        value = numbers.byte();
    }
    for (GLubyte& value : bits) {
        value = numbers.byte();
    }
    pixelList = glGenLists(1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glNewList(pixelList, GL_COMPILE);
    glRasterPos2f(5, 60);
    glPixelZoom(2, 1.5F);
    glDrawPixels(9, 7, GL_RGB, GL_UNSIGNED_BYTE, pixels);
    glPixelZoom(1, 1);
    glColor3f(1, 0.7F, 0.2F);
    glRasterPos2f(30, 60);
    glBitmap(13, 10, 0, 0, 15, 2, bits);
    glBitmap(13, 10, 0, 0, 15, 0, bits);
    glEndList();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void makeTextureList() {
    GLuint name = 0;
    glGenTextures(1, &name);
    GLubyte texels[4 * 4 * 4];
    Sequence numbers(23);
    for (GLubyte& value : texels) {
        value = numbers.byte();
    }
    textureList = glGenLists(1);
    glNewList(textureList, GL_COMPILE);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 1, 1, 2, 2, GL_RGBA, GL_UNSIGNED_BYTE, texels + 8);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    glEnable(GL_TEXTURE_2D);
    glBegin(GL_QUADS);
    glTexCoord2i(0, 0), glVertex2i(100, 90);
    glTexCoord2i(2, 0), glVertex2i(150, 90);
    glTexCoord2i(2, 1), glVertex2i(150, 120);
    glTexCoord2i(0, 1), glVertex2i(100, 120);
    glEnd();
    glDisable(GL_TEXTURE_2D);
    glEndList();
}

// Compiles a list that sets state and pops a part of it.
void makeStateList() {
    stateList = glGenLists(1);
    glNewList(stateList, GL_COMPILE);
    glPushAttrib(GL_SCISSOR_BIT | GL_VIEWPORT_BIT | GL_COLOR_BUFFER_BIT | GL_ENABLE_BIT);
    glEnable(GL_SCISSOR_TEST);
    glScissor(150, 10, 61, 43);
    glClearColor(0.3F, 0.1F, 0.4F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glViewport(140, 5, 83, 61);
    glDrawBuffer(GL_BACK);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE);
    glColorMask(GL_TRUE, GL_TRUE, GL_FALSE, GL_TRUE);
    glMatrixMode(GL_PROJECTION);
    glPushMatrix();
    const GLdouble matrix[16] = {0.06, 0, 0, 0, 0, 0.08, 0, 0, 0, 0, 1, 0, -1, -1, 0, 1};
    glLoadMatrixd(matrix);
    glMatrixMode(GL_MODELVIEW);
    glPushMatrix();
    glLoadIdentity();
    glCallList(glyphs + 42);
    glCallList(glyphs + 43);
    glScalef(3, 3, 1);
    glRotatef(20, 0, 0, 1);
    glCallList(glyphs + 57);
    glPopMatrix();
    glMatrixMode(GL_PROJECTION);
    glPopMatrix();
    glMatrixMode(GL_MODELVIEW);
    glPopAttrib();
    glEndList();
}

void makeMaterialList() {
    materialList = glGenLists(1);
    glNewList(materialList, GL_COMPILE);
    const GLfloat ambient[] = {0.2F, 0.2F, 0.5F, 1};
    const GLfloat position[] = {0.2F, 0.4F, 1, 0};
    glLightfv(GL_LIGHT1, GL_AMBIENT, ambient);
    glLightfv(GL_LIGHT1, GL_DIFFUSE, ambient);
    glLightfv(GL_LIGHT1, GL_POSITION, position);
    glMaterialf(GL_FRONT, GL_SHININESS, 20);
    glEnable(GL_LIGHT1);
    glEnable(GL_LIGHTING);
    glBegin(GL_TRIANGLE_FAN);
    for (int i = 0; i < 7; ++i) {
        glNormal3f(float(i) * 0.1F, 0, 1);
        glVertex2f(190 + float((i * 13) % 7) * 5, 120 + float((i * 5) % 7) * 7);
    }
    glEnd();
    glDisable(GL_LIGHTING);
    glEndList();
}

// Compiles a list with conditional rendering, whose result is known only when it is called.
void makeConditionList() {
    glGenQueries(1, &condition);
    conditionList = glGenLists(1);
    glNewList(conditionList, GL_COMPILE);
    glBeginConditionalRender(condition, GL_QUERY_WAIT);
    glColor3f(0.2F, 0.8F, 0.7F);
    glRecti(110, 60, 145, 104);
    glEndConditionalRender();
    glEndList();
}

// Counts samples in a small place and draws in a large one. The two may be on different nodes.
void drawConditionally(int frame) {
    glBeginQuery(GL_SAMPLES_PASSED, condition);
    if (frame % 2 == 0) {
        glRecti(5, 100, 12, 108);
    }
    glEndQuery(GL_SAMPLES_PASSED);
    glCallList(conditionList);
}

void makeScene() {
    scene = glGenLists(1);
    glNewList(scene, GL_COMPILE);
    glCallList(stateList);
    glPushMatrix();
    glTranslatef(20, 130, 0);
    glCallList(arrayList);
    glPopMatrix();
    glCallList(pixelList);
    glCallList(textureList);
    glCallList(materialList);
    glEndList();
}

// Calls lists with names as bytes, shorts, ints, floats and as 2, 3, 4 bytes, relative to glListBase.
void callByAllTypes(int frame) {
    const GLbyte bytes[] = {1, 5, 9};
    const GLubyte unsignedBytes[] = {2, 6, static_cast<GLubyte>(10 + frame)};
    const GLshort shorts[] = {3, 7, 11};
    const GLushort unsignedShorts[] = {4, 8, 12};
    const GLint ints[] = {13, 17, 21 + frame};
    const GLuint unsignedInts[] = {14, 18, 22};
    const GLfloat floats[] = {15, 19.0F, 23.0F};
    const GLubyte pairs[] = {0, 30, 0, 31, 0, static_cast<GLubyte>(32 + frame)};
    const GLubyte triples[] = {0, 0, 40, 0, 0, 41};
    const GLubyte quadruples[] = {0, 0, 0, 50, 0, 0, 0, 51};
    glPushAttrib(GL_LIST_BIT);
    glListBase(glyphs);
    glPushMatrix();
    glTranslatef(4, 172, 0);
    glCallLists(3, GL_BYTE, bytes);
    glCallLists(3, GL_UNSIGNED_BYTE, unsignedBytes);
    glCallLists(3, GL_SHORT, shorts);
    glCallLists(3, GL_UNSIGNED_SHORT, unsignedShorts);
    glCallLists(3, GL_INT, ints);
    glCallLists(3, GL_UNSIGNED_INT, unsignedInts);
    glCallLists(3, GL_FLOAT, floats);
    glPopMatrix();
    glPushMatrix();
    glTranslatef(4, 160, 0);
    glCallLists(3, GL_2_BYTES, pairs);
    glCallLists(2, GL_3_BYTES, triples);
    glCallLists(2, GL_4_BYTES, quadruples);
    glPopMatrix();
    glPopAttrib();
}

// Replaces a list while another one calls it, and compiles and executes one at once.
void replaceAndExecute(int frame) {
    glNewList(glyphs + 42, GL_COMPILE);
    drawGlyph(unsigned(frame) * 7 + 1);
    glEndList();
    const GLuint once = glGenLists(1);
    glPushMatrix();
    glTranslatef(10, 20, 0);
    glNewList(once, GL_COMPILE_AND_EXECUTE);
    drawGlyph(unsigned(frame) + 200);
    glRotatef(float(frame) * 5, 0, 0, 1);
    drawGlyph(unsigned(frame) + 201);
    glEndList();
    glCallList(once);
    glPopMatrix();
    glDeleteLists(once, 1);
    showBits(36, glIsList(once) == GL_TRUE ? 1U : 0U);
    showBits(37, glIsList(scene) == GL_TRUE ? 1U : 0U);
}

// Checks that a list uses attributes set before it, and that its own last attributes remain after it.
void drawThroughCurrentState(int frame) {
    const GLuint open = glGenLists(1);
    glNewList(open, GL_COMPILE);
    glVertex2f(60, 10);
    glVertex2f(80, 12);
    glColor3f(0.9F, 0.9F, 0.2F);
    glVertex2f(70, 30);
    glEndList();
    glColor3f(float(frame) * 0.2F, 0.3F, 0.6F);
    glBegin(GL_TRIANGLES);
    glCallList(open);
    glVertex2f(90, 10);
    glVertex2f(110, 12);
    glVertex2f(100, 30);
    glEnd();
    glDeleteLists(open, 1);
}

// Compiles instanced draws. The list holds the vertices, one for each element, without instances.
void compileInstanced(int frame) {
    const auto x = static_cast<GLfloat>(10 + frame);
    const GLfloat places[8] = {x, 120, x + 20, 122, x + 22, 134, x + 3, 130};
    const GLuint list = glGenLists(1);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, places);
    glVertexAttribDivisor(0, 2);
    glNewList(list, GL_COMPILE);
    glDrawArrays(GL_QUADS, 0, 4);
    glEndList();
    glVertexAttribDivisor(0, 0);
    glDisableVertexAttribArray(0);
    glColor3f(0.2F, 0.9F, 0.8F);
    glCallList(list);
    glDeleteLists(list, 1);
}

GLuint errorDigit() {
    const GLenum error = glGetError();
    return error == GL_NO_ERROR ? 15 : error & 7U;
}

// Compiles invalid calls between glBegin and glEnd. GL rejects everything except vertices and continues the primitive,
// while it compiles and when the list is called. A rejected glBegin begins nothing: the scissor after it takes effect.
void compileErrors(int frame, GLenum mode) {
    const GLenum none = GL_NONE;
    const std::vector<GLubyte> gray(98 * 42 * 4, 90), light(98 * 42 * 4, 210);
    const GLuint wrong = glGenLists(1);
    glNewList(wrong, mode);
    glBegin(GL_PATCHES + 20);
    glEnable(GL_SCISSOR_TEST);
    glScissor(228, 64, 14, 12);
    glColor3f(0.1F, 0.2F, 0.9F);
    glRecti(225, 60, 245, 90);
    glDisable(GL_SCISSOR_TEST);
    glBegin(GL_POLYGON);
    glDrawBuffers(1, &none);
    glColor3f(0.4F, 0.9F, 0.1F * float(frame));
    glVertex2f(180, 60);
    glScissor(0, 0, 5, 5);
    glVertex2f(215, 62);
    glColor3f(0.9F, 0.3F, 0.5F);
    glPopAttrib();
    glVertex2f(220, 95);
    glUseProgram(77);
    glDrawPixels(98, 42, GL_RGBA, GL_UNSIGNED_BYTE, gray.data()); // large: sent before its command
    glVertex2f(178, 100);
    glEnd();
    glEndList();
    glRasterPos2f(1, 72);
    glDrawPixels(98, 42, GL_RGBA, GL_UNSIGNED_BYTE, light.data());
    GLuint errors = 0;
    for (int i = 0; i < 4; ++i) errors = errors * 16 + errorDigit();
    glTranslatef(0, 45, 0);
    glCallList(wrong);
    for (int i = 0; i < 4; ++i) errors = errors * 16 + errorDigit();
    showBits(0, errors);
    glTranslatef(0, -45, 0);
    glDeleteLists(wrong, 1);
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {},
        [](Window&) {
            makeGlyphs();
            makeArrayList();
            makePixelList();
            makeTextureList();
            makeStateList();
            makeMaterialList();
            makeConditionList();
            makeScene();
        },
        [](Window& window, int frame) {
            glClearColor(0.05F, 0.1F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            glViewport(0, 0, window.width(), window.height());
            glMatrixMode(GL_PROJECTION);
            glLoadIdentity();
            glOrtho(0, 250, 0, 190, -1, 1);
            glMatrixMode(GL_MODELVIEW);
            glLoadIdentity();
            glTranslatef(float(frame) * 1.5F, 0, 0);
            replaceAndExecute(frame);
            glColor3f(1, 1, 1);
            glCallList(scene);
            callByAllTypes(frame);
            drawThroughCurrentState(frame);
            drawConditionally(frame);
            compileInstanced(frame);
            checkNoError("with lists");
            compileErrors(frame, frame % 2 == 0 ? GL_COMPILE : GL_COMPILE_AND_EXECUTE);
        });
}
