// Calls that GL rejects have no further effect: later calls draw, count and read as if they had not been made. Replies
// are shown as bits.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <numeric>
#include <vector>

using namespace programs;

namespace {

unsigned errors() {
    unsigned count = 0;
    while (glGetError() != GL_NO_ERROR) {
        ++count;
    }
    return count;
}

// Draws an array in client memory after calls with invalid pointers, units and vertex arrays.
void drawArrays(int frame) {
    static const float corners[] = {-0.9F, -0.9F, 0, -0.1F, -0.9F, 0, -0.9F, -0.1F, 0, -0.1F, -0.1F, 0};
    static const float colors[] = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1, 0, 1};
    static const float coordinates[] = {0, 0, 1, 0, 0, 1, 1, 1};
    static const GLubyte texels[] = {255, 255, 255, 255, 90, 90, 90, 255, 120, 200, 40, 255, 10, 60, 250, 255};
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 2, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glEnable(GL_TEXTURE_2D);
    glVertexPointer(3, GL_FLOAT, 0, corners);
    glColorPointer(4, GL_FLOAT, 0, colors);
    glClientActiveTexture(GL_TEXTURE0 + 12);
    glEnableClientStateiEXT(GL_TEXTURE_COORD_ARRAY, 31);
    glTexCoordPointer(2, GL_FLOAT, 0, coordinates);
    glVertexPointer(7, GL_FLOAT, 0, colors);
    glVertexPointer(3, GL_UNSIGNED_BYTE, 0, colors);
    glBindVertexArray(77);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    glDisableClientStateIndexedEXT(GL_COLOR_ARRAY, 1);
    glDisableVertexArrayEXT(0, GL_COLOR_ARRAY);
    glBindProgramPipeline(77);
    showBar(0, errors());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, frame % 2 == 0 ? 4 : 3);
    glDisableClientState(GL_TEXTURE_COORD_ARRAY);
    glDisable(GL_TEXTURE_2D);
}

// Checks that a query that did not begin counts nothing, and that a failed condition is one error.
void count() {
    GLuint query = 0;
    glGenQueries(1, &query);
    glBeginQuery(GL_SAMPLES_PASSED, 0);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glBeginQuery(GL_SAMPLES_PASSED, query + 1);
    glEndQuery(GL_SAMPLES_PASSED);
    GLuint samples = 0;
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &samples);
    showBits(2, samples);
    showBar(3, errors());
    glBeginConditionalRender(query + 9, GL_QUERY_WAIT);
    glEndConditionalRender();
    showBar(4, errors());
    glDeleteQueries(1, &query);
}

// Checks that a reply into a buffer uses none of the program's names.
void answerIntoBuffer() {
    GLuint query = 0;
    GLuint buffers[2] = {};
    glGenQueries(1, &query);
    glBeginQuery(GL_ANY_SAMPLES_PASSED, query);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    glGenBuffers(1, &buffers[0]);
    glBindBuffer(GL_QUERY_BUFFER, buffers[0]);
    glBufferData(GL_QUERY_BUFFER, 16, nullptr, GL_STREAM_READ);
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, nullptr);
    GLuint answer = 9;
    glGetBufferSubData(GL_QUERY_BUFFER, 0, 4, &answer);
    glBindBuffer(GL_QUERY_BUFFER, 0);
    glGenBuffers(1, &buffers[1]);
    showBits(5, answer);
    showBits(6, buffers[1] - buffers[0]);
    glDeleteBuffers(2, buffers);
    glDeleteQueries(1, &query);
}

