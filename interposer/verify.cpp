#include "interposer/verify.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "custom_wrappers.hpp"
#include "interposer/asking.hpp"
#include "interposer/context.hpp"
#include "interposer/log.hpp"
#include "interposer/real_gl.hpp"
#include "interposer/session.hpp"

extern "C" void mural_glBindFramebuffer(GLenum target, GLuint framebuffer);
extern "C" void mural_glReadBuffer(GLenum buffer);
extern "C" void mural_glPixelStorei(GLenum name, GLint value);

namespace mural {

namespace {

struct PackState {
    static constexpr GLenum kNames[6] = {GL_PACK_SWAP_BYTES, GL_PACK_LSB_FIRST, GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS, GL_PACK_ALIGNMENT};
    GLint values[6] = {0, 0, 0, 0, 0, 4};
    int first;
    explicit PackState(const Context& c) : first(c.api == wire::Api::Desktop ? 0 : c.version >= 30 ? 2 : 5) {
        for (int i = first; i < 6; ++i) gReal.glGetIntegerv(kNames[i], &values[i]);
        for (int i = first; i < 6; ++i) gReal.glPixelStorei(kNames[i], i == 5 ? 1 : 0);
    }
    void restore() const {
        for (int i = first; i < 6; ++i) gReal.glPixelStorei(kNames[i], values[i]);
    }
};

// Reads the window's back buffer into `mine` by the local driver and, through askPixels, from the
// nodes; the program's bindings are put back, here and there.
const void* readBoth(ThreadState& t, Window& w, void* mine) {
    Context& c = *t.context;
    const bool newer = c.api == wire::Api::Desktop ? c.version >= 30 : c.version >= 30;
    const GLenum target = newer ? GL_READ_FRAMEBUFFER : GL_FRAMEBUFFER;
    GLint framebuffer = 0, packBuffer = 0, readBuffer = 0;
    if (gReal.glBindFramebuffer) gReal.glGetIntegerv(newer ? GL_READ_FRAMEBUFFER_BINDING : GL_FRAMEBUFFER_BINDING, &framebuffer);
    if (framebuffer) mural_glBindFramebuffer(target, 0);
    if (newer || c.version >= 21) gReal.glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &packBuffer);
    if (packBuffer) gReal.glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    if (newer && gReal.glReadBuffer) {
        gReal.glGetIntegerv(GL_READ_BUFFER, &readBuffer);
        mural_glReadBuffer(w.config.doubleBuffer || c.api != wire::Api::Desktop ? GL_BACK : GL_FRONT);
    }
    const PackState pack(c);
    const auto width = static_cast<GLsizei>(w.config.width), height = static_cast<GLsizei>(w.config.height);
    gReal.glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, mine);
    const void* theirs = askPixels(t, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE);
    pack.restore();
    if (readBuffer) mural_glReadBuffer(static_cast<GLenum>(readBuffer));
    if (packBuffer) gReal.glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(packBuffer));
    if (framebuffer) mural_glBindFramebuffer(target, static_cast<GLuint>(framebuffer));
    return theirs;
}

// MURAL_VERIFY_DUMP=folder: both pictures of frames that differ, as PPM.
void dump(const Window& w, uint32_t frame, const char* which, const uint8_t* rgba) {
    const char* folder = getenv("MURAL_VERIFY_DUMP");
    if (!folder) return;
    char path[512];
    snprintf(path, sizeof path, "%s/frame-%06u-window-%u-%s.ppm", folder, frame, w.id, which);
    FILE* f = fopen(path, "wb");
    if (!f) return;
    fprintf(f, "P6\n%u %u\n255\n", w.config.width, w.config.height);
    for (uint32_t y = w.config.height; y-- > 0;) {
        for (uint32_t x = 0; x < w.config.width; ++x) fwrite(rgba + (size_t{y} * w.config.width + x) * 4, 1, 3, f);
    }
    fclose(f);
}

} // namespace

void verifyFrame(ThreadState& t, Window& w) {
    Session* s = Session::current();
    if (!t.context || t.context->drawWindow != w.id || w.config.width == 0) return;
    const size_t pixels = size_t{w.config.width} * w.config.height;
    auto* mine = static_cast<uint8_t*>(std::malloc(pixels * 4));
    if (!mine) return;
    stashError(*t.context, takeError(*t.context));
    const auto* theirs = static_cast<const uint8_t*>(readBoth(t, w, mine));
    takeError(*t.context);
    uint64_t differing = 0;
    uint32_t largest = 0;
    for (size_t i = 0; theirs && i < pixels; ++i) {
        uint32_t worst = 0;
        for (size_t k = 0; k < 4; ++k) {
            const int d = mine[4 * i + k] - theirs[4 * i + k];
            const auto size = static_cast<uint32_t>(d < 0 ? -d : d);
            worst = size > worst ? size : worst;
        }
        differing += worst > 0;
        largest = worst > largest ? worst : largest;
    }
    if (theirs) {
        auto* h = s->header();
        const uint64_t frame = h->verifiedFrames.fetch_add(1) + 1;
        h->verifiedPixels.fetch_add(pixels);
        h->differingPixels.fetch_add(differing);
        if (largest > h->largestDifference.load()) h->largestDifference.store(largest);
        if (differing) {
            dump(w, static_cast<uint32_t>(frame), "native", mine);
            dump(w, static_cast<uint32_t>(frame), "wall", theirs);
        }
    }
    std::free(mine);
}

} // namespace mural
