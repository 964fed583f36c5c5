#include "nodes/gl/osmesa_pixels.hpp"

#include <array>
#include <utility>

namespace mural::gl {
namespace {

// Lossless format of a plane in client memory.
struct PlaneFormat {
    GLbitfield mask;
    GLenum internalFormat, format, type, attachment;
    size_t bytesPerPixel;
};

PlaneFormat colorFormat(const SurfaceConfig& c) {
    const GLbitfield mask = GL_COLOR_BUFFER_BIT;
    if (c.green == 6) return {mask, GL_RGB565, GL_RGB, GL_UNSIGNED_SHORT_5_6_5, GL_COLOR_ATTACHMENT0, 2};
    return {mask, GL_RGBA8, GL_BGRA, GL_UNSIGNED_BYTE, GL_COLOR_ATTACHMENT0, 4};
}

PlaneFormat depthStencilFormat(const SurfaceConfig& c) {
    if (c.depth && c.stencil)
        return {GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT,
                GL_DEPTH24_STENCIL8,
                GL_DEPTH_STENCIL,
                GL_UNSIGNED_INT_24_8,
                GL_DEPTH_STENCIL_ATTACHMENT,
                4};
    if (c.depth == 16)
        return {GL_DEPTH_BUFFER_BIT, GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT,
                GL_UNSIGNED_SHORT,   GL_DEPTH_ATTACHMENT,  2};
    return {GL_DEPTH_BUFFER_BIT, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, GL_DEPTH_ATTACHMENT, 4};
}

using Setting = std::pair<GLenum, GLint>;

// Rows without gaps, nothing skipped or swapped.
constexpr std::array<Setting, 12> kPixelStore{{
    {GL_PACK_ALIGNMENT, 1},
    {GL_PACK_ROW_LENGTH, 0},
    {GL_PACK_SKIP_ROWS, 0},
    {GL_PACK_SKIP_PIXELS, 0},
    {GL_PACK_SWAP_BYTES, 0},
    {GL_PACK_LSB_FIRST, 0},
    {GL_UNPACK_ALIGNMENT, 1},
    {GL_UNPACK_ROW_LENGTH, 0},
    {GL_UNPACK_SKIP_ROWS, 0},
    {GL_UNPACK_SKIP_PIXELS, 0},
    {GL_UNPACK_SWAP_BYTES, 0},
    {GL_UNPACK_LSB_FIRST, 0},
}};

constexpr std::array<Setting, 14> kPixelTransfer{{
    {GL_RED_SCALE, 1},
    {GL_RED_BIAS, 0},
    {GL_GREEN_SCALE, 1},
    {GL_GREEN_BIAS, 0},
    {GL_BLUE_SCALE, 1},
    {GL_BLUE_BIAS, 0},
    {GL_ALPHA_SCALE, 1},
    {GL_ALPHA_BIAS, 0},
    {GL_DEPTH_SCALE, 1},
    {GL_DEPTH_BIAS, 0},
    {GL_MAP_COLOR, 0},
    {GL_MAP_STENCIL, 0},
    {GL_INDEX_SHIFT, 0},
    {GL_INDEX_OFFSET, 0},
}};

template <class Function> void load(decltype(&OSMesaGetProcAddress) find, Function& function, const char* name) {
    function = reinterpret_cast<Function>(find(name));
}

} // namespace

// During its lifetime, pixels pass unchanged between client memory and the default framebuffer.
class OsmesaPixels::NeutralState {
public:
    NeutralState(const OsmesaPixels& pixels, bool compatibility)
        : pixels_(pixels), gl_(pixels.gl_), compatibility_(compatibility) {
        for (size_t i = 0; i < kPixelStore.size(); i++) {
            store_[i] = pixels_.get(kPixelStore[i].first);
            gl_.pixelStorei(kPixelStore[i].first, kPixelStore[i].second);
        }
        for (size_t i = 0; compatibility_ && i < kPixelTransfer.size(); i++) {
            gl_.getFloatv(kPixelTransfer[i].first, &transfer_[i]);
            gl_.pixelTransferf(kPixelTransfer[i].first, static_cast<GLfloat>(kPixelTransfer[i].second));
        }
        gl_.bindBuffer(GL_PIXEL_PACK_BUFFER, 0);
        gl_.bindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
        gl_.bindFramebuffer(GL_FRAMEBUFFER, 0);
        defaultDraw_ = pixels_.get(GL_DRAW_BUFFER);
        defaultRead_ = pixels_.get(GL_READ_BUFFER);
        gl_.drawBuffer(GL_FRONT);
        gl_.readBuffer(GL_FRONT);
        gl_.disable(GL_FRAMEBUFFER_SRGB);
        gl_.disablei(GL_SCISSOR_TEST, 0); // a blit uses the first scissor box only
    }
    NeutralState(const NeutralState&) = delete;
    NeutralState& operator=(const NeutralState&) = delete;
    ~NeutralState() {
        gl_.bindFramebuffer(GL_FRAMEBUFFER, 0);
        gl_.drawBuffer(static_cast<GLenum>(defaultDraw_));
        gl_.readBuffer(static_cast<GLenum>(defaultRead_));
        gl_.bindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(drawFramebuffer_));
        gl_.bindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(readFramebuffer_));
        gl_.bindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(packBuffer_));
        gl_.bindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(unpackBuffer_));
        if (srgb_) gl_.enable(GL_FRAMEBUFFER_SRGB);
        if (scissor_) gl_.enablei(GL_SCISSOR_TEST, 0);
        for (size_t i = 0; i < kPixelStore.size(); i++) gl_.pixelStorei(kPixelStore[i].first, store_[i]);
        for (size_t i = 0; compatibility_ && i < kPixelTransfer.size(); i++)
            gl_.pixelTransferf(kPixelTransfer[i].first, transfer_[i]);
    }

