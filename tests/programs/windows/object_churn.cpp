// Creates, uses and deletes every kind of object in each frame: a process that forgets to free one grows. The picture
// shows that each existed.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

constexpr const char* kVertex = "#version 130\nin vec2 at;\nvoid main() { gl_Position = vec4(at, 0, 1); }\n";
constexpr const char* kFragment = "#version 130\nuniform vec4 colour;\nvoid main() { gl_FragColor = colour; }\n";

constexpr int kTextureSize = 128;

void texturedQuad(unsigned seed) {
    std::vector<GLubyte> texels(kTextureSize * kTextureSize * 4);
    Sequence numbers(seed);
    for (GLubyte& value : texels) value = numbers.byte();
    GLuint texture = 0, sampler = 0;
    glGenTextures(1, &texture);
    glGenSamplers(1, &sampler);
    glBindTexture(GL_TEXTURE_2D, texture);
    glBindSampler(0, sampler);
    glSamplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glSamplerParameteri(sampler, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kTextureSize, kTextureSize, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    glEnable(GL_TEXTURE_2D);
    glBegin(GL_QUADS);
    glTexCoord2f(0, 0), glVertex2f(-0.9F, -0.9F);
    glTexCoord2f(1, 0), glVertex2f(-0.1F, -0.9F);
    glTexCoord2f(1, 1), glVertex2f(-0.1F, -0.1F);
    glTexCoord2f(0, 1), glVertex2f(-0.9F, -0.1F);
    glEnd();
    glDisable(GL_TEXTURE_2D);
    glBindSampler(0, 0);
    glDeleteSamplers(1, &sampler);
    glDeleteTextures(1, &texture);
}

void compiledList(int frame) {
    const GLuint list = glGenLists(2);
    glNewList(list, GL_COMPILE);
    glColor3f(0.2F, 0.9F, 0.1F * float(frame % 8));
    glRectf(0.1F, -0.9F, 0.9F, -0.1F);
    glEndList();
    glNewList(list + 1, GL_COMPILE);
    glCallList(list);
    glEndList();
    glCallList(list + 1);
    glDeleteLists(list, 2);
}

// Creates buffer, vertex array, shaders, program, query and fence for one draw.
void shadedTriangle(int frame) {
    const GLuint program = buildProgram({{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, kFragment}},
                                        [](unsigned made) { glBindAttribLocation(made, 0, "at"); });
    const GLfloat corners[] = {-0.9F, 0.1F, -0.1F, 0.1F, -0.5F, 0.9F};
    GLuint buffer = 0, vertexArray = 0, query = 0;
    glGenBuffers(1, &buffer);
    glGenVertexArrays(1, &vertexArray);
    glGenQueries(1, &query);
    glBindVertexArray(vertexArray);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, 65536, nullptr, GL_STREAM_DRAW);
    glBufferSubData(GL_ARRAY_BUFFER, 0, sizeof corners, corners);
    if (void* mapped = glMapBufferRange(GL_ARRAY_BUFFER, 1024, 256, GL_MAP_WRITE_BIT))
        static_cast<GLfloat*>(mapped)[0] = 1;
    glUnmapBuffer(GL_ARRAY_BUFFER);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glUseProgram(program);
    glUniform4f(glGetUniformLocation(program, "colour"), 0.9F, 0.1F * float(frame % 9), 0.3F, 1);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEndQuery(GL_SAMPLES_PASSED);
    const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glWaitSync(fence, 0, GL_TIMEOUT_IGNORED);
    glDeleteSync(fence);
    glUseProgram(0);
    glDeleteProgram(program);
    glDeleteQueries(1, &query);
    glBindVertexArray(0);
    glDeleteVertexArrays(1, &vertexArray);
    glDeleteBuffers(1, &buffer);
}

void framebufferBlit(int frame, int width, int height) {
    GLuint framebuffer = 0, renderbuffers[2] = {};
    glGenFramebuffers(1, &framebuffer);
    glGenRenderbuffers(2, renderbuffers);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glBindRenderbuffer(GL_RENDERBUFFER, renderbuffers[0]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, 32, 32);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffers[0]);
    glBindRenderbuffer(GL_RENDERBUFFER, renderbuffers[1]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, 32, 32);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, renderbuffers[1]);
    glClearColor(0.1F * float(frame % 10), 0.4F, 0.8F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, 32, 32, width * 3 / 4, height * 3 / 4, width * 3 / 4 + 32, height * 3 / 4 + 32,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteRenderbuffers(2, renderbuffers);
    glDeleteFramebuffers(1, &framebuffer);
}

void drawObjects(int frame, const Options& options) {
    glClearColor(0, 0, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    texturedQuad(unsigned(frame));
    compiledList(frame);
    shadedTriangle(frame);
    framebufferBlit(frame, options.width, options.height);
}

// Creates another context with objects that are not deleted: they end with it.
void passingContext() {
    WindowSpec spec;
    const auto passing = openGlxWindow(spec, 64, 64);
    passing->makeCurrent();
    std::vector<GLubyte> texels(64 * 64 * 4, 0x80);
    GLuint texture = 0, buffer = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 64, 64, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, 65536, nullptr, GL_STREAM_DRAW);
    glClear(GL_COLOR_BUFFER_BIT);
    passing->swap();
}

} // namespace

int main(int argc, char** argv) {
    constexpr int kContextEvery = 4;
    const Options options = parseOptions(argc, argv);
    const auto staying = openGlxWindow({}, options.width, options.height);
    for (int frame = 0; frame < options.frames; ++frame) {
        if (frame % kContextEvery == 0) passingContext();
        staying->makeCurrent();
        drawObjects(frame, options);
        checkNoError("with objects that pass");
        staying->swap();
    }
    return 0;
}
