#include "native/runtime/gl_target.hpp"

#include <algorithm>

namespace mural::native {

Result<std::unique_ptr<GlTarget>> GlTarget::open(std::unique_ptr<gl::Platform> platform, const GlWish& wish) {
    if (wish.isHalfFloat && wish.samples > 0) return Error{"GlWish::isHalfFloat excludes samples; set one of them"};
    gl::SurfaceConfig config;
    config.alpha = 8;
    config.depth = wish.depthBits;
    config.stencil = wish.stencilBits;
    config.samples = wish.samples;
    std::unique_ptr<GlTarget> target(new GlTarget(std::move(platform), config, wish.isHalfFloat));
    gl::ContextConfig context;
    context.major = wish.major;
    context.minor = wish.minor;
    context.core = wish.isCore;
    context.debug = wish.isDebug;
    context.surface = config;
    auto made = target->platform_->createContext(context, nullptr);
    if (!made) return made.error();
    target->context_ = std::move(*made);
    if (auto sized = target->resizeSurface({0, 0, 1, 1}); !sized) return sized.error();
    auto calls = GlCalls::load(*target->platform_);
    if (!calls) return calls.error();
    target->gl_ = *calls;
    if (auto sized = target->resize({0, 0, 1, 1}); !sized) return sized.error();
    return target;
}

GlTarget::~GlTarget() {
    if (context_) (void)platform_->makeCurrent(nullptr, nullptr, nullptr); // its objects end with the context
}

Result<void> GlTarget::resize(const PixelViewport& size) {
    return isHalfFloat_ ? resizeTextures(size) : resizeSurface(size);
}

// Attaches new textures. Leaves the framebuffer bound.
Result<void> GlTarget::resizeTextures(const PixelViewport& size) {
    if (framebuffer_ != 0 && width_ >= size.w && height_ >= size.h) return {};
    GLint bound = 0;
    gl_.getIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    gl_.bindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    if (framebuffer_ == 0) {
        gl_.genFramebuffers(1, &framebuffer_);
        gl_.genTextures(1, &colour_);
        gl_.genTextures(1, &depth_);
    }
    width_ = std::max(size.w, width_);
    height_ = std::max(size.h, height_);
    gl_.bindTexture(GL_TEXTURE_2D, colour_);
    gl_.texParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_.texImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, width_, height_, 0, GL_RGBA, GL_HALF_FLOAT, nullptr);
    gl_.bindTexture(GL_TEXTURE_2D, depth_);
    gl_.texParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_.texImage2D(GL_TEXTURE_2D, 0, GL_DEPTH24_STENCIL8, width_, height_, 0, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8,
                   nullptr);
    gl_.bindTexture(GL_TEXTURE_2D, static_cast<GLuint>(bound));
    gl_.bindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    gl_.framebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_, 0);
    gl_.framebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, depth_, 0);
    if (gl_.checkFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return {};
    return Error{"the driver has no framebuffer of half floats with " + std::to_string(width_) + " x " +
                 std::to_string(height_) + " pixels; leave GlWish::isHalfFloat out"};
}

Result<void> GlTarget::resizeSurface(const PixelViewport& size) {
    if (surface_ && surface_->width() >= size.w && surface_->height() >= size.h) return {};
    gl::SurfaceConfig config = config_;
    config.width = size.w;
    config.height = size.h;
    auto made = platform_->createSurface(config);
    if (!made) return made.error();
    if (auto bound = platform_->makeCurrent(context_.get(), made->get(), made->get()); !bound) return bound;
    surface_ = std::move(*made);
    return {};
}

GLenum GlTarget::colourBuffer() const {
    if (isHalfFloat_) return GL_COLOR_ATTACHMENT0;
    return surface_->colorBuffers() == gl::ColorBuffers::OneNamedFront ? GL_FRONT : GL_BACK;
}

void GlTarget::apply(const PixelViewport& viewport, const PixelViewport& scissor) const {
    gl_.bindFramebuffer(GL_FRAMEBUFFER, framebuffer());
    gl_.drawBuffer(colourBuffer());
    gl_.colorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_.viewport(viewport.x, viewport.y, viewport.w, viewport.h);
    gl_.enable(GL_SCISSOR_TEST);
    gl_.scissor(scissor.x, scissor.y, std::max(scissor.w, 0), std::max(scissor.h, 0));
}

void GlTarget::prepareRead() const {
    gl_.bindFramebuffer(GL_FRAMEBUFFER, framebuffer());
    gl_.readBuffer(colourBuffer());
    gl_.bindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    gl_.pixelStorei(GL_PACK_ALIGNMENT, 4);
    for (const GLenum name : {GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS, GL_PACK_SWAP_BYTES})
        gl_.pixelStorei(name, 0);
}

void GlTarget::readColour(const PixelViewport& box, GLenum format, void* into) const {
    prepareRead();
    gl_.readPixels(box.x, box.y, box.w, box.h, format, GL_UNSIGNED_BYTE, into);
}

void GlTarget::readHalfFloats(const PixelViewport& box, uint32_t* into) const {
    prepareRead();
    gl_.readPixels(box.x, box.y, box.w, box.h, GL_RGBA, GL_HALF_FLOAT, into);
}

void GlTarget::readDepth(const PixelViewport& box, uint32_t* into) const {
    prepareRead();
    gl_.readPixels(box.x, box.y, box.w, box.h, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, into);
}

// A blit writes the pixels unchanged, whatever state the renderer left. glDrawPixels is absent from core profiles.
void GlTarget::write(const PixelViewport& box, GLint format, GLenum type, const void* rgba) const {
    GLuint texture = 0, source = 0;
    GLint active = 0, bound = 0;
    gl_.getIntegerv(GL_ACTIVE_TEXTURE, &active);
    gl_.activeTexture(GL_TEXTURE0);
    gl_.getIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    gl_.bindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    gl_.pixelStorei(GL_UNPACK_ALIGNMENT, 4);
    for (const GLenum name : {GL_UNPACK_ROW_LENGTH, GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SWAP_BYTES})
        gl_.pixelStorei(name, 0);
    gl_.genTextures(1, &texture);
    gl_.bindTexture(GL_TEXTURE_2D, texture);
    gl_.texParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_.texImage2D(GL_TEXTURE_2D, 0, format, box.w, box.h, 0, GL_RGBA, type, rgba);
    gl_.genFramebuffers(1, &source);
    gl_.bindFramebuffer(GL_READ_FRAMEBUFFER, source);
    gl_.framebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    gl_.bindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer());
    gl_.drawBuffer(colourBuffer());
    gl_.disable(GL_SCISSOR_TEST);
    gl_.blitFramebuffer(0, 0, box.w, box.h, box.x, box.y, box.right(), box.top(), GL_COLOR_BUFFER_BIT, GL_NEAREST);
    gl_.enable(GL_SCISSOR_TEST);
    gl_.bindFramebuffer(GL_FRAMEBUFFER, framebuffer());
    gl_.bindTexture(GL_TEXTURE_2D, static_cast<GLuint>(bound));
    gl_.activeTexture(static_cast<GLenum>(active));
    gl_.deleteFramebuffers(1, &source);
    gl_.deleteTextures(1, &texture);
}

void GlTarget::writeColour(const PixelViewport& box, const uint32_t* rgba) const {
    write(box, GL_RGBA8, GL_UNSIGNED_BYTE, rgba);
}

void GlTarget::writeHalfFloats(const PixelViewport& box, const uint32_t* rgba) const {
    write(box, GL_RGBA16F, GL_HALF_FLOAT, rgba);
}

} // namespace mural::native