private:
    const OsmesaPixels& pixels_;
    const Functions& gl_;
    bool compatibility_;
    GLint drawFramebuffer_ = pixels_.get(GL_DRAW_FRAMEBUFFER_BINDING);
    GLint readFramebuffer_ = pixels_.get(GL_READ_FRAMEBUFFER_BINDING);
    GLint packBuffer_ = pixels_.get(GL_PIXEL_PACK_BUFFER_BINDING);
    GLint unpackBuffer_ = pixels_.get(GL_PIXEL_UNPACK_BUFFER_BINDING);
    GLboolean srgb_ = gl_.isEnabled(GL_FRAMEBUFFER_SRGB);
    GLboolean scissor_ = gl_.isEnabledi(GL_SCISSOR_TEST, 0);
    GLint defaultDraw_ = GL_FRONT, defaultRead_ = GL_FRONT;
    std::array<GLint, kPixelStore.size()> store_{};
    std::array<GLfloat, kPixelTransfer.size()> transfer_{};
};

OsmesaPixels::OsmesaPixels(decltype(&OSMesaGetProcAddress) find) {
    load(find, gl_.bindBuffer, "glBindBuffer");
    load(find, gl_.bindFramebuffer, "glBindFramebuffer");
    load(find, gl_.blitFramebuffer, "glBlitFramebuffer");
    load(find, gl_.deleteFramebuffers, "glDeleteFramebuffers");
    load(find, gl_.genFramebuffers, "glGenFramebuffers");
    load(find, gl_.framebufferTexture2D, "glFramebufferTexture2D");
    load(find, gl_.clearBufferfv, "glClearBufferfv");
    load(find, gl_.clearBufferiv, "glClearBufferiv");
    load(find, gl_.depthMask, "glDepthMask");
    load(find, gl_.stencilMaskSeparate, "glStencilMaskSeparate");
    load(find, gl_.colorMaski, "glColorMaski");
    load(find, gl_.getBooleani, "glGetBooleani_v");
    load(find, gl_.enablei, "glEnablei");
    load(find, gl_.disablei, "glDisablei");
    load(find, gl_.isEnabledi, "glIsEnabledi");
    load(find, gl_.bindTexture, "glBindTexture");
    load(find, gl_.deleteTextures, "glDeleteTextures");
    load(find, gl_.disable, "glDisable");
    load(find, gl_.drawBuffer, "glDrawBuffer");
    load(find, gl_.enable, "glEnable");
    load(find, gl_.genTextures, "glGenTextures");
    load(find, gl_.getFloatv, "glGetFloatv");
    load(find, gl_.getIntegerv, "glGetIntegerv");
    load(find, gl_.isEnabled, "glIsEnabled");
    load(find, gl_.pixelStorei, "glPixelStorei");
    load(find, gl_.pixelTransferf, "glPixelTransferf");
    load(find, gl_.readBuffer, "glReadBuffer");
    load(find, gl_.readPixels, "glReadPixels");
    load(find, gl_.texImage2D, "glTexImage2D");
}

