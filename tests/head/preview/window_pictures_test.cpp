// The wall's picture from previews of the nodes' windows.
#include "nodes/head/preview/window_pictures.hpp"

#include <gtest/gtest.h>
#include <optional>
#include <vector>

#include "nodes/output/jpeg_picture.hpp"

namespace mural {
namespace {

class WindowPicturesTest : public ::testing::Test {
protected:
    // The reply of one of two nodes that show the halves of a wall of 40x20 pixels, reduced to 20x10.
    static wire::PreviewTileHeader half(int node, uint32_t number, uint32_t frame, uint32_t client = 1) {
        wire::PreviewTileHeader header{};
        header.number = number;
        header.client = client;
        header.frame = frame;
        header.wallWidth = 40;
        header.wallHeight = 20;
        header.pictureWidth = 20;
        header.pictureHeight = 10;
        header.x = 10 * node;
        header.w = header.h = 10;
        header.tiles = 1;
        return header;
    }
    static std::vector<std::byte> grey(int value, int side = 10) {
        OwnedPicture picture(side, side);
        std::fill_n(picture.data(), picture.view().sizeBytes(), static_cast<std::byte>(value));
        return jpegOf(picture.view(), 95);
    }
    [[nodiscard]] int greyAt(int x) const { return static_cast<int>(latest_->picture->view().row(5)[4 * x]); }

    std::optional<WindowPictures::Composed> latest_;
    int composed_ = 0;
    WindowPictures pictures_{[this](const WindowPictures::Composed& composed) {
        latest_ = composed;
        ++composed_;
    }};
    const wire::WantPreviewCommand request_ = pictures_.begin(40, 20);
};

TEST_F(WindowPicturesTest, composesWhenAllNodesHaveReplied) {
    EXPECT_EQ(request_.number, 1u);
    ASSERT_TRUE(pictures_.add(0, half(0, 1, 5), grey(40)).ok());
    ASSERT_TRUE(pictures_.add(1, half(1, 1, 5), grey(200)).ok());
    ASSERT_TRUE(pictures_.add(0, half(0, 2, 6), grey(80)).ok());
    const int before = composed_;
    ASSERT_TRUE(pictures_.add(1, half(1, 2, 6), grey(220)).ok());
    EXPECT_EQ(composed_, before + 1) << "the first reply waits for the second one";
    EXPECT_NEAR(greyAt(2), 80, 4);
    EXPECT_NEAR(greyAt(15), 220, 4);
    EXPECT_EQ(latest_->wallWidth, 40);
}

TEST_F(WindowPicturesTest, keepsThePictureOfAnUnchangedTile) {
    ASSERT_TRUE(pictures_.add(0, half(0, 1, 5), grey(40)).ok());
    ASSERT_TRUE(pictures_.add(1, half(1, 1, 5), grey(200)).ok());
    ASSERT_TRUE(pictures_.add(0, half(0, 2, 5), {}).ok());
    const int before = composed_;
    ASSERT_TRUE(pictures_.add(1, half(1, 2, 5), {}).ok());
    EXPECT_EQ(composed_, before) << "the same frame";
    ASSERT_TRUE(pictures_.add(0, half(0, 3, 6), {}).ok());
    ASSERT_TRUE(pictures_.add(1, half(1, 3, 6), grey(100)).ok());
    EXPECT_NEAR(greyAt(2), 40, 4);
    EXPECT_NEAR(greyAt(15), 100, 4);
}

TEST_F(WindowPicturesTest, waitsForASilentNodeOnceOnly) {
    ASSERT_TRUE(pictures_.add(0, half(0, 1, 5), grey(40)).ok());
    ASSERT_TRUE(pictures_.add(1, half(1, 1, 5), grey(200)).ok());
    const int before = composed_;
    ASSERT_TRUE(pictures_.add(0, half(0, 2, 6), grey(60)).ok());
    EXPECT_EQ(composed_, before);
    ASSERT_TRUE(pictures_.add(0, half(0, 3, 7), grey(80)).ok());
    EXPECT_EQ(composed_, before + 1);
    EXPECT_NEAR(greyAt(15), 200, 4) << "its last picture";
}

TEST_F(WindowPicturesTest, increasesFramesOfTheWallWithAFurtherProgram) {
    ASSERT_TRUE(pictures_.add(0, half(0, 1, 900), grey(40)).ok());
    const int64_t frame = latest_->frame;
    ASSERT_TRUE(pictures_.add(0, half(0, 2, 1, 2), grey(50)).ok());
    EXPECT_EQ(latest_->frame, frame + 1);
    ASSERT_TRUE(pictures_.add(0, half(0, 3, 4, 2), grey(50)).ok());
    EXPECT_EQ(latest_->frame, frame + 4);
}

TEST_F(WindowPicturesTest, refusesInvalidReplies) {
    auto beyond = half(1, 1, 1);
    beyond.x = 11;
    EXPECT_FALSE(pictures_.add(0, beyond, grey(1)).ok());
    auto huge = half(0, 1, 1);
    huge.pictureWidth = wire::kMaxPreviewSide + 1;
    EXPECT_FALSE(pictures_.add(0, huge, grey(1)).ok());
    auto larger = half(0, 1, 1);
    larger.pictureWidth = 41;
    EXPECT_FALSE(pictures_.add(0, larger, grey(1)).ok()) << "larger than requested";
    auto many = half(0, 1, 1);
    many.tiles = wire::kMaxPreviewTiles + 1;
    EXPECT_FALSE(pictures_.add(0, many, grey(1)).ok());
    auto none = half(0, 1, 1);
    none.tiles = 0;
    EXPECT_FALSE(pictures_.add(0, none, grey(1)).ok());
    EXPECT_FALSE(pictures_.add(0, half(0, 1, 1), grey(1, 9)).ok()) << "another size";
    const std::vector<std::byte> noise(100, std::byte{7});
    EXPECT_FALSE(pictures_.add(0, half(0, 1, 1), noise).ok());
    EXPECT_EQ(composed_, 0);
}

} // namespace
} // namespace mural