// Draws packed vertices of an invalid type among the others.
void packed() {
    const GLenum types[] = {GL_INT_2_10_10_10_REV, GL_FLOAT, GL_UNSIGNED_INT_2_10_10_10_REV,
                            GL_UNSIGNED_INT_10F_11F_11F_REV, 7};
    unsigned failed[5] = {};
    for (int i = 0; i < 5; ++i) {
        glBegin(GL_TRIANGLES);
        glVertexP3ui(types[i], 0x1ff);
        glVertexAttribP4ui(0, types[i], GL_TRUE, 0x7fd00);
        glVertexAttribP3ui(0, types[i], GL_TRUE, 0x1ff7f);
        glEnd();
        failed[i] = errors();
    }
    for (int i = 0; i < 5; ++i) {
        showBar(14 + i, failed[i]);
    }
}

std::uint32_t sumOf(const std::vector<GLubyte>& bytes) { return std::accumulate(bytes.begin(), bytes.end(), 0U); }

// Checks that memory outside a framebuffer object is unchanged, and that a buffer that is too small is an error.
void read() {
    GLuint framebuffer = 0;
    GLuint renderbuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glGenRenderbuffers(1, &renderbuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, 20, 12);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffer);
    glClear(GL_COLOR_BUFFER_BIT);
    std::uint32_t sums[4] = {};
    const int places[4][2] = {{-3, -2}, {15, 8}, {20, 0}, {0, -16}};
    for (int i = 0; i < 4; ++i) {
        std::vector<GLubyte> pixels(16 * 16 * 4, 0x37);
        glReadPixels(places[i][0], places[i][1], 16, 16, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        sums[i] = sumOf(pixels);
    }
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    glBufferData(GL_PIXEL_PACK_BUFFER, 100, nullptr, GL_STREAM_READ);
    glReadPixels(0, 0, 8, 8, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    const unsigned failed = errors();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    for (int i = 0; i < 4; ++i) {
        showBits(8 + i, sums[i]);
    }
    showBar(12, failed);
    glDeleteBuffers(1, &buffer);
    glDeleteRenderbuffers(1, &renderbuffer);
    glDeleteFramebuffers(1, &framebuffer);
}

// Checks that a call of EXT_direct_state_access creates the buffer that it names, also when the call is rejected.
void nameBuffers() {
    const GLuint words[] = {11, 22};
    GLuint buffers[2] = {};
    glGenBuffers(2, buffers);
    glNamedBufferSubDataEXT(buffers[0], 8, 4, words);
    const GLenum error = glGetError();
    glNamedBufferStorageEXT(buffers[1], sizeof words, words, GL_MAP_READ_BIT);
    GLuint readBack = 0;
    glGetNamedBufferSubDataEXT(buffers[1], 4, 4, &readBack);
    showBits(20, error);
    showBits(21, glIsBuffer(buffers[0]) == GL_TRUE ? 1U : 2U);
    showBits(22, readBack);
    showBar(23, errors());
    glDeleteBuffers(2, buffers);
}

// Checks that the other direct calls reject a name without a buffer and create none, also while nodes may write into
// buffers.
void nameWithoutBuffer() {
    glBindImageTexture(0, 0, 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA8);
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    GLuint readBack = 7;
    glGetNamedBufferSubData(buffer, 0, 4, &readBack);
    showBits(34, glGetError());
    showBits(35, glIsBuffer(buffer) == GL_TRUE ? 1U : 2U);
    showBits(36, readBack);
    glDeleteBuffers(1, &buffer);
}

// Draws meshes, which are lines and strips, with a geometry shader for triangles. Empty meshes have no rows or empty
// rows.
void mesh(GLuint triangles) {
    const GLfloat places[] = {-0.9F, 0.5F, 0, -0.5F, 0.5F, 0, -0.9F, 0.9F, 0, -0.5F, 0.9F, 0};
    glMap2f(GL_MAP2_VERTEX_3, 0, 1, 3, 2, 0, 1, 6, 2, places);
    glEnable(GL_MAP2_VERTEX_3);
    glMapGrid2f(2, 0, 1, 2, 0, 1);
    glUseProgram(triangles);
    const GLint ranges[][4] = {{0, 2, 0, 2}, {2, 0, 0, 2}, {0, 2, 2, 0}, {2, 0, 2, 0}, {0, 2, 1, 1}};
    std::uint32_t failed = 0;
    for (const GLenum mode : {GL_POINT, GL_LINE, GL_FILL}) {
        for (const auto& r : ranges) {
            glEvalMesh2(mode, r[0], r[1], r[2], r[3]);
            failed = failed * 2 + errors();
        }
    }
    glUseProgram(0);
    glDisable(GL_MAP2_VERTEX_3);
    showBits(24, failed);
}

// Checks that only vertices are accepted between glBegin and glEnd: neither the state nor memory changes. A rejected
// glBegin begins nothing.
void inPrimitive() {
    const GLubyte rows[3][8] = {
        {90, 200, 40, 9, 9, 9, 9, 9}, {10, 250, 120, 9, 9, 9, 9, 9}, {255, 30, 180, 9, 9, 9, 9, 9}};
    std::vector<GLubyte> pixels(64, 0x37);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 8);
    glColor3f(0.3F, 0.7F, 0.9F);
    glBegin(GL_TRIANGLES);
    glScissor(4, 4, 3, 3);
    glEnable(GL_SCISSOR_TEST);
    glViewport(0, 0, 9, 9);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    glDrawPixels(1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    glNewList(1, GL_COMPILE);
    glVertex2f(0.5F, -0.9F);
    glVertex2f(0.9F, -0.9F);
    glReadPixels(0, 0, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    glVertex2f(0.7F, -0.3F);
    glEnd();
    showBar(25, errors());
    glWindowPos2i(200, 100);
    glPixelZoom(7, 7);
    glDrawPixels(3, 3, GL_LUMINANCE, GL_UNSIGNED_BYTE, rows);
    glPixelZoom(1, 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    showBits(26, sumOf(pixels));

    GLuint incomplete = 0;
    glGenFramebuffers(1, &incomplete);
    glBindFramebuffer(GL_FRAMEBUFFER, incomplete);
    glBegin(GL_QUADS);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glColor3f(0.9F, 0.2F, 0.3F);
    glEnd();
    glRectf(0.5F, 0.1F, 0.9F, 0.3F);
    glDeleteFramebuffers(1, &incomplete);
    showBar(27, errors());
}

// Compiles and executes a primitive that receives another attribute in its middle. Mesa executes it when it has been
// collected, in two parts, and still treats the time after glEnd as inside the primitive.
void inExecutedList() {
    const GLuint list = glGenLists(1);
    std::uint32_t readBack[4] = {};
    glNewList(list, GL_COMPILE_AND_EXECUTE);
    glVertexAttribIFormat(9, 1, 0x905d, 31);
    glBegin(GL_TRIANGLES);
    glVertex2f(-0.9F, 0.1F);
    glSecondaryColor3f(0.1F, 0.4F, 0.2F);
    glVertex2f(-0.5F, 0.1F);
    glFogCoordf(0.25F);
    glVertex2f(-0.7F, 0.4F);
    glEnd();
    readBack[0] = glGetError();
    glFlush();
    readBack[1] = glGetError();
    glEndList();
    readBack[2] = glGetError();
    readBack[3] = glGetError();
    for (int i = 0; i < 4; ++i) {
        showBits(28 + i, readBack[i]);
    }
    glDeleteLists(list, 1);
}

// Makes copies and conditions between glBegin and glEnd of a list. The list contains none, and no picture is requested.
void copyInListPrimitive() {
    const GLuint list = glGenLists(1);
    GLuint query = 0;
    glGenQueries(1, &query);
    glNewList(list, GL_COMPILE_AND_EXECUTE);
    glBegin(GL_TRIANGLES);
    glVertex2f(-0.4F, 0.1F);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 0, 0, 64, 64, 0);
    glVertex2f(-0.1F, 0.1F);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    glBeginConditionalRender(query, GL_QUERY_WAIT);
    glVertex2f(-0.2F, 0.5F);
    glEnd();
    glEndList();
    showBits(33, GLuint(errors()));
    glDeleteQueries(1, &query);
    glDeleteLists(list, 1);
}

// Checks that an invalid program does not replace the current one.
void useNoProgram(GLuint shifted) {
    const GLuint unlinked = glCreateProgram();
    glUseProgram(shifted);
    glUniform2d(glGetUniformLocation(shifted, "offset"), 0.3, -0.7);
    glUniform1f(glGetUniformLocation(shifted, "red"), 0.9F);
    glUseProgram(unlinked);
    glUniform1f(glGetUniformLocation(shifted, "red"), 0.4F);
    glRectf(0, 0, 0.2F, 0.1F);
    glUseProgram(0);
    glDeleteProgram(unlinked);
    showBar(32, errors());
}

GLuint shiftedProgram() {
    return buildProgram(
        {{GL_VERTEX_SHADER, R"(#version 410 compatibility
                             uniform dvec2 offset; uniform mat2x3 unused;
                             void main() { gl_Position = gl_Vertex + vec4(vec2(offset) + (unused * vec2(0.1)).xy, 0, 0); })"},
         {GL_FRAGMENT_SHADER,
          "#version 410 compatibility\nuniform float red; void main() { gl_FragColor = vec4(red, 0.6, 0.5, 1); }"}});
}

GLuint triangleProgram() {
    return buildProgram(
        {{GL_VERTEX_SHADER, "#version 150 compatibility\nvoid main() { gl_Position = gl_Vertex; }"},
         {GL_GEOMETRY_SHADER, R"(#version 150 compatibility
                             layout(triangles) in; layout(triangle_strip, max_vertices = 3) out;
                             void main() { for (int i = 0; i < 3; ++i) { gl_Position = gl_in[i].gl_Position; EmitVertex(); } })"},
         {GL_FRAGMENT_SHADER, "#version 150 compatibility\nvoid main() { gl_FragColor = vec4(0.9, 0.6, 0.1, 1); }"}});
}

// Sets several viewports or boxes at once, one of them invalid: none changes.
void boxes(int frame) {
    const float viewports[] = {10, 10, 30, 30, 5, 5, -1, 5};
    const int scissors[] = {3, 3, 9, 9, 1, 1, 4, -4};
    glViewportArrayv(0, 2, viewports);
    glViewportArrayv(15, 2, viewports);
    glViewportIndexedf(0, 4, 4, 20, -3);
    glViewport(1, 2, -3, 4);
    glEnable(GL_SCISSOR_TEST);
    glScissor(100, 130, 60, 50);
    glScissorArrayv(0, 2, scissors);
    glScissorIndexed(0, 1, 1, -2, 2);
    showBits(12, errors());
    glEnable(GL_SCISSOR_TEST); // showBits has its own
    glScissor(100, 130, 60, 50);
    glScissorArrayv(0, 2, scissors);
    (void)errors();
    glColor3f(0.9F, 0.2F * float(frame), 0.4F);
    glRectf(-0.3F, 0.2F, 0.4F, 0.95F);
    glDisable(GL_SCISSOR_TEST);
}

} // namespace

int main(int argc, char** argv) {
    static GLuint triangles;
    static GLuint shifted;
    const auto begin = [](Window&) { triangles = triangleProgram(), shifted = shiftedProgram(); };
    return runInGlxWindow(argc, argv, {}, begin, [](Window&, int frame) {
        glClearColor(0.2F, 0.1F, 0.3F, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        drawArrays(frame);
        count();
        answerIntoBuffer();
        read();
        packed();
        nameBuffers();
        nameWithoutBuffer();
        mesh(triangles);
        useNoProgram(shifted);
        inPrimitive();
        inExecutedList();
        copyInListPrimitive();
        boxes(frame);
    });
}