GLint OsmesaPixels::get(GLenum name) const {
    GLint value = 0;
    gl_.getIntegerv(name, &value);
    return value;
}

SavedPixels OsmesaPixels::save(const SurfaceConfig& config, bool compatibility) const {
    const NeutralState neutral(*this, compatibility);
    SavedPixels saved;
    auto read = [&](const PlaneFormat& plane, std::vector<std::byte>& pixels) {
        pixels.resize(static_cast<size_t>(config.width) * static_cast<size_t>(config.height) * plane.bytesPerPixel);
        gl_.readPixels(0, 0, config.width, config.height, plane.format, plane.type, pixels.data());
    };
    read(colorFormat(config), saved.color);
    read(depthStencilFormat(config), saved.depthStencil);
    saved.valid = true;
    return saved;
}

void OsmesaPixels::restore(const SurfaceConfig& config, bool compatibility, const SavedPixels& pixels) const {
    const NeutralState neutral(*this, compatibility);
    restorePlane(config, GL_COLOR_BUFFER_BIT, pixels.color);
    restorePlane(config, GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT, pixels.depthStencil);
}

void OsmesaPixels::clearNew(const SurfaceConfig& config, bool compatibility, GLfloat alpha) const {
    const NeutralState neutral(*this, compatibility);
    GLboolean mask[4] = {GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE};
    gl_.getBooleani(GL_COLOR_WRITEMASK, 0, mask);
    gl_.colorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    const GLfloat black[4] = {0, 0, 0, alpha};
    gl_.clearBufferfv(GL_COLOR, 0, black);
    gl_.colorMaski(0, mask[0], mask[1], mask[2], mask[3]);
    const GLint deep = get(GL_DEPTH_WRITEMASK), front = get(GL_STENCIL_WRITEMASK),
                back = get(GL_STENCIL_BACK_WRITEMASK);
    const GLfloat nearest = 0;
    const GLint zero = 0;
    if (config.depth > 0) {
        gl_.depthMask(GL_TRUE);
        gl_.clearBufferfv(GL_DEPTH, 0, &nearest);
        gl_.depthMask(deep ? GL_TRUE : GL_FALSE);
    }
    if (config.stencil > 0) {
        gl_.stencilMaskSeparate(GL_FRONT_AND_BACK, ~0U);
        gl_.clearBufferiv(GL_STENCIL, 0, &zero);
        gl_.stencilMaskSeparate(GL_FRONT, static_cast<GLuint>(front));
        gl_.stencilMaskSeparate(GL_BACK, static_cast<GLuint>(back));
    }
}

void OsmesaPixels::restorePlane(const SurfaceConfig& config, GLbitfield mask,
                                const std::vector<std::byte>& pixels) const {
    const PlaneFormat plane = mask == GL_COLOR_BUFFER_BIT ? colorFormat(config) : depthStencilFormat(config);
    const GLint boundTexture = get(GL_TEXTURE_BINDING_2D);
    GLuint texture = 0, framebuffer = 0;
    gl_.genTextures(1, &texture);
    gl_.bindTexture(GL_TEXTURE_2D, texture);
    gl_.texImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(plane.internalFormat), config.width, config.height, 0,
                   plane.format, plane.type, pixels.data());
    gl_.genFramebuffers(1, &framebuffer);
    gl_.bindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    gl_.framebufferTexture2D(GL_READ_FRAMEBUFFER, plane.attachment, GL_TEXTURE_2D, texture, 0);
    gl_.readBuffer(plane.mask == GL_COLOR_BUFFER_BIT ? GL_COLOR_ATTACHMENT0 : GL_NONE);
    gl_.blitFramebuffer(0, 0, config.width, config.height, 0, 0, config.width, config.height, plane.mask, GL_NEAREST);
    gl_.bindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    gl_.bindTexture(GL_TEXTURE_2D, static_cast<GLuint>(boundTexture));
    gl_.deleteFramebuffers(1, &framebuffer);
    gl_.deleteTextures(1, &texture);
}

} // namespace mural::gl
