// Two contexts of a share group with handles of the same textures: each has its own residency, what one uploads or draws
// into a texture the other takes by its handle; textures of the first are deleted while the second goes on.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/needs.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

constexpr int kSize = 16;
GLuint uploaded, drawn, framebuffer, program, vertexArrays[2], late;
GLuint64 uploadedHandle, drawnHandle, lateHandle;

GLuint makeTexture() {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, kSize, kSize);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

void upload(GLuint texture, unsigned seed) {
    GLubyte pixels[kSize * kSize * 4];
    Sequence numbers(seed);
    for (GLubyte& p : pixels) {
        p = numbers.byte();
    }
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
}

void setUpFirst() {
    needExtension("GL_ARB_bindless_texture");
    program = buildProgram({{GL_VERTEX_SHADER, "#version 430\nuniform vec4 box; out vec2 corner; void main() {\n"
                                               "corner = vec2(gl_VertexID & 1, gl_VertexID >> 1 & 1); gl_Position = vec4(box.xy + corner * box.zw, 0, 1); }\n"},
                            {GL_FRAGMENT_SHADER, "#version 430\n#extension GL_ARB_bindless_texture : require\n"
                                                 "in vec2 corner; layout(bindless_sampler) uniform sampler2D image; out vec4 result;\n"
                                                 "void main() { result = vec4(texture(image, corner).rgb, 1); }\n"}});
    glGenVertexArrays(1, &vertexArrays[0]);
    uploaded = makeTexture();
    drawn = makeTexture();
    upload(uploaded, 1);
    upload(drawn, 2);
    uploadedHandle = glGetTextureHandleARB(uploaded);
    drawnHandle = glGetTextureHandleARB(drawn);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, drawn, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void box(GLuint64 handle, float x, float y) {
    glUniformHandleui64ARB(glGetUniformLocation(program, "image"), handle);
    glUniform4f(glGetUniformLocation(program, "box"), x, y, 0.9F, 0.9F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

// The first context: draws nothing of its own window but a colour.
void first(int frame) {
    glClearColor(0.1F * float(frame), 0.3F, 0.1F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    upload(uploaded, 10 + unsigned(frame));
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, kSize, kSize);
    glEnable(GL_SCISSOR_TEST);
    for (int i = 0; i < 4; ++i) {
        glScissor(i * 4, (i + frame) % 4 * 4, 4, 4);
        glClearColor(0.25F * float(i), 0.2F * float(frame), 0.5F, 1);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (late != 0) {
        glDeleteTextures(1, &late);
    }
    late = makeTexture();
    upload(late, 40 + unsigned(frame));
    lateHandle = glGetTextureHandleARB(late);
    glFinish();
}

void second(const Window& window) {
    glViewport(0, 0, window.width(), window.height());
    glClearColor(0.1F, 0.1F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glUseProgram(program);
    showBits(20, GLuint(glIsTextureHandleResidentARB(uploadedHandle)));
    const GLuint64 handles[] = {uploadedHandle, drawnHandle, lateHandle};
    for (const GLuint64 handle : handles) {
        if (glIsTextureHandleResidentARB(handle) == GL_FALSE) {
            glMakeTextureHandleResidentARB(handle);
        }
    }
    box(uploadedHandle, -0.95F, -0.95F);
    box(drawnHandle, 0.05F, -0.95F);
    box(lateHandle, -0.45F, 0.05F);
    glMakeTextureHandleNonResidentARB(lateHandle);
    glMakeTextureHandleNonResidentARB(uploadedHandle);
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const WindowSpec spec{Profile::Core, 4, 5};
    const auto one = openGlxWindow(spec, options.width, options.height);
    one->makeCurrent();
    setUpFirst();
    const auto two = openGlxWindow(spec, options.width, options.height, one.get());
    two->makeCurrent();
    glGenVertexArrays(1, &vertexArrays[1]);
    glBindVertexArray(vertexArrays[1]);
    for (int frame = 0; frame < options.frames; ++frame) {
        one->makeCurrent();
        first(frame);
        checkNoError("in the first context");
        one->swap();
        two->makeCurrent();
        second(*two);
        checkNoError("in the second context");
        two->swap();
    }
    two->release();
    return 0;
}
