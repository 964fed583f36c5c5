// The choice of the readback method, with simulated times.
#include "nodes/player/readback_choice.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

struct Times {
    int64_t atOnceNs, laterNs;
};

// The number of buffered readbacks among `frames`, after the first `skipped`.
int laterOf(ReadbackChoice& choice, int skipped, int frames, Times times) {
    int later = 0;
    for (int i = 0; i < skipped + frames; ++i) {
        later += i >= skipped && choice.later() ? 1 : 0;
        choice.took(choice.later() ? times.laterNs : times.atOnceNs);
    }
    return later;
}

TEST(ReadbackChoice, isDirectForSoftwareRendering) {
    EXPECT_EQ(readbackBy("llvmpipe (LLVM 15.0.6, 256 bits), egl", Readback::Auto), Readback::Direct);
    EXPECT_EQ(readbackBy("softpipe, egl", Readback::Auto), Readback::Direct);
    // an explicit request has precedence
    EXPECT_EQ(readbackBy("llvmpipe (LLVM 15.0.6, 256 bits), egl", Readback::Buffer), Readback::Buffer);
    EXPECT_EQ(readbackBy("Mesa Intel(R) UHD Graphics 620, egl", Readback::Auto), Readback::Auto);
    EXPECT_EQ(readbackBy("", Readback::Auto), Readback::Auto);
}

TEST(ReadbackChoice, minimisesTheDrawingThreadsTime) {
    ReadbackChoice card, processor, close;
    EXPECT_EQ(laterOf(card, 14, 1000, {4'000'000, 100'000}), 1000);
    EXPECT_EQ(laterOf(processor, 14, 1000, {4'000'000, 4'100'000}), 0);
    EXPECT_EQ(laterOf(close, 14, 1000, {4'000'000, 3'100'000}), 0); // similar times: the simpler way
}

TEST(ReadbackChoice, ignoresFirstFramesAndOutliers) {
    ReadbackChoice choice;
    for (int i = 0; i < 4; ++i) choice.took(choice.later() ? 1 : 900'000'000);
    for (int i = 0; i < 10; ++i)
        choice.took(choice.later() ? (i < 2 ? 1 : 5'000'000) : (i < 2 ? 800'000'000 : 5'000'000));
    EXPECT_EQ(laterOf(choice, 0, 500, {5'000'000, 5'000'000}), 0);
}

TEST(ReadbackChoice, measuresAgain) {
    ReadbackChoice choice;
    EXPECT_EQ(laterOf(choice, 14, 10, {4'000'000, 4'000'000}), 0);
    EXPECT_EQ(laterOf(choice, 2000, 1000, {4'000'000, 10'000}), 1000);
}

} // namespace
} // namespace mural
