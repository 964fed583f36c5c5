// Bindless textures with handles from all sources:
//   - uniforms, single and in arrays, of the current and of a named program;
//   - uniform and storage blocks;
//   - attributes, current ones and arrays of them;
//   - two numbers of 32 bits.
// Residency changes, resident textures change, and deleted textures pass their handles on to others. The driver's
// replies are shown.
#include <string>
#include <vector>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/needs.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

constexpr int kTextures = 6, kSize = 16;
GLuint textures[kTextures], sampler, vertexArray, uniformBuffer, storageBuffer, attributes;
GLuint64 handles[kTextures], sampled;
GLuint byUniform, byArray, byBlock, byStorage, byAttribute, byPairs, byNumbers;

const char* const kHead = "#version 430\n#extension GL_ARB_bindless_texture : require\n";

GLuint program(const char* declarations, const char* handle, const char* vertexInput = "", const char* varying = "",
               const char* assign = "") {
    const std::string vertex = std::string(kHead) + "uniform vec4 box; out vec2 corner;\n" + vertexInput +
                               (*varying ? std::string("flat out ") + varying : "") +
                               "void main() { corner = vec2(gl_VertexID & 1, gl_VertexID >> 1 & 1); " + assign +
                               " gl_Position = vec4(box.xy + corner * box.zw, 0, 1); }\n";
    const std::string fragment =
        std::string(kHead) + declarations + (*varying ? std::string("flat in ") + varying : "") +
        "in vec2 corner; out vec4 result; void main() { result = vec4(texture(" + handle + ", corner).rgb, 1); }\n";
    return buildProgram({{GL_VERTEX_SHADER, vertex.c_str()}, {GL_FRAGMENT_SHADER, fragment.c_str()}});
}

void paint(int index, int frame) {
    std::vector<GLubyte> pixels(std::size_t{kSize} * kSize * 4);
    Sequence numbers(unsigned(index * 17 + frame * 101 + 1));
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = GLubyte(numbers.byte() / 2 + (i % 4 == unsigned(index % 3) ? 127 : 0));
    }
    glBindTexture(GL_TEXTURE_2D, textures[index]);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    glBindTexture(GL_TEXTURE_2D, 0);
}

void makeTexture(int index, int frame) {
    glGenTextures(1, &textures[index]);
    glBindTexture(GL_TEXTURE_2D, textures[index]);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, kSize, kSize);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    paint(index, frame);
    handles[index] = glGetTextureHandleARB(textures[index]);
    glMakeTextureHandleResidentARB(handles[index]);
}

void fillBuffers() {
    GLuint64 block[2 * kTextures] = {}; // members at multiples of 16 bytes
    for (int i = 0; i < kTextures; ++i) {
        block[2 * i] = handles[i];
    }
    glBindBuffer(GL_UNIFORM_BUFFER, uniformBuffer);
    glBufferSubData(GL_UNIFORM_BUFFER, 0, sizeof block, block);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, storageBuffer);
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof handles, handles);
    GLuint64 corners[4] = {handles[2], handles[2], handles[2], handles[2]};
    glBindBuffer(GL_ARRAY_BUFFER, attributes);
    glBufferSubData(GL_ARRAY_BUFFER, 0, sizeof corners, corners);
}

void setUp(Window&) {
    needExtension("GL_ARB_bindless_texture");
    byUniform = program("uniform sampler2D image;\n", "image");
    byArray = program("uniform sampler2D images[3]; uniform int which;\n", "images[which]");
    byBlock = program("layout(std140, binding=0) uniform Images { sampler2D images[6]; }; uniform int which;\n",
                      "images[which]");
    byStorage = program("layout(std430, binding=1) readonly buffer Images { uvec2 images[]; }; uniform int which;\n",
                        "sampler2D(images[which])");
    byAttribute =
        program("", "image", "layout(location=3) in sampler2D given;\n", "sampler2D image;\n", "image = given;");
    byPairs =
        program("", "sampler2D(image)", "layout(location=4) in uvec2 given;\n", "uvec2 image;\n", "image = given;");
    byNumbers = program("uniform uvec2 image;\n", "sampler2D(image)");
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    GLuint buffers[3];
    glGenBuffers(3, buffers);
    uniformBuffer = buffers[0], storageBuffer = buffers[1], attributes = buffers[2];
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, uniformBuffer);
    glBufferData(GL_UNIFORM_BUFFER, 2 * sizeof handles, nullptr, GL_DYNAMIC_DRAW);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, storageBuffer);
    glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof handles, nullptr, GL_DYNAMIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, attributes);
    glBufferData(GL_ARRAY_BUFFER, 4 * sizeof(GLuint64), nullptr, GL_DYNAMIC_DRAW);
    glVertexAttribIPointer(4, 2, GL_UNSIGNED_INT, 0, nullptr);
    glEnableVertexAttribArray(4);
    for (int i = 0; i < kTextures; ++i) {
        makeTexture(i, 0);
    }
    glGenSamplers(1, &sampler);
    glSamplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glSamplerParameteri(sampler, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    sampled = glGetTextureSamplerHandleARB(textures[5], sampler);
    glMakeTextureHandleResidentARB(sampled);
}

