// Pictures of several passes (samples, kernels, eyes) become one picture.
#include "nodes/head/frames/wall_composition.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "nodes/output/eye_pair.hpp"

namespace mural {
namespace {

using Bytes = std::vector<int>;

OwnedPicture noise(int width, int height, unsigned seed) {
    OwnedPicture p(width, height);
    std::mt19937 numbers(seed);
    for (size_t i = 0; i < p.view().sizeBytes(); ++i) p.data()[i] = static_cast<std::byte>(numbers() & 255);
    return p;
}
int channel(const OwnedPicture& p, int x, int y, int c) { return std::to_integer<int>(p.view().row(y)[x * 4 + c]); }

OwnedPicture composed(const PassCounts& counts, const std::vector<OwnedPicture>& passes) {
    std::vector<Picture> views;
    for (const OwnedPicture& p : passes) views.push_back(p.view());
    OwnedPicture into;
    composePasses(counts, views, into);
    return into;
}

TEST(PassComposition, roundsMeansOnce) {
    for (const int n : {2, 3, 4, 7, 16, 255}) {
        PassCounts counts;
        counts.samples = n;
        std::vector<OwnedPicture> passes;
        for (int i = 0; i < n; ++i) passes.push_back(noise(13, 5, static_cast<unsigned>(i)));
        const OwnedPicture out = composed(counts, passes);
        ASSERT_EQ(out.width(), 13);
        for (size_t i = 0; i < out.view().sizeBytes(); ++i) {
            double sum = 0;
            for (const OwnedPicture& p : passes) sum += std::to_integer<int>(p.view().bgra[i]);
            EXPECT_EQ(std::to_integer<int>(out.view().bgra[i]), static_cast<int>(std::floor(sum / n + 0.5)))
                << n << " samples, byte " << i;
        }
    }
}

TEST(PassComposition, averagesManyPicturesWithoutDrift) {
    PassCounts counts;
    counts.samples = 256;
    OwnedPicture white(3, 2);
    for (size_t i = 0; i < white.view().sizeBytes(); ++i) white.data()[i] = std::byte{255};
    const OwnedPicture out = composed(counts, std::vector<OwnedPicture>(256, white));
    EXPECT_TRUE(comparePictures(white.view(), out.view()).same());
}

// A picture divided into kernels is restored, whatever its size.
TEST(PassComposition, interleavesKernels) {
    for (const auto& [columns, rows] :
         {std::pair(2, 1), std::pair(3, 1), std::pair(1, 4), std::pair(3, 2), std::pair(2, 2)}) {
        for (const auto& [width, height] : {std::pair(12, 8), std::pair(11, 7), std::pair(13, 9), std::pair(4, 5)}) {
            PassCounts counts;
            counts.kernelWidth = columns;
            counts.kernelHeight = rows;
            const OwnedPicture whole = noise(width, height, 5);
            std::vector<OwnedPicture> passes;
            for (int ky = 0; ky < rows; ++ky)
                for (int kx = 0; kx < columns; ++kx) {
                    OwnedPicture part((width - kx + columns - 1) / columns, (height - ky + rows - 1) / rows);
                    for (int y = 0; y < part.height(); ++y)
                        for (int x = 0; x < part.width(); ++x)
                            for (int c = 0; c < 4; ++c)
                                part.row(y)[x * 4 + c] =
                                    static_cast<std::byte>(channel(whole, x * columns + kx, y * rows + ky, c));
                    passes.push_back(std::move(part));
                }
            const OwnedPicture out = composed(counts, passes);
            EXPECT_TRUE(comparePictures(whole.view(), out.view()).same())
                << columns << "x" << rows << " of " << width << "x" << height;
        }
    }
}

TEST(PassComposition, takesRedFromTheLeftEye) {
    const std::vector<OwnedPicture> eyes{noise(5, 3, 1), noise(5, 3, 2)};
    const OwnedPicture out = composed({.stereo = StereoMode::Anaglyph}, eyes);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 5; ++x) {
            EXPECT_EQ(channel(out, x, y, 2), channel(eyes[0], x, y, 2));
            EXPECT_EQ(channel(out, x, y, 1), channel(eyes[1], x, y, 1));
            EXPECT_EQ(channel(out, x, y, 0), channel(eyes[1], x, y, 0));
        }
}

// Green and magenta; a channel in both masks, and one in neither.
TEST(PassComposition, takesTheColoursOfEachEye) {
    const std::vector<OwnedPicture> eyes{noise(9, 3, 1), noise(9, 3, 2)};
    WallComposition wall = compositionOf({.stereo = StereoMode::Anaglyph});
    const auto with = [&](EyeColours left, EyeColours right) {
        wall.parts[0].colours = left;
        wall.parts[1].colours = right;
        OwnedPicture out;
        composeWall(wall, {eyes[0].view(), eyes[1].view()}, out);
        return out;
    };
    const OwnedPicture magenta = with({false, true, false}, {true, false, true}),
                       overlapping = with({true, true, false}, {false, true, false});
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 9; ++x) {
            EXPECT_EQ(channel(magenta, x, y, 2), channel(eyes[1], x, y, 2));
            EXPECT_EQ(channel(magenta, x, y, 1), channel(eyes[0], x, y, 1));
            EXPECT_EQ(channel(magenta, x, y, 0), channel(eyes[1], x, y, 0));
            EXPECT_EQ(channel(overlapping, x, y, 2), channel(eyes[0], x, y, 2));
            EXPECT_EQ(channel(overlapping, x, y, 1), channel(eyes[1], x, y, 1)) << "the right one is the later";
            EXPECT_EQ(channel(overlapping, x, y, 0), 0);
        }
}

