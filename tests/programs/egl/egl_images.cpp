// EGL images shared by contexts of different share groups: made from a texture's level, a cube face, a slice of a 3D
// texture and a renderbuffer; drawn into on one side, read on the other. An ES context takes part, with external
// textures. One image is made while no context is current.
#define EGL_EGLEXT_PROTOTYPES 1
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/support/textured_quad.hpp"
#include "tests/programs/support/x_window.hpp"

using namespace programs;

namespace {

constexpr int kSize = 32;
constexpr GLenum kExternal = 0x8D65; // GL_TEXTURE_EXTERNAL_OES, defined in the headers of ES

template <class F> F entry(const char* name) {
    auto* found = reinterpret_cast<F>(eglGetProcAddress(name));
    if (found == nullptr) {
        fail("no %s", name);
    }
    return found;
}

using TextureTarget = void (*)(GLenum, GLeglImageOES);
using StorageTarget = void (*)(GLenum, GLeglImageOES, const GLint*);

EGLDisplay display;
EGLContext maker, embedded; // each in its own share group
GLuint level, cube, volume, renderbuffer;
TextureTarget intoTexture, intoRenderbuffer;

EGLContext makeContext(EGLenum api, EGLint major, EGLint minor) {
    eglBindAPI(api);
    const EGLint wanted[] = {EGL_SURFACE_TYPE,
                             EGL_PBUFFER_BIT,
                             EGL_RENDERABLE_TYPE,
                             api == EGL_OPENGL_API ? EGL_OPENGL_BIT : EGL_OPENGL_ES2_BIT,
                             EGL_RED_SIZE,
                             8,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    eglChooseConfig(display, wanted, &config, 1, &count);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, major, EGL_CONTEXT_MINOR_VERSION, minor, EGL_NONE};
    const EGLContext made = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
    if (made == EGL_NO_CONTEXT) {
        fail("no context (EGL error 0x%04x)", eglGetError());
    }
    return made;
}

void use(EGLenum api, EGLContext context) {
    eglBindAPI(api);
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
        fail("eglMakeCurrent without a surface failed (EGL error 0x%04x)", eglGetError());
    }
}

EGLImage makeImage(EGLenum target, GLuint name, EGLAttrib mipLevel, EGLAttrib slice) {
    const EGLAttrib attributes[] = {EGL_GL_TEXTURE_LEVEL, mipLevel, EGL_GL_TEXTURE_ZOFFSET, slice, EGL_NONE};
    const EGLAttrib* list = target == EGL_GL_RENDERBUFFER ? attributes + 4 : attributes;
    const EGLAttrib withoutSlice[] = {EGL_GL_TEXTURE_LEVEL, mipLevel, EGL_NONE};
    if (target != EGL_GL_TEXTURE_3D && target != EGL_GL_RENDERBUFFER) {
        list = withoutSlice;
    }
    const EGLImage image =
        eglCreateImage(display, maker, target, reinterpret_cast<EGLClientBuffer>(std::uintptr_t{name}), list);
    if (image == EGL_NO_IMAGE) {
        fail("no image of 0x%04x (EGL error 0x%04x)", target, eglGetError());
    }
    return image;
}

void makeSources() {
    use(EGL_OPENGL_API, maker);
    GLuint names[3];
    glGenTextures(3, names);
    level = names[0];
    cube = names[1];
    volume = names[2];
    glBindTexture(GL_TEXTURE_2D, level);
    for (int i = 0; i < 6; ++i) {
        glTexImage2D(GL_TEXTURE_2D, i, GL_RGBA8, kSize * 2 >> i, kSize * 2 >> i, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 5);
    glBindTexture(GL_TEXTURE_CUBE_MAP, cube);
    for (unsigned face = 0; face < 6; ++face) {
        glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGBA8, kSize, kSize, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     nullptr);
    }
    glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAX_LEVEL, 0);
    glBindTexture(GL_TEXTURE_3D, volume);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, kSize, kSize, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAX_LEVEL, 0);
    glGenRenderbuffers(1, &renderbuffer);
    glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, kSize, kSize);
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    checkNoError("making the sources");
}

// Draws the contents of an image in the context that made it.
void drawSource(int which, int frame) {
    use(EGL_OPENGL_API, maker);
    switch (which) {
    case 0: glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, level, 1); break;
    case 1:
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_CUBE_MAP_NEGATIVE_Y, cube, 0);
        break;
    case 2: glFramebufferTexture3D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_3D, volume, 0, 2); break;
    default: glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffer); break;
    }
    glViewport(0, 0, kSize, kSize);
    for (int i = 0; i < 8; ++i) {
        fillRectangle(i * 4, (i * 5 + frame * 3 + which * 7) % kSize, 6, 9,
                      {0.12F * float(i), 0.2F * float(which), 1.0F - 0.1F * float(i)});
    }
    glFinish();
    checkNoError("drawing a source");
}

