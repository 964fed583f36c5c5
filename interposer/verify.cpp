#include "interposer/verify.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "interposer/asking.hpp"
#include "interposer/back_buffer.hpp"
#include "interposer/context.hpp"
#include "interposer/log.hpp"
#include "interposer/session.hpp"
#include "interposer/window_colours.hpp"

namespace mural {

namespace {

// Reads the window's back buffer into `mine` by the local driver and, through askPixels, from the nodes.
const void* readBoth(ThreadState& t, Window& w, void* mine, GLenum type) {
    const BackBufferRead read(*t.context, w, BackBufferRead::Where::NodesToo);
    if (!read.ready()) return nullptr;
    const auto width = static_cast<GLsizei>(w.config.width), height = static_cast<GLsizei>(w.config.height);
    read.pixels(0, 0, width, height, mine, type);
    return askPixels(t, 0, 0, width, height, GL_RGBA, type, 0, "--verify");
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
    const ColourReads reads = colourReadsOf(*t.context, w);
    if (w.config.red > 8 && reads.type == GL_UNSIGNED_BYTE)
        MURAL_SAY_ONCE("a window has %d bits per channel; --verify compares 8 of them, as OpenGL ES before 3 reads no more", w.config.red);
    auto* mine = static_cast<uint8_t*>(std::malloc(pixels * reads.pixelBytes));
    if (!mine) return;
    auto* theirs = const_cast<void*>(readBoth(t, w, mine, reads.type)); // in memory of this thread
    if (theirs) {
        const ColourDifference difference = compareColours(mine, theirs, pixels, reads.type);
        auto* h = s->header();
        const uint64_t frame = h->verifiedFrames.fetch_add(1) + 1;
        h->verifiedPixels.fetch_add(pixels);
        h->differingPixels.fetch_add(difference.differingPixels);
        h->squaredDifference.fetch_add(difference.squared);
        if (difference.largest > h->largestDifference.load()) h->largestDifference.store(difference.largest);
        if (difference.differingPixels) {
            reduceToBytes(mine, pixels, reads.type);
            reduceToBytes(theirs, pixels, reads.type);
            dump(w, static_cast<uint32_t>(frame), "native", mine);
            dump(w, static_cast<uint32_t>(frame), "wall", static_cast<const uint8_t*>(theirs));
        }
    }
    std::free(mine);
}

} // namespace mural
