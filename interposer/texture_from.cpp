#include "interposer/texture_from.hpp"

#include "encoders.hpp"
#include "interposer/asking.hpp"
#include "interposer/context.hpp"
#include "interposer/log.hpp"
#include "interposer/own_records.hpp"
#include "interposer/pixel_store.hpp"
#include "interposer/real_gl.hpp"
#include "interposer/session.hpp"

namespace mural {

namespace {

bool capturing(const ThreadState& t) {
    const Session* s = Session::current();
    return t.context && s && s->alive();
}

GLint get(GLenum name) {
    GLint value = 0;
    gReal.glGetIntegerv(name, &value);
    return value;
}

// Rows without gaps into client memory, whatever the program has set.
class PackTightly {
public:
    explicit PackTightly(const Context& c) : buffers_(packBufferBound(c)) {
        for (int i = 0; i < kCount; ++i) {
            before_[i] = get(kNames[i]);
            gReal.glPixelStorei(kNames[i], kTight[i]);
        }
        if (!buffers_) return;
        buffer_ = get(GL_PIXEL_PACK_BUFFER_BINDING);
        gReal.glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    }
    PackTightly(const PackTightly&) = delete;
    PackTightly& operator=(const PackTightly&) = delete;
    ~PackTightly() {
        for (int i = 0; i < kCount; ++i) gReal.glPixelStorei(kNames[i], before_[i]);
        if (buffers_) gReal.glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(buffer_));
    }

private:
    static constexpr int kCount = 6;
    static constexpr GLenum kNames[kCount] = {GL_PACK_ALIGNMENT, GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS, GL_PACK_SWAP_BYTES, GL_PACK_LSB_FIRST};
    static constexpr GLint kTight[kCount] = {4, 0, 0, 0, 0, 0};
    bool buffers_;
    GLint before_[kCount] = {};
    GLint buffer_ = 0;
};

void upload(ThreadState& t, GLenum target, bool alpha, GLint width, GLint height, GLenum format, const void* pixels) {
    const uint64_t bytes = uint64_t(width) * uint64_t(height) * 4;
    const GLint buffer = unpackBufferBound(*t.context) ? get(GL_PIXEL_UNPACK_BUFFER_BINDING) : 0;
    if (buffer) encode_glBindBuffer(t, GL_PIXEL_UNPACK_BUFFER, 0);
    encode_glTexImage2D(t, target, 0, alpha ? GL_RGBA : GL_RGB, width, height, 0, format, GL_UNSIGNED_BYTE, DataArg::of(pixels, bytes));
    if (buffer) encode_glBindBuffer(t, GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(buffer));
}

} // namespace

void textureFromLocal(GLenum target, bool alpha) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return;
    if (t.context->api != wire::Api::Desktop || !gReal.glGetTexImage || !gReal.glGetTexLevelParameteriv) {
        static bool once = false;
        if (!__atomic_exchange_n(&once, true, __ATOMIC_RELAXED)) say("pixmaps as textures of OpenGL ES contexts are not carried to the wall");
        return;
    }
    GLint width = 0, height = 0;
    gReal.glGetTexLevelParameteriv(target, 0, GL_TEXTURE_WIDTH, &width);
    gReal.glGetTexLevelParameteriv(target, 0, GL_TEXTURE_HEIGHT, &height);
    void* pixels = width > 0 && height > 0 ? secondScratch(t, size_t(width) * size_t(height) * 4) : nullptr;
    if (!pixels) return;
    {
        const PackTightly tight(*t.context);
        gReal.glGetTexImage(target, 0, GL_BGRA, GL_UNSIGNED_BYTE, pixels);
    }
    upload(t, target, alpha, width, height, GL_BGRA, pixels);
}

void textureFromDrawn(Window& w, bool alpha) {
    ThreadState& t = *tThread;
    if (!capturing(t) || !w.announced) return; // nothing was drawn there yet
    const Context& c = *t.context;
    const bool separate = c.version >= 30;
    const GLenum target = separate ? GL_READ_FRAMEBUFFER : GL_FRAMEBUFFER;
    const GLint framebuffer = c.api == wire::Api::Es1 ? 0 : get(separate ? GL_READ_FRAMEBUFFER_BINDING : GL_FRAMEBUFFER_BINDING);
    records::makeCurrent(t, c.id, c.drawWindow, w.id);
    if (framebuffer) encode_glBindFramebuffer(t, target, 0);
    const auto width = static_cast<GLint>(w.config.width), height = static_cast<GLint>(w.config.height);
    const void* pixels = askPixels(t, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, true);
    if (framebuffer) encode_glBindFramebuffer(t, target, static_cast<GLuint>(framebuffer));
    records::makeCurrent(t, c.id, c.drawWindow, c.readWindow);
    if (pixels) upload(t, GL_TEXTURE_2D, alpha, width, height, GL_RGBA, pixels);
}

} // namespace mural
