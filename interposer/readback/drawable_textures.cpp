#include "interposer/readback/drawable_textures.hpp"

#include <atomic>
#include <cstring>

#include "encoders.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/diagnostics/log.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/memory/pixel_store.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {

GLint get(GLenum name) {
    GLint value = 0;
    gReal.glGetIntegerv(name, &value);
    return value;
}

// Sets a tight pack state for client memory, independent of the program's.
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
    static constexpr GLenum kNames[kCount] = {GL_PACK_ALIGNMENT,   GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS,
                                              GL_PACK_SKIP_PIXELS, GL_PACK_SWAP_BYTES, GL_PACK_LSB_FIRST};
    static constexpr GLint kTight[kCount] = {4, 0, 0, 0, 0, 0};
    bool buffers_;
    GLint before_[kCount] = {};
    GLint buffer_ = 0;
};

void upload(ThreadState& t, GLenum target, bool alpha, GLint width, GLint height, GLenum format, const void* pixels) {
    const uint64_t bytes = uint64_t(width) * uint64_t(height) * 4;
    const GLint buffer = unpackBufferBound(*t.context) ? get(GL_PIXEL_UNPACK_BUFFER_BINDING) : 0;
    if (buffer) encode_glBindBuffer(t, GL_PIXEL_UNPACK_BUFFER, 0);
    encode_glTexImage2D(t, target, 0, alpha ? GL_RGBA : GL_RGB, width, height, 0, format, GL_UNSIGNED_BYTE,
                        DataArg::of(pixels, bytes));
    if (buffer) encode_glBindBuffer(t, GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(buffer));
}

} // namespace

void textureFromLocal(GLenum target, bool alpha) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return;
    if (t.context->api != wire::Api::Desktop || !gReal.glGetTexImage || !gReal.glGetTexLevelParameteriv) {
        static bool once = false;
        if (!__atomic_exchange_n(&once, true, __ATOMIC_RELAXED))
            say("pixmaps as textures of OpenGL ES contexts are not supported on the wall");
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

namespace {

// Number over all windows; most programs have none.
std::atomic<int> boundPbuffers{0};

// Flips the picture if the driver is Mesa, which draws into pbuffers from the top row down, as into windows. The
// texture shares that memory, so it is upside down.
const void* asTheDriverHasIt(ThreadState& t, const void* pixels, GLint width, GLint height) {
    if (!pixels || !t.context->isMesa) return pixels;
    const size_t row = size_t(width) * 4, rows = size_t(height);
    auto* turned = static_cast<std::byte*>(scratchMemory(t, row * rows));
    for (size_t y = 0; turned && y < rows; ++y)
        std::memcpy(turned + y * row, static_cast<const std::byte*>(pixels) + (rows - 1 - y) * row, row);
    return turned;
}

void textureFromDrawn(ThreadState& t, const Window& w) {
    if (!w.announced) return; // nothing has been drawn there yet
    const Context& c = *t.context;
    const bool separate = c.version >= 30;
    const GLenum target = separate ? GL_READ_FRAMEBUFFER : GL_FRAMEBUFFER;
    const GLint framebuffer =
        c.api == wire::Api::Es1 ? 0 : get(separate ? GL_READ_FRAMEBUFFER_BINDING : GL_FRAMEBUFFER_BINDING);
    const auto bound = static_cast<GLuint>(get(GL_TEXTURE_BINDING_2D));
    records::makeCurrent(t, c.id, c.drawWindow, w.id);
    if (framebuffer) encode_glBindFramebuffer(t, target, 0);
    const auto width = static_cast<GLint>(w.config.width), height = static_cast<GLint>(w.config.height);
    const void* pixels = asTheDriverHasIt(
        t, requestPixels(t, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, wire::kPlainTransfer), width, height);
    if (framebuffer) encode_glBindFramebuffer(t, target, static_cast<GLuint>(framebuffer));
    records::makeCurrent(t, c.id, c.drawWindow, c.readWindow);
    if (!pixels) return;
    if (bound != w.boundTexture) encode_glBindTexture(t, GL_TEXTURE_2D, w.boundTexture);
    upload(t, GL_TEXTURE_2D, w.boundAlpha, width, height, GL_RGBA, pixels);
    if (bound != w.boundTexture) encode_glBindTexture(t, GL_TEXTURE_2D, bound);
}

} // namespace

void bindDrawn(Window& w, bool alpha) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return;
    releaseDrawn(w);
    w.boundTexture = static_cast<GLuint>(get(GL_TEXTURE_BINDING_2D));
    w.boundGroup = t.context->group;
    w.boundAlpha = alpha;
    ++boundPbuffers;
    textureFromDrawn(t, w);
}

void releaseDrawn(Window& w) {
    if (!w.boundGroup) return;
    w.boundGroup = nullptr;
    w.boundTextureDue = false;
    --boundPbuffers;
}

void beforeDrawableSwitch(const ThreadState& t) {
    if (boundPbuffers.load(std::memory_order_relaxed) == 0 || !t.context) return;
    if (Window* drawn = findWindowById(t.context->drawWindow); drawn && drawn->boundGroup)
        drawn->boundTextureDue = true;
}

void refreshBoundTextures(ThreadState& t) {
    if (boundPbuffers.load(std::memory_order_relaxed) == 0 || !capturing(t)) return;
    for (Window* w = nextWindow(nullptr); w; w = nextWindow(w)) {
        if (!w->boundTextureDue || w->boundGroup != t.context->group || w->id == t.context->drawWindow) continue;
        w->boundTextureDue = false;
        if (w->boundTexture == 0 || gReal.glIsTexture(w->boundTexture)) textureFromDrawn(t, *w);
    }
}

} // namespace mural