void drawBox(GLuint used, int column, int line) {
    glUseProgram(used);
    glUniform4f(glGetUniformLocation(used, "box"), -0.98F + float(column) * 0.33F, -0.55F + float(line) * 0.38F, 0.31F,
                0.36F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}
void choose(GLuint used, int which) {
    glUseProgram(used);
    glUniform1i(glGetUniformLocation(used, "which"), which);
}

void drawAll(int frame) {
    for (int i = 0; i < kTextures; ++i) {
        glUseProgram(byUniform);
        if (i % 2 == 0) {
            glUniformHandleui64ARB(glGetUniformLocation(byUniform, "image"), i == 4 ? sampled : handles[i]);
        } else {
            glProgramUniformHandleui64vARB(byUniform, glGetUniformLocation(byUniform, "image"), 1, &handles[i]);
        }
        drawBox(byUniform, i, 0);
        choose(byBlock, i);
        drawBox(byBlock, i, 2);
        choose(byStorage, (i + frame) % kTextures);
        drawBox(byStorage, i, 3);
    }
    const GLuint64 three[3] = {handles[3], handles[frame % 3], sampled};
    glUseProgram(byArray);
    if (frame % 2 == 0) {
        glUniformHandleui64vARB(glGetUniformLocation(byArray, "images"), 3, three);
    } else {
        for (int i = 0; i < 3; ++i) {
            const char* const names[] = {"images[0]", "images[1]", "images[2]"};
            glProgramUniformHandleui64ARB(byArray, glGetUniformLocation(byArray, names[i]), three[i]);
        }
    }
    for (int i = 0; i < 3; ++i) {
        choose(byArray, i);
        drawBox(byArray, i, 1);
    }
    drawBox(byPairs, 3, 1);
    if (frame % 2 == 0) {
        glVertexAttribL1ui64ARB(3, handles[1]);
    } else {
        glVertexAttribL1ui64vARB(3, &handles[4]);
    }
    drawBox(byAttribute, 4, 1);
    glUseProgram(byNumbers);
    glUniform2ui(glGetUniformLocation(byNumbers, "image"), GLuint(handles[0]), GLuint(handles[0] >> 32));
    drawBox(byNumbers, 5, 1);
}

void showAnswers() {
    for (int i = 0; i < kTextures; ++i) {
        showBits(i, GLuint(glIsTextureHandleResidentARB(handles[i])) << 8U |
                        GLuint(glGetTextureHandleARB(textures[i]) == handles[i]));
    }
    GLuint64EXT current = 0;
    glGetVertexAttribLui64vARB(3, GL_CURRENT_VERTEX_ATTRIB, &current);
    showBits(6, GLuint(current == handles[1]) | GLuint(current == handles[4]) << 1U);
    glMakeTextureHandleResidentARB(handles[0]); // it is
    showBits(7, glGetError());
    glGetTextureHandleARB(~0U);
    showBits(8, glGetError());
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(argc, argv, {Profile::Core, 4, 5}, setUp, [](Window&, int frame) {
        glClearColor(0.1F, 0.12F, 0.1F, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        paint(1, frame);  // resident, but no draw has it bound
        if (frame == 1) { // non-resident, and resident again
            glMakeTextureHandleNonResidentARB(handles[2]);
            glMakeTextureHandleNonResidentARB(handles[3]);
            showBits(20, GLuint(glIsTextureHandleResidentARB(handles[2])));
            glMakeTextureHandleResidentARB(handles[3]);
            glMakeTextureHandleResidentARB(handles[2]);
        }
        if (frame >= 2) { // other textures may receive the same handle numbers
            for (const int gone : {4, 1}) {
                glMakeTextureHandleNonResidentARB(handles[gone]);
                glDeleteTextures(1, &textures[gone]);
            }
            for (const int made : {1, 4}) {
                makeTexture(made, frame);
            }
        }
        fillBuffers();
        drawAll(frame);
        showAnswers();
    });
}
