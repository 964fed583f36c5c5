#include "interposer/verify.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "interposer/asking.hpp"
#include "interposer/back_buffer.hpp"
#include "interposer/context.hpp"
#include "interposer/session.hpp"

namespace mural {

namespace {

// Reads the window's back buffer into `mine` by the local driver and, through askPixels, from the nodes.
const void* readBoth(ThreadState& t, Window& w, void* mine) {
    const BackBufferRead read(*t.context, w, BackBufferRead::Where::NodesToo);
    if (!read.ready()) return nullptr;
    const auto width = static_cast<GLsizei>(w.config.width), height = static_cast<GLsizei>(w.config.height);
    read.pixels(0, 0, width, height, mine);
    return askPixels(t, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, 0, "--verify");
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
    const auto* theirs = static_cast<const uint8_t*>(readBoth(t, w, mine));
    uint64_t differing = 0, squared = 0;
    uint32_t largest = 0;
    for (size_t i = 0; theirs && i < pixels; ++i) {
        uint32_t worst = 0;
        for (size_t k = 0; k < 4; ++k) {
            const int d = mine[4 * i + k] - theirs[4 * i + k];
            const auto size = static_cast<uint32_t>(d < 0 ? -d : d);
            worst = size > worst ? size : worst;
            squared += uint64_t{size} * size;
        }
        differing += worst > 0;
        largest = worst > largest ? worst : largest;
    }
    if (theirs) {
        auto* h = s->header();
        const uint64_t frame = h->verifiedFrames.fetch_add(1) + 1;
        h->verifiedPixels.fetch_add(pixels);
        h->differingPixels.fetch_add(differing);
        h->squaredDifference.fetch_add(squared);
        if (largest > h->largestDifference.load()) h->largestDifference.store(largest);
        if (differing) {
            dump(w, static_cast<uint32_t>(frame), "native", mine);
            dump(w, static_cast<uint32_t>(frame), "wall", theirs);
        }
    }
    std::free(mine);
}

} // namespace mural