int mean(int a, int b) { return (a + b + 1) / 2; }

TEST(PassComposition, halvesTheWidthSideBySide) {
    for (const int width : {6, 7}) {
        const std::vector<OwnedPicture> eyes{noise(width, 2, 1), noise(width, 2, 2)};
        const OwnedPicture out = composed({.stereo = StereoMode::SideBySide}, eyes);
        ASSERT_EQ(out.width(), width);
        ASSERT_EQ(out.height(), 2);
        const int half = (width + 1) / 2;
        for (int x = 0; x < half; ++x)
            EXPECT_EQ(channel(out, x, 1, 0),
                      mean(channel(eyes[0], 2 * x, 1, 0), channel(eyes[0], std::min(2 * x + 1, width - 1), 1, 0)));
        for (int x = 0; x < width - half; ++x)
            EXPECT_EQ(channel(out, half + x, 0, 1),
                      mean(channel(eyes[1], 2 * x, 0, 1), channel(eyes[1], std::min(2 * x + 1, width - 1), 0, 1)));
    }
}

TEST(PassComposition, putsTheLeftEyeOnTop) {
    for (const int height : {6, 7}) {
        const std::vector<OwnedPicture> eyes{noise(3, height, 1), noise(3, height, 2)};
        const OwnedPicture out = composed({.stereo = StereoMode::TopBottom}, eyes);
        ASSERT_EQ(out.height(), height);
        const int below = height - (height + 1) / 2; // rows of the right eye: row 0 is the lowest
        for (int y = 0; y < below; ++y)
            EXPECT_EQ(channel(out, 2, y, 0), mean(channel(eyes[1], 2, 2 * y, 0), channel(eyes[1], 2, 2 * y + 1, 0)));
        for (int y = below; y < height; ++y)
            EXPECT_EQ(channel(out, 1, y, 2), mean(channel(eyes[0], 1, 2 * (y - below), 2),
                                                  channel(eyes[0], 1, std::min(2 * (y - below) + 1, height - 1), 2)));
    }
}

TEST(PassComposition, keepsBothEyesCompleteForQuadBuffers) {
    const std::vector<OwnedPicture> eyes{noise(7, 5, 1), noise(7, 5, 2)};
    const OwnedPicture out = composed({.stereo = StereoMode::Quad}, eyes);
    ASSERT_EQ(out.width(), 7);
    ASSERT_EQ(out.height(), 10);
    const EyePair both = eyesOfStack(out.view());
    EXPECT_TRUE(comparePictures(eyes[0].view(), both.left).same());
    EXPECT_TRUE(comparePictures(eyes[1].view(), both.right).same());
    EXPECT_FALSE(comparePictures(eyes[0].view(), both.right).same());
    // One eye's node is lost, or its window had another size: still a pair.
    const OwnedPicture smaller = composed({.stereo = StereoMode::Quad}, {noise(7, 5, 1), noise(3, 2, 2)});
    EXPECT_EQ(smaller.height(), 10);
    EXPECT_TRUE(comparePictures(eyes[0].view(), eyesOfStack(smaller.view()).left).same());
}

TEST(PassComposition, combinesSamplesThenKernelsThenEyes) {
    PassCounts counts{.stereo = StereoMode::Anaglyph, .kernelWidth = 2, .samples = 2};
    std::vector<OwnedPicture> passes;
    for (int i = 0; i < 8; ++i) { // red of left: samples 0,1 | 2,3; green of right: 4,5 | 6,7
        passes.emplace_back(1, 1);
        for (int c = 0; c < 4; ++c) passes.back().data()[c] = static_cast<std::byte>(10 * i);
    }
    const OwnedPicture out = composed(counts, passes);
    ASSERT_EQ(out.width(), 2);
    EXPECT_EQ(channel(out, 0, 0, 2), 5);
    EXPECT_EQ(channel(out, 1, 0, 2), 25);
    EXPECT_EQ(channel(out, 0, 0, 1), 45);
    EXPECT_EQ(channel(out, 1, 0, 1), 65);
}

// A lost node's picture may have the size of an earlier window.
TEST(PassComposition, cropsOrFillsPicturesOfOtherSizes) {
    for (const PassCounts& counts :
         {PassCounts{.stereo = StereoMode::SideBySide}, PassCounts{.stereo = StereoMode::TopBottom},
          PassCounts{.stereo = StereoMode::Anaglyph}, PassCounts{.kernelWidth = 2}, PassCounts{.kernelHeight = 2},
          PassCounts{.samples = 2}}) {
        const OwnedPicture out = composed(counts, {noise(64, 48, 1), noise(3, 2, 2)});
        EXPECT_GE(out.width(), 64);
        EXPECT_GE(out.height(), 48);
        EXPECT_FALSE(composed(counts, {noise(3, 2, 1), noise(64, 48, 2)}).view().empty());
    }
}

TEST(PassComposition, returnsAnEmptyPictureForEmptyOrMissingInputs) {
    EXPECT_TRUE(composed({.samples = 2}, {noise(2, 2, 1), OwnedPicture()}).view().empty());
    EXPECT_TRUE(composed({.samples = 3}, {noise(2, 2, 1), noise(2, 2, 1)}).view().empty());
}

} // namespace
} // namespace mural
