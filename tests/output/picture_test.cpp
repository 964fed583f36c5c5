// Copies, conversions and comparisons of pictures.
#include "nodes/output/picture.hpp"

#include <cstring>

#include "tests/output/test_pictures.hpp"

namespace mural::test {

TEST(Picture, copiesOnlyPixelsInsideTheTarget) {
    const OwnedPicture whole = noisePicture(37, 23, 1);
    OwnedPicture built = plainPicture(37, 23, 0, 0, 0);
    // Four overlapping parts, each extending beyond the target on two sides.
    for (const PixelViewport part : {PixelViewport{-3, -5, 25, 20}, PixelViewport{20, -2, 30, 20},
                                     PixelViewport{-1, 11, 25, 30}, PixelViewport{19, 13, 18, 10}}) {
        const OwnedPicture piece = cutOut(whole.view(), part);
        copyInto(built, part.x, part.y, piece.view());
    }
    // The parts are black outside the picture, which must not have been copied.
    EXPECT_TRUE(samePictures(whole.view(), built.view()));
}

TEST(Picture, ignoresEmptyAndFarPicturesInCopies) {
    const OwnedPicture before = noisePicture(8, 8, 2);
    OwnedPicture target(before.view());
    copyInto(target, 0, 0, Picture{});
    copyInto(target, 8, 0, before.view());
    copyInto(target, 0, -8, before.view());
    EXPECT_TRUE(samePictures(before.view(), target.view()));
}

TEST(Picture, restoresEightBitsFromTen) {
    for (uint32_t value = 0; value < 256; ++value) {
        const uint32_t pixel = 0x55000000U | value << 16 | (255 - value) << 8 | value;
        OwnedPicture source(1, 1), back(1, 1);
        std::memcpy(source.data(), &pixel, 4);
        OwnedPicture deep;
        deep.resize(1, 1, PictureFormat::Bgr10A2);
        copyInto(deep, 0, 0, source.view());
        copyInto(back, 0, 0, deep.view());
        EXPECT_EQ(std::memcmp(back.data(), source.data(), 4), 0) << value;
    }
}

TEST(Picture, keepsTheFormatInCutsAndCopies) {
    OwnedPicture deep;
    deep.resize(3, 2, PictureFormat::Bgr10A2);
    EXPECT_EQ(cutOut(deep.view(), {1, 0, 2, 2}).format(), PictureFormat::Bgr10A2);
    EXPECT_EQ(OwnedPicture(deep.view()).format(), PictureFormat::Bgr10A2);
}

TEST(Picture, flipsRows) {
    for (const int height : {1, 2, 5}) {
        const OwnedPicture before = noisePicture(3, height, 3);
        OwnedPicture flipped(before.view());
        flipRows(flipped);
        for (int y = 0; y < height; ++y)
            EXPECT_TRUE(samePictures(Picture{3, 1, before.view().row(y)}, Picture{3, 1, flipped.row(height - 1 - y)}));
    }
}

TEST(ComparePictures, countsDifferencesAndFindsTheFirst) {
    const OwnedPicture expected = plainPicture(10, 6, 100, 100, 100);
    OwnedPicture actual(expected.view());
    setPixel(actual, 7, 2, 100, 103, 100);
    setPixel(actual, 1, 4, 93, 100, 101);
    const PictureDifference difference = comparePictures(expected.view(), actual.view());
    EXPECT_FALSE(difference.same());
    EXPECT_EQ(difference.differingPixels, 2);
    EXPECT_EQ(difference.largestDifference, 7);
    EXPECT_EQ(difference.firstX, 7);
    EXPECT_EQ(difference.firstY, 2);
    EXPECT_EQ(describe(difference, expected.view(), actual.view()),
              "2 of 60 pixels differ, by at most 7, first at x 7, y 2");
}

TEST(ComparePictures, ignoresAlpha) {
    const OwnedPicture expected = plainPicture(5, 5, 1, 2, 3);
    OwnedPicture actual(expected.view());
    actual.row(3)[3] = std::byte{77};
    EXPECT_TRUE(comparePictures(expected.view(), actual.view()).same());
}

TEST(ComparePictures, reportsDifferentSizes) {
    const OwnedPicture a = plainPicture(5, 5, 0, 0, 0);
    const OwnedPicture b = plainPicture(5, 4, 0, 0, 0);
    const PictureDifference difference = comparePictures(a.view(), b.view());
    EXPECT_TRUE(difference.sizesDiffer);
    EXPECT_FALSE(difference.same());
    EXPECT_EQ(describe(difference, a.view(), b.view()), "sizes differ: 5x5 expected, 5x4 found");
}

} // namespace mural::test
