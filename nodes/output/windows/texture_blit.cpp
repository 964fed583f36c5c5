#include "nodes/output/windows/texture_blit.hpp"

#include <GL/glcorearb.h>
#include <fmt/format.h>

namespace mural {

struct TextureBlit::Functions {
    PFNGLBINDFRAMEBUFFERPROC bindFramebuffer = nullptr;
    PFNGLBINDTEXTUREPROC bindTexture = nullptr;
    PFNGLBLITFRAMEBUFFERPROC blitFramebuffer = nullptr;
    PFNGLCHECKFRAMEBUFFERSTATUSPROC checkFramebufferStatus = nullptr;
    PFNGLCLEARPROC clear = nullptr;
    PFNGLCLEARCOLORPROC clearColor = nullptr;
    PFNGLDELETEFRAMEBUFFERSPROC deleteFramebuffers = nullptr;
    PFNGLDELETETEXTURESPROC deleteTextures = nullptr;
    PFNGLDRAWBUFFERPROC drawBuffer = nullptr;
    PFNGLFINISHPROC finish = nullptr;
    PFNGLGETBOOLEANVPROC getBooleanv = nullptr;
    PFNGLFRAMEBUFFERTEXTURE2DPROC framebufferTexture2D = nullptr;
    PFNGLGENFRAMEBUFFERSPROC genFramebuffers = nullptr;
    PFNGLGENTEXTURESPROC genTextures = nullptr;
    PFNGLGETERRORPROC getError = nullptr;
    PFNGLGETINTEGERVPROC getIntegerv = nullptr;
    PFNGLGETSTRINGPROC getString = nullptr;
    PFNGLTEXIMAGE2DPROC texImage2D = nullptr;
    PFNGLTEXPARAMETERIPROC texParameteri = nullptr;
    PFNGLTEXSUBIMAGE2DPROC texSubImage2D = nullptr;
    PFNGLVIEWPORTPROC viewport = nullptr;

    // The name of the first missing function; null: none missing.
    const char* load(Loader loader) {
        const char* missing = nullptr;
        const auto get = [&](auto& function, const char* name) {
            function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(loader(name));
            if (function == nullptr && missing == nullptr) missing = name;
        };
        get(bindFramebuffer, "glBindFramebuffer");
        get(bindTexture, "glBindTexture");
        get(blitFramebuffer, "glBlitFramebuffer");
        get(checkFramebufferStatus, "glCheckFramebufferStatus");
        get(clear, "glClear");
        get(clearColor, "glClearColor");
        get(deleteFramebuffers, "glDeleteFramebuffers");
        get(deleteTextures, "glDeleteTextures");
        get(drawBuffer, "glDrawBuffer");
        get(finish, "glFinish");
        get(getBooleanv, "glGetBooleanv");
        get(framebufferTexture2D, "glFramebufferTexture2D");
        get(genFramebuffers, "glGenFramebuffers");
        get(genTextures, "glGenTextures");
        get(getError, "glGetError");
        get(getIntegerv, "glGetIntegerv");
        get(getString, "glGetString");
        get(texImage2D, "glTexImage2D");
        get(texParameteri, "glTexParameteri");
        get(texSubImage2D, "glTexSubImage2D");
        get(viewport, "glViewport");
        return missing;
    }
};

TextureBlit::TextureBlit() : gl_(std::make_unique<Functions>()) {}

Result<std::unique_ptr<TextureBlit>> TextureBlit::create(Loader load) {
    std::unique_ptr<TextureBlit> blit(new TextureBlit);
    if (const char* missing = blit->gl_->load(load); missing != nullptr)
        return Error{fmt::format("the OpenGL of the wall windows has no {}", missing)};
    const GLubyte* name = blit->gl_->getString(GL_RENDERER);
    if (name != nullptr) blit->renderer_ = reinterpret_cast<const char*>(name);
    blit->gl_->genTextures(1, &blit->texture_);
    blit->gl_->genFramebuffers(1, &blit->framebuffer_);
    blit->gl_->clearColor(0, 0, 0, 1);
    return blit;
}

TextureBlit::~TextureBlit() {
    if (framebuffer_ != 0) gl_->deleteFramebuffers(1, &framebuffer_);
    if (texture_ != 0) gl_->deleteTextures(1, &texture_);
}

Result<void> TextureBlit::allocate(int width, int height) {
    if (width == width_ && height == height_) return {};
    GLint largest = 0;
    gl_->getIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    if (width > largest || height > largest) {
        return Error{fmt::format("a tile of {}x{} is larger than {} can show ({}); use more tiles", width, height,
                                 renderer_, largest)};
    }
    gl_->texParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_->texParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_->texParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    gl_->texImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV, nullptr);
    gl_->bindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    gl_->framebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
    const GLenum status = gl_->checkFramebufferStatus(GL_READ_FRAMEBUFFER);
    if (gl_->getError() != GL_NO_ERROR || status != GL_FRAMEBUFFER_COMPLETE) {
        return Error{fmt::format("no memory for a tile of {}x{} on {}; use more tiles", width, height, renderer_)};
    }
    width_ = width;
    height_ = height;
    return {};
}

Result<void> TextureBlit::upload(const Picture& picture) {
    gl_->bindTexture(GL_TEXTURE_2D, texture_);
    if (Result<void> allocated = allocate(picture.width, picture.height); !allocated) return allocated;
    gl_->texSubImage2D(GL_TEXTURE_2D, 0, 0, 0, picture.width, picture.height, GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV,
                       picture.bgra);
    return {};
}

bool TextureBlit::stereo() const {
    GLboolean has = GL_FALSE;
    gl_->getBooleanv(GL_STEREO, &has);
    return has == GL_TRUE;
}

Result<void> TextureBlit::draw(Target target, int framebufferWidth, int framebufferHeight) {
    gl_->viewport(0, 0, framebufferWidth, framebufferHeight);
    gl_->bindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    gl_->drawBuffer(target == Target::Back ? GL_BACK : target == Target::BackLeft ? GL_BACK_LEFT : GL_BACK_RIGHT);
    if (width_ < framebufferWidth || height_ < framebufferHeight) gl_->clear(GL_COLOR_BUFFER_BIT);
    const int bottom = framebufferHeight - height_; // negative if the picture is taller
    gl_->bindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    if (width_ > 0 && height_ > 0)
        gl_->blitFramebuffer(0, 0, width_, height_, 0, bottom, width_, bottom + height_, GL_COLOR_BUFFER_BIT,
                             GL_NEAREST);
    const GLenum error = gl_->getError();
    if (error == GL_NO_ERROR) return {};
    return Error{
        fmt::format("drawing a tile of {}x{} failed on {}: OpenGL error {:#x}", width_, height_, renderer_, error)};
}

void TextureBlit::finish() { gl_->finish(); }

} // namespace mural
