#include "tests/streamcodec/sizes_gl_context.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "streamcodec/sizes/gl_enums.hpp"

namespace mural::sizes {
namespace {

EGLDisplay openDisplay() {
    auto getPlatformDisplay =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (getPlatformDisplay == nullptr) return EGL_NO_DISPLAY;
    EGLDisplay display = getPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE ? display : EGL_NO_DISPLAY;
}

EGLContext makeContext(EGLDisplay display, TestApi api) {
    const bool desktop = api == TestApi::Compatibility;
    eglBindAPI(desktop ? EGL_OPENGL_API : EGL_OPENGL_ES_API);
    const EGLint renderable = desktop ? EGL_OPENGL_BIT : api == TestApi::Es1 ? EGL_OPENGL_ES_BIT : EGL_OPENGL_ES3_BIT;
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, renderable, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display, wanted, &config, 1, &count) != EGL_TRUE || count < 1) return EGL_NO_CONTEXT;
    const EGLint es[] = {EGL_CONTEXT_CLIENT_VERSION, api == TestApi::Es1 ? 1 : 3, EGL_NONE};
    const EGLint gl[] = {EGL_CONTEXT_MAJOR_VERSION,
                         4,
                         EGL_CONTEXT_MINOR_VERSION,
                         5,
                         EGL_CONTEXT_OPENGL_PROFILE_MASK,
                         EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT,
                         EGL_NONE};
    return eglCreateContext(display, config, EGL_NO_CONTEXT, desktop ? gl : es);
}

} // namespace

TestContext::TestContext(TestApi api) : display_(openDisplay()) {
    if (display_ == EGL_NO_DISPLAY) return;
    context_ = makeContext(display_, api);
    if (context_ != nullptr && eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
        eglDestroyContext(display_, context_);
        context_ = nullptr;
    }
}

TestContext::~TestContext() {
    if (display_ == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_ != nullptr) eglDestroyContext(display_, context_);
    eglTerminate(display_);
}

void (*procAddress(const char* name))() { return eglGetProcAddress(name); }

bool takeErrors() {
    bool any = false;
    while (glGetError() != GL_NO_ERROR) any = true;
    return any;
}

void setPixelStore(Direction direction, const PixelStore& store, TestApi api) {
    const bool pack = direction == Direction::Pack;
    glPixelStorei(pack ? GL_PACK_ALIGNMENT : GL_UNPACK_ALIGNMENT, store.alignment);
    if (api == TestApi::Es1) return;
    glPixelStorei(pack ? GL_PACK_ROW_LENGTH : GL_UNPACK_ROW_LENGTH, store.rowLength);
    glPixelStorei(pack ? GL_PACK_SKIP_ROWS : GL_UNPACK_SKIP_ROWS, store.skipRows);
    glPixelStorei(pack ? GL_PACK_SKIP_PIXELS : GL_UNPACK_SKIP_PIXELS, store.skipPixels);
    if (api == TestApi::Compatibility || !pack) {
        glPixelStorei(pack ? GL_PACK_IMAGE_HEIGHT : GL_UNPACK_IMAGE_HEIGHT, store.imageHeight);
        glPixelStorei(pack ? GL_PACK_SKIP_IMAGES : GL_UNPACK_SKIP_IMAGES, store.skipImages);
    }
    if (api != TestApi::Compatibility) return;
    glPixelStorei(pack ? GL_PACK_SWAP_BYTES : GL_UNPACK_SWAP_BYTES, store.swapBytes);
    glPixelStorei(pack ? GL_PACK_LSB_FIRST : GL_UNPACK_LSB_FIRST, store.lsbFirst);
    if (pack) glPixelStorei(GL_PACK_INVERT_MESA, store.invert);
    glPixelStorei(pack ? GL_PACK_COMPRESSED_BLOCK_WIDTH : GL_UNPACK_COMPRESSED_BLOCK_WIDTH, store.compressedBlockWidth);
    glPixelStorei(pack ? GL_PACK_COMPRESSED_BLOCK_HEIGHT : GL_UNPACK_COMPRESSED_BLOCK_HEIGHT,
                  store.compressedBlockHeight);
    glPixelStorei(pack ? GL_PACK_COMPRESSED_BLOCK_DEPTH : GL_UNPACK_COMPRESSED_BLOCK_DEPTH, store.compressedBlockDepth);
    glPixelStorei(pack ? GL_PACK_COMPRESSED_BLOCK_SIZE : GL_UNPACK_COMPRESSED_BLOCK_SIZE, store.compressedBlockSize);
}

PixelStore tightStore() {
    PixelStore store;
    store.alignment = 1;
    return store;
}

std::vector<GLenum> knownFormats() {
    std::vector<GLenum> formats;
    for (GLenum format = 0; format <= 0xffff; ++format)
        if (componentsOf(format) != 0) formats.push_back(format);
    return formats;
}

const std::vector<GLenum>& knownTypes() {
    static const std::vector<GLenum> types = [] {
        std::vector<GLenum> found;
        for (GLenum type = 0; type <= 0xffff; ++type)
            if (swapUnitBytes(type) != 0) found.push_back(type);
        return found;
    }();
    return types;
}

TestFramebuffer::TestFramebuffer(GLenum internalformat, GLenum format, GLenum type) {
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    std::vector<uint8_t> noise(size_t{kSize} * kSize * 16);
    for (size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<uint8_t>(i * 37 + i / 251);
    setPixelStore(Direction::Unpack, tightStore(), TestApi::Es1);
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internalformat), kSize, kSize, 0, format, type, noise.data());
    glGenFramebuffers(1, &framebuffer_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    const GLenum point = format == GL_DEPTH_COMPONENT ? GL_DEPTH_ATTACHMENT
                         : format == GL_DEPTH_STENCIL ? GL_DEPTH_STENCIL_ATTACHMENT
                         : format == GL_STENCIL_INDEX ? GL_STENCIL_ATTACHMENT
                                                      : GL_COLOR_ATTACHMENT0;
    glFramebufferTexture2D(GL_FRAMEBUFFER, point, GL_TEXTURE_2D, texture_, 0);
    if (point != GL_COLOR_ATTACHMENT0) {
        const GLenum none = GL_NONE;
        glDrawBuffers(1, &none);
        glReadBuffer(GL_NONE);
    }
    complete_ = !takeErrors() && glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

TestFramebuffer::~TestFramebuffer() {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteTextures(1, &texture_);
}

} // namespace mural::sizes
