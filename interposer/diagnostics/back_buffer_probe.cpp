#include "interposer/diagnostics/back_buffer_probe.hpp"

#include <GL/gl.h>
#include <cstring>

#include "interposer/readback/back_buffer.hpp"
#include "interposer/context/context.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"
#include "interposer/context/window_size.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {

constexpr uint32_t kBands = 16, kSampledPixels = 65536;
// Limits readbacks for a program that alternates between contexts without swapping.
constexpr int kBindsPerFrame = 16;

std::atomic<uint64_t> drawingsBegun{0}, drawingsEnded{0};

bool isDue(uint32_t frame) { return (frame & (frame - 1)) == 0; }

bool canProbe(const ThreadState& t, const Window& w) {
    const Context* c = t.context;
    if (!c || !c->isMesa || swapLocally() || c->compilingList || c->renderMode != GL_RENDER) return false;
    return c->drawWindow == w.id && c->readWindow == w.id && w.config.doubleBuffer && !w.config.isPbuffer &&
           w.config.width > 0;
}

// Pixel scales, biases and maps would change the result.
bool plainTransfer(const Context& c) {
    if (c.api != wire::Api::Desktop || c.core) return true;
    GLint mapped = 0;
    gReal.glGetIntegerv(GL_MAP_COLOR, &mapped);
    bool plain = !mapped;
    for (const GLenum name : {GL_RED_SCALE, GL_GREEN_SCALE, GL_BLUE_SCALE, GL_ALPHA_SCALE}) {
        GLfloat scale = 1;
        gReal.glGetFloatv(name, &scale);
        plain = plain && scale == 1;
    }
    for (const GLenum name : {GL_RED_BIAS, GL_GREEN_BIAS, GL_BLUE_BIAS, GL_ALPHA_BIAS}) {
        GLfloat bias = 0;
        gReal.glGetFloatv(name, &bias);
        plain = plain && bias == 0;
    }
    return plain;
}

// Returns whether the pixel is inside the driver's buffer. A read outside leaves memory unchanged, which reveals the
// buffer's size.
bool isInside(const BackBufferRead& read, GLint x, GLint y) {
    uint32_t pixel = 0, again = ~0U;
    read.pixels(x, y, 1, 1, &pixel);
    read.pixels(x, y, 1, 1, &again);
    return pixel == again;
}

// A driver may resize its buffers long after the window.
bool hasSize(const BackBufferRead& read, GLint width, GLint height) {
    return isInside(read, width - 1, height - 1) && !isInside(read, width, height - 1) &&
           !isInside(read, width - 1, height);
}

uint64_t printOfRow(const uint32_t* pixels, uint32_t count) {
    uint64_t print = count;
    for (uint32_t i = 0; i < count; ++i) {
        print = (print ^ pixels[i]) * 0x9E3779B97F4A7C15;
        print ^= print >> 32;
    }
    return print;
}

// Samples evenly spaced bands of rows; every row of a small window. Uses a sum, because MESA_pack_invert reverses
// bands.
bool sample(ThreadState& t, const BackBufferRead& read, uint32_t width, uint32_t height, uint64_t& print) {
    const uint32_t maximum = kSampledPixels / kBands > width ? kSampledPixels / kBands / width : 1;
    auto* band = static_cast<uint32_t*>(scratchMemory(t, size_t{maximum} * width * 4));
    if (!band) return false;
    print = 0;
    for (uint32_t i = 0; i < kBands; ++i) {
        const uint32_t y = i * height / kBands, end = (i + 1) * height / kBands;
        const uint32_t rows = end - y < maximum ? end - y : maximum;
        if (rows == 0) continue;
        read.pixels(0, static_cast<GLint>(y), static_cast<GLsizei>(width), static_cast<GLsizei>(rows), band);
        for (uint32_t row = 0; row < rows; ++row) print += printOfRow(band + size_t{row} * width, width);
    }
    return true;
}

struct Sample {
    uint32_t width = 0, height = 0;
    uint64_t print = 0, drawings = 0;
};

// Returns false if the sample is not comparable.
bool takeSample(ThreadState& t, Window& w, Sample& seen) {
    if (!canProbe(t, w)) return false;
    seen.drawings = drawingsBegun.load();
    if (seen.drawings != drawingsEnded.load()) return false;
    // Draws of another context may still be in progress.
    if (seen.drawings > 0 && w.holders > 1) return false;
    if (!queryWindowSize(w, seen.width, seen.height) || seen.width != w.config.width || seen.height != w.config.height)
        return false;
    const BackBufferRead read(*t.context, w, BackBufferRead::Where::Here);
    if (!read.ready() || !plainTransfer(*t.context)) return false;
    if (!hasSize(read, static_cast<GLint>(seen.width), static_cast<GLint>(seen.height))) return false;
    return sample(t, read, seen.width, seen.height, seen.print) && seen.drawings == drawingsBegun.load();
}

void keep(BackBufferProbe& pixels, const Sample& seen) {
    pixels.width = seen.width;
    pixels.height = seen.height;
    pixels.print = seen.print;
    pixels.drawings = seen.drawings;
    pixels.known = true;
}

bool probeAtEndOfFrame(ThreadState& t, Window& w) {
    BackBufferProbe& before = w.pixels;
    const uint32_t frame = ++before.frames;
    before.binds = 0;
    const bool comparable = before.known && before.drawings == drawingsBegun.load();
    if (!isDue(frame) && (comparable || !isDue(frame + 1))) return false;
    Sample now;
    before.known = false;
    if (!takeSample(t, w, now)) return false;
    const bool changed = comparable && isDue(frame) && now.width == before.width && now.height == before.height &&
                         now.drawings == before.drawings && now.print != before.print;
    keep(before, now);
    return changed;
}

} // namespace

void backBufferBound(ThreadState& t, Window& w) {
    w.pixels.known = false;
    if (w.pixels.busy.exchange(true)) return;
    Sample now;
    if (isDue(w.pixels.frames + 1) && ++w.pixels.binds <= kBindsPerFrame && takeSample(t, w, now)) keep(w.pixels, now);
    w.pixels.busy = false;
}

bool backBufferChanged(ThreadState& t, Window& w) {
    if (w.pixels.busy.exchange(true)) return false;
    const bool changed = probeAtEndOfFrame(t, w);
    w.pixels.busy = false;
    return changed;
}

void ownDrawingBegins() { drawingsBegun.fetch_add(1); }
void ownDrawingEnds() { drawingsEnded.fetch_add(1); }

} // namespace mural
