// Two contexts in turn in one window: buffers, textures, programs, samplers, renderbuffers and syncs are shared; vertex
// arrays, framebuffers and all state are not.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/glx_choice.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <GL/glx.h>

#include "tests/programs/support/x_window.hpp"

using namespace programs;

namespace {

Display* display;
GLXContext contexts[2];
GLuint program, buffer, texture;
GLuint vertexArrays[2], framebuffers[2]; // the same numbers in both contexts

void makeShared() {
    program = buildProgram(
        {{GL_VERTEX_SHADER, "#version 330\nlayout(location=0) in vec2 place; uniform vec2 offset; out vec2 at;\n"
                            "void main() { at = place * 2.0; gl_Position = vec4(place + offset, 0, 1); }\n"},
         {GL_FRAGMENT_SHADER, "#version 330\nin vec2 at; uniform sampler2D image; uniform vec3 tint; out vec4 result;\n"
                              "void main() { result = vec4(texture(image, at).rgb * tint, 1); }\n"}});
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, 64, nullptr, GL_DYNAMIC_DRAW);
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, 16, 16);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

// Makes each context's own container objects, with equal names and different contents.
void makeOwn(int index) {
    glGenVertexArrays(1, &vertexArrays[index]);
    glBindVertexArray(vertexArrays[index]);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 8, reinterpret_cast<void*>(index == 0 ? 0 : 8));
    glEnableVertexAttribArray(0);
    glGenFramebuffers(1, &framebuffers[index]);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffers[index]);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glClearColor(index == 0 ? 0.2F : 0.0F, 0.1F, index == 0 ? 0.1F : 0.3F, 1); // own state
}

void useContext(const XWindow& window, int index) {
    if (glXMakeCurrent(display, window.id(), contexts[index]) != True) {
        fail("glXMakeCurrent failed for context %d", index);
    }
}

// Lets the first context write the shared objects.
GLsync update(int frame) {
    const GLfloat places[] = {0, 0,    0.5F, 0.05F * float(frame), 0.1F, 0.6F, 0.6F, 0.5F, -0.3F, 0.3F, 0.2F, -0.3F, 0,
                              0, 0.1F, 0.1F};
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferSubData(GL_ARRAY_BUFFER, 0, sizeof places, places);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffers[0]);
    glViewport(0, 0, 16, 16);
    glClear(GL_COLOR_BUFFER_BIT);
    for (int i = 0; i < 8; ++i) {
        fillRectangle(i * 2, (i * 5 + frame) % 12, 3, 4, {0.12F * float(i), 0.9F, 1.0F - 0.1F * float(i)});
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    const GLsync sync = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
    return sync;
}

void draw(const Options& options, int index, int frame) {
    glViewport(0, 0, options.width, options.height);
    glUseProgram(program);
    glBindVertexArray(vertexArrays[index]);
    glBindTexture(GL_TEXTURE_2D, texture);
    glUniform2f(glGetUniformLocation(program, "offset"), index == 0 ? -0.7F : 0.1F, -0.3F + 0.05F * float(frame));
    glUniform3f(glGetUniformLocation(program, "tint"), 1, index == 0 ? 1.0F : 0.5F, 0.9F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, index == 0 ? 5 : 4);
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    display = openDisplayOnce();
    const GLXFBConfig config = chooseGlxConfig(display, GLX_WINDOW_BIT, 24);
    XVisualInfo* visual = glXGetVisualFromFBConfig(display, config);
    const XWindow window(*visual, 0, 0, options.width, options.height);
    for (int i = 0; i < 2; ++i) {
        contexts[i] = glXCreateNewContext(display, config, GLX_RGBA_TYPE, i == 1 ? contexts[0] : nullptr, True);
        useContext(window, i);
        if (i == 0) {
            makeShared();
        }
        makeOwn(i);
    }
    for (int frame = 0; frame < options.frames; ++frame) {
        useContext(window, 0);
        const GLsync sync = update(frame);
        glViewport(0, 0, options.width, options.height);
        glClear(GL_COLOR_BUFFER_BIT);
        draw(options, 0, frame);
        glFinish();
        checkNoError("in the first context");
        useContext(window, 1);
        glWaitSync(sync, 0, GL_TIMEOUT_IGNORED);
        glDeleteSync(sync);
        draw(options, 1, frame); // the second context continues the window's picture
        if (frame % 2 == 1) {
            glEnable(GL_SCISSOR_TEST); // stays enabled in this context only
            glScissor(options.width - 30, 5, 20, 20 + frame);
            glClear(GL_COLOR_BUFFER_BIT);
            glDisable(GL_SCISSOR_TEST);
        }
        checkNoError("in the second context");
        glXSwapBuffers(display, window.id());
    }
    return 0;
}
