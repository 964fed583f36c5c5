// The place and size of a node's picture on the wall.
#include "nodes/head/frames/picture_place.hpp"
#include "streamcodec/wire/node_messages.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

wire::PictureHeader headerOf(int x, int y, int w, int h) {
    wire::PictureHeader header{};
    header.x = x, header.y = y, header.w = w, header.h = h;
    header.windowWidth = 100, header.windowHeight = 80;
    return header;
}

ByteBuffer rowsOf(size_t pixels, std::byte value) {
    ByteBuffer rows = ByteBuffer::ofSize(pixels * 4);
    std::fill(rows.span().begin(), rows.span().end(), value);
    return rows;
}

TEST(PicturePlace, keepsThePictureByDefault) {
    auto placed = placeOnWall({}, headerOf(3, 4, 10, 5), rowsOf(50, std::byte{7}));
    ASSERT_TRUE(placed);
    EXPECT_EQ(placed->header.x, 3);
    EXPECT_EQ(placed->rows.size(), 200u);
}

TEST(PicturePlace, restoresTheDrawnSize) {
    NodePlan node;
    node.transferScale = {.5, .5};
    auto placed = placeOnWall(node, headerOf(50, 0, 51, 40), rowsOf(26 * 20, std::byte{9}));
    ASSERT_FALSE(placed.ok() && placed->header.w != 51) << "its place is that of the header";
    ASSERT_TRUE(placed);
    EXPECT_EQ(placed->rows.size(), 51u * 40 * 4);
    for (const std::byte b : placed->rows.span()) EXPECT_EQ(b, std::byte{9});
}

TEST(PicturePlace, movesThePicture) {
    NodePlan node;
    node.shown = Viewport{.25, .5, .25, .25};
    auto placed = placeOnWall(node, headerOf(0, 0, 100, 80), rowsOf(8000, std::byte{1}));
    ASSERT_TRUE(placed);
    EXPECT_EQ(placed->header.x, 25);
    EXPECT_EQ(placed->header.y, 40);
    EXPECT_EQ(placed->header.w, 25);
    EXPECT_EQ(placed->header.h, 20);
    EXPECT_EQ(placed->rows.size(), 25u * 20 * 4);
}

TEST(PicturePlace, rejectsImpossibleSizes) {
    NodePlan node;
    node.transferScale = {.5, .5};
    EXPECT_FALSE(placeOnWall(node, headerOf(0, 0, 40, 40), rowsOf(1600, std::byte{1})))
        << "it came as large as it was drawn";
    EXPECT_FALSE(placeOnWall(node, headerOf(0, 0, 1'000'000, 40), rowsOf(500'000 * 20, std::byte{1})));
    EXPECT_FALSE(placeOnWall(node, headerOf(0, 0, -4, 40), {}));
}

} // namespace
} // namespace mural
