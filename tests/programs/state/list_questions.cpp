// Operations that need the whole picture at an inner point:
//   - display lists that count samples and draw on that condition, or that copy from the window and draw with the copy;
//   - copies within conditional rendering and within queries;
//   - queries in the middle of a list and of a selection, about earlier drawing.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

GLuint texture, queries[3], conditionList, copyList, pixelsList, innerList, queryList;
GLuint feedbackBuffer, feedbackProgram;

void texturedBox(int x, int y, int w, int h) {
    glEnable(GL_TEXTURE_2D);
    glBegin(GL_QUADS);
    glTexCoord2f(0, 0);
    glVertex2i(x, y);
    glTexCoord2f(1, 0);
    glVertex2i(x + w, y);
    glTexCoord2f(1, 1);
    glVertex2i(x + w, y + h);
    glTexCoord2f(0, 1);
    glVertex2i(x, y + h);
    glEnd();
    glDisable(GL_TEXTURE_2D);
}

// Compiles a list that counts in one corner and draws in the others.
void compileCondition(GLenum mode) {
    glNewList(conditionList, mode);
    glColor3f(0, 0.6F, 0.2F);
    glBeginQuery(GL_SAMPLES_PASSED, queries[0]);
    glRecti(5, 5, 12, 12);
    glEndQuery(GL_SAMPLES_PASSED);
    glBeginConditionalRender(queries[0], GL_QUERY_WAIT);
    glRecti(200, 5, 230, 40);
    glRecti(5, 150, 30, 180);
    glEndConditionalRender();
    glBeginQuery(GL_SAMPLES_PASSED, queries[1]);
    glEndQuery(GL_SAMPLES_PASSED);
    glBeginConditionalRender(queries[1], GL_QUERY_WAIT);
    glColor3f(1, 0, 0);
    glRecti(0, 0, 250, 190);
    glEndConditionalRender();
    glBeginQuery(GL_SAMPLES_PASSED, queries[0]); // again, with another result
    glEndQuery(GL_SAMPLES_PASSED);
    glBeginConditionalRender(queries[0], GL_QUERY_WAIT);
    glRecti(0, 0, 40, 190);
    glEndConditionalRender();
    glEndList();
}

void compileCopies() {
    glNewList(innerList, GL_COMPILE);
    glColor3f(0.9F, 0.4F, 0);
    glRecti(118, 80, 132, 100);
    glEndList();
    glNewList(copyList, GL_COMPILE);
    glCallList(innerList); // on all tiles
    glBindTexture(GL_TEXTURE_2D, texture);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 93, 63, 64, 64);
    glColor3f(1, 1, 1);
    texturedBox(10, 20, 60, 50);
    texturedBox(170, 120, 60, 60);
    glEndList();
}

void pattern(int frame) {
    Sequence numbers(unsigned(frame) + 9);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 60; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex3f(250 * numbers.unit(), 190 * numbers.unit(), numbers.unit() - 0.5F);
    }
    glEnd();
}

// Copies under a condition, without drawing.
void copyConditionally() {
    glBeginQuery(GL_SAMPLES_PASSED, queries[2]);
    glEndQuery(GL_SAMPLES_PASSED);
    glBindTexture(GL_TEXTURE_2D, texture);
    glBeginConditionalRender(queries[2], GL_QUERY_WAIT);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 5, 3, 100, 70, 50, 40);
    glColor3f(1, 0, 0);
    glRecti(60, 60, 200, 150);
    glEndConditionalRender();
    glColor3f(1, 1, 1);
    texturedBox(80, 10, 90, 40);
}

// Counts only samples of the program's own copy, not of transfers from other tiles.
void copyWhileCounting(int row) {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glRasterPos2i(60, 130);
    glBeginQuery(GL_SAMPLES_PASSED, queries[2]);
    glCopyPixels(80, 70, 90, 50, GL_DEPTH);
    glEndQuery(GL_SAMPLES_PASSED);
    glDisable(GL_DEPTH_TEST);
    GLuint counted = 0;
    glGetQueryObjectuiv(queries[2], GL_QUERY_RESULT, &counted);
    showBits(row, counted);
}

GLuint counted() {
    GLuint result = 0;
    glGetQueryObjectuiv(queries[2], GL_QUERY_RESULT, &result);
    return result;
}