// A framebuffer of this context with an image as its attachment.
class Over {
public:
    explicit Over(EGLImage image) {
        glGenRenderbuffers(1, &renderbuffer_);
        glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer_);
        intoRenderbuffer(GL_RENDERBUFFER, image);
        glGenFramebuffers(1, &framebuffer_);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffer_);
    }
    Over(const Over&) = delete;
    Over& operator=(const Over&) = delete;
    ~Over() {
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glDeleteFramebuffers(1, &framebuffer_);
        glDeleteRenderbuffers(1, &renderbuffer_);
    }

private:
    GLuint renderbuffer_ = 0, framebuffer_ = 0;
};

// Draws through an external texture, in ES: from the texture's level into the cube's face.
void drawEmbedded(EGLImage from, EGLImage to, int frame) {
    use(EGL_OPENGL_ES_API, embedded);
    static const GLuint program =
        buildProgram({{GL_VERTEX_SHADER, "attribute vec2 place; varying vec2 at; void main() { at = place * 0.5 + 0.5; "
                                         "gl_Position = vec4(place, 0.0, 1.0); }\n"},
                      {GL_FRAGMENT_SHADER, "#extension GL_OES_EGL_image_external : require\nprecision mediump float; "
                                           "uniform samplerExternalOES image; varying vec2 at;\n"
                                           "void main() { gl_FragColor = vec4(texture2D(image, at).bgr, 1.0); }\n"}},
                     [](unsigned linking) { glBindAttribLocation(linking, 0, "place"); });
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(kExternal, texture);
    intoTexture(kExternal, from);
    glTexParameteri(kExternal, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(kExternal, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    {
        const Over over(to);
        glViewport(0, 0, kSize, kSize);
        const float y = 0.3F + 0.1F * float(frame);
        const float places[] = {-0.9F, -0.9F, 0.9F, -0.8F, -0.8F, y, 0.8F, 0.9F};
        glUseProgram(program);
        glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, places);
        glEnableVertexAttribArray(0);
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
        glFinish();
    }
    glDeleteTextures(1, &texture);
    checkNoError("in the ES context");
}

// Reads an image, draws a little into it for its maker, and shows the pixels that were read.
void showAndChange(EGLImage image, int x, int y, int frame) {
    GLubyte pixels[kSize * kSize * 4];
    {
        const Over over(image);
        glReadPixels(0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
        fillRectangle(frame % 20, 3, 12, 5, {0.9F, 0.1F * float(frame % 8), 0.4F});
        glFinish();
    }
    glWindowPos2i(x, y);
    glDrawPixels(kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openEglWindow({}, options.width, options.height);
    window->makeCurrent();
    display = eglGetCurrentDisplay();
    intoTexture = entry<TextureTarget>("glEGLImageTargetTexture2DOES");
    intoRenderbuffer = entry<TextureTarget>("glEGLImageTargetRenderbufferStorageOES");
    const auto intoStorage = entry<StorageTarget>("glEGLImageTargetTexStorageEXT");
    maker = makeContext(EGL_OPENGL_API, 3, 0);
    embedded = makeContext(EGL_OPENGL_ES_API, 2, 0);
    makeSources();
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    const EGLImage first = makeImage(EGL_GL_TEXTURE_2D, level, 1, 0); // no context is current
    for (int frame = 0; frame < options.frames; ++frame) {
        for (int which = 0; which < 4; ++which) {
            drawSource(which, frame);
        }
        const EGLImage images[] = {first, makeImage(EGL_GL_TEXTURE_CUBE_MAP_NEGATIVE_Y, cube, 0, 0),
                                   makeImage(EGL_GL_TEXTURE_3D, volume, 0, 2),
                                   makeImage(EGL_GL_RENDERBUFFER, renderbuffer, 0, 0)};
        drawEmbedded(images[0], images[1], frame);
        eglBindAPI(EGL_OPENGL_API);
        window->makeCurrent();
        glClearColor(0.2F, 0.3F, 0.1F * float(frame % 8), 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        GLuint textures[2];
        glGenTextures(2, textures);
        for (int i = 0; i < 2; ++i) {
            glBindTexture(GL_TEXTURE_2D, textures[i]);
            if (i == 0) {
                intoStorage(GL_TEXTURE_2D, images[0], nullptr);
            } else {
                intoTexture(GL_TEXTURE_2D, images[3]);
            }
            glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
            drawTexturedQuad(-0.95F + 0.6F * float(i), -0.8F, 0.45F, 0.7F);
        }
        glDeleteTextures(2, textures);
        for (int i = 1; i < 4; ++i) {
            showAndChange(images[i], options.width * i / 4 - 10, options.height - 60 + i * 7, frame);
        }
        for (int i = 1; i < 4; ++i) {
            eglDestroyImage(display, images[i]);
        }
        checkNoError("in the window");
        window->swap();
    }
    return 0;
}
