#include "interposer/diagnostics/verify.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "interposer/readback/node_requests.hpp"
#include "interposer/readback/back_buffer.hpp"
#include "interposer/context/context.hpp"
#include "interposer/diagnostics/log.hpp"
#include "interposer/encode/session.hpp"
#include "interposer/readback/window_binding.hpp"
#include "interposer/readback/window_colours.hpp"
#include "interposer/context/window_size.hpp"

namespace mural {

namespace {

// MURAL_VERIFY_DUMP=folder: writes both pictures of differing frames as PPM.
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

// Precondition: the window is current; `ownPixels` has room for its pixels.
void compare(ThreadState& t, Window& w, uint8_t* ownPixels, size_t pixels, const ColourReads& reads) {
    using capture::Uncompared;
    const BackBufferRead read(*t.context, w, BackBufferRead::Where::NodesToo);
    if (!read.ready()) return countUncompared(Uncompared::NotReadable);
    const auto width = static_cast<GLsizei>(w.config.width), height = static_cast<GLsizei>(w.config.height);
    read.pixels(0, 0, 1, 1, ownPixels, reads.type); // Mesa adopts a new buffer size only after it has clipped a read
    read.pixels(0, 0, width, height, ownPixels, reads.type);
    if (driverError() != GL_NO_ERROR) return countUncompared(Uncompared::NotReadable);
    const GLenum errorBefore = t.context->stashedError;
    // points to memory of this thread
    auto* nodePixels = const_cast<void*>(requestPixels(t, 0, 0, width, height, GL_RGBA, reads.type, 0, "--verify"));
    t.context->stashedError = errorBefore; // a lost reply is not an error of the program
    if (!nodePixels) return countUncompared(Uncompared::NoAnswer);
    const ColourDifference difference = compareColours(ownPixels, nodePixels, pixels, reads.type);
    auto* h = Session::current()->header();
    const uint64_t frame = h->verifiedFrames.fetch_add(1) + 1;
    h->verifiedPixels.fetch_add(pixels);
    h->differingPixels.fetch_add(difference.differingPixels);
    h->squaredDifference.fetch_add(difference.squared);
    if (difference.largest > h->largestDifference.load()) h->largestDifference.store(difference.largest);
    if (difference.differingPixels == 0) return;
    reduceToBytes(ownPixels, pixels, reads.type);
    reduceToBytes(nodePixels, pixels, reads.type);
    dump(w, static_cast<uint32_t>(frame), "native", ownPixels);
    dump(w, static_cast<uint32_t>(frame), "wall", static_cast<const uint8_t*>(nodePixels));
}

// Returns whether a read would resize the driver's buffers. The new buffers are empty, and the swap would show them.
bool wouldChangeSize(const Window& w) {
    uint32_t width = 0, height = 0;
    if (!queryWindowSize(w, width, height)) return true;
    return !w.sizeKnown && (width != w.config.width || height != w.config.height);
}

} // namespace

void countUncompared(capture::Uncompared reason) {
    if (Session* s = Session::current()) s->header()->uncomparedFrames[static_cast<uint32_t>(reason)].fetch_add(1);
}

void verifyFrame(ThreadState& t, Window& w) {
    using capture::Uncompared;
    if (!t.context) return countUncompared(Uncompared::NoContext);
    if (w.config.width == 0 || w.config.height == 0 || wouldChangeSize(w)) return countUncompared(Uncompared::NoSize);
    const size_t pixels = size_t{w.config.width} * w.config.height;
    const ColourReads reads = colourReadsOf(*t.context, w);
    if (w.config.red > 8 && reads.type == GL_UNSIGNED_BYTE)
        MURAL_SAY_ONCE(
            "a window has %d bits per channel; --verify compares 8 of them, because OpenGL ES before 3 reads no more",
            w.config.red);
    auto* ownPixels = static_cast<uint8_t*>(std::calloc(pixels, reads.pixelBytes));
    if (!ownPixels) return countUncompared(Uncompared::NoMemory);
    const WindowBinding binding(t, w);
    if (binding.ready())
        compare(t, w, ownPixels, pixels, reads);
    else
        countUncompared(Uncompared::NotBindable);
    std::free(ownPixels);
}

} // namespace mural