GLuint written() {
    GLuint result = 0;
    glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 4, sizeof result, &result);
    return result;
}

// Requests transform feedback of a point, and samples of a box, while something else begins. Nothing is drawn before
// the replies.
void query(int frame, GLenum listMode, bool selects, int row) {
    const GLfloat nothing[4] = {};
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, feedbackBuffer);
    glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, sizeof nothing, nothing, GL_DYNAMIC_READ);
    glUseProgram(feedbackProgram);
    glBeginTransformFeedback(GL_POINTS);
    glBegin(GL_POINTS);
    glVertex2i(frame + 3, row);
    glEnd();
    glEndTransformFeedback();
    glUseProgram(0);
    glBeginQuery(GL_SAMPLES_PASSED, queries[2]);
    glRecti(100 + frame, row, 140, row + 9);
    glEndQuery(GL_SAMPLES_PASSED);
    GLuint names[4] = {}, answers[2] = {};
    if (selects) {
        glSelectBuffer(4, names);
        glRenderMode(GL_SELECT);
    }
    if (listMode != 0) glNewList(queryList, listMode);
    answers[0] = counted();
    answers[1] = written();
    if (listMode != 0) glEndList();
    if (selects) glRenderMode(GL_RENDER);
    showBits(row / 4, answers[0]);
    showBits(row / 4 + 1, answers[1]);
}

// Reads between glBegin and glEnd of a list. Lists contain no reads: they are executed at once, and the primitive stays
// whole.
void readInPrimitive(GLenum mode, GLenum listMode, int row) {
    GLuint pixels[2 * 2] = {};
    glNewList(queryList, listMode);
    glColor3f(0.2F, 0.9F, 0.7F);
    glBegin(mode);
    glVertex2i(150, row);
    glVertex2i(240, row + 5);
    glReadPixels(120, 104, 2, 2, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    glVertex2i(230, row + 30);
    glVertex2i(60, row + 22);
    glEnd();
    glEndList();
    glCallList(queryList);
    showBits(row / 4, pixels[0]);
    showBits(row / 4 + 1, pixels[3]);
}

void setUp(Window&) {
    glGenQueries(3, queries);
    glGenBuffers(1, &feedbackBuffer);
    feedbackProgram = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 130\nout vec2 place;\nvoid main() { place = gl_Vertex.xy; gl_Position = gl_Vertex; }\n"}},
        [](unsigned linking) {
            const char* const varying = "place";
            glTransformFeedbackVaryings(linking, 1, &varying, GL_INTERLEAVED_ATTRIBS);
        });
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 64, 64, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    conditionList = glGenLists(5);
    copyList = conditionList + 1;
    pixelsList = conditionList + 2;
    innerList = conditionList + 3;
    queryList = conditionList + 4;
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(argc, argv, {}, setUp, [](Window& window, int frame) {
        glViewport(0, 0, window.width(), window.height());
        glMatrixMode(GL_PROJECTION);
        glLoadIdentity();
        glOrtho(0, 250, 0, 190, -1, 1);
        glMatrixMode(GL_MODELVIEW);
        glClearColor(0.1F, 0.1F, 0.3F, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        pattern(frame);
        query(frame, GL_COMPILE, false, 100);
        query(frame, GL_COMPILE_AND_EXECUTE, false, 112);
        query(frame, 0, true, 124);
        readInPrimitive(GL_QUADS, GL_COMPILE, 4);
        readInPrimitive(GL_LINE_LOOP, GL_COMPILE, 24);
        readInPrimitive(GL_QUADS, GL_COMPILE_AND_EXECUTE, 48);
        copyConditionally();
        copyWhileCounting(46);
        if (frame == 0) { // in the middle of a picture
            glNewList(pixelsList, GL_COMPILE_AND_EXECUTE);
            glRasterPos2i(20, 100);
            glCopyPixels(90, 60, 70, 60, GL_COLOR);
            glEndList();
            compileCopies();
            compileCondition(GL_COMPILE_AND_EXECUTE);
        } else {
            glCallList(pixelsList);
        }
        if (frame == 2) compileCondition(GL_COMPILE);
        glCallList(copyList);
        glCallList(conditionList);
        GLuint counted = 0;
        glGetQueryObjectuiv(queries[0], GL_QUERY_RESULT, &counted);
        showBits(45, counted);
    });
}
