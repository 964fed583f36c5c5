// Pictures of several passes: which parts belong together, and the effect of lost nodes on a pass.
#include "nodes/head/frames/picture_assembler.hpp"
#include "streamcodec/wire/node_messages.hpp"

#include <cstring>
#include <gtest/gtest.h>

namespace mural {
namespace {

using Pixels = std::vector<uint32_t>;

// Two passes, each drawn by two nodes: the left and the right half of a line of pixels. Composition concatenates them.
class PicturePassesTest : public testing::Test {
protected:
    std::vector<WindowPicture> pictures;
    std::vector<std::vector<int>> sizes; // widths of the composed passes
    PictureAssembler assembler{{0, 0, 1, 1},
                               [this](const std::vector<Picture>& passes, OwnedPicture& into) {
                                   int width = 0;
                                   sizes.emplace_back();
                                   for (const Picture& p : passes) width += p.width, sizes.back().push_back(p.width);
                                   into.resize(width, 1);
                                   int x = 0;
                                   for (const Picture& p : passes) {
                                       copyInto(into, x, 0, p);
                                       x += p.width;
                                   }
                               },
                               [this](WindowPicture picture) { pictures.push_back(std::move(picture)); }};

    void part(int node, uint32_t frame, uint32_t pixel, uint32_t half = 1) {
        const auto w = static_cast<int32_t>(half);
        const wire::PictureHeader header{1, 1, frame, node % 2 * w, 0, w, 1, 2 * half, 1, 0, 0, 0};
        ByteBuffer rows = ByteBuffer::ofSize(size_t{4} * half);
        for (uint32_t i = 0; i < half; ++i) std::memcpy(rows.data() + size_t{4} * i, &pixel, 4);
        EXPECT_TRUE(assembler.part(node, header, std::move(rows)).ok());
    }
    void frame(uint32_t number, uint32_t pixel) {
        for (int node = 0; node < 4; ++node) part(node, number, pixel + static_cast<uint32_t>(node));
    }
    Pixels pixels(size_t index) const {
        const Picture view = pictures[index].picture->view();
        Pixels values(static_cast<size_t>(view.width));
        std::memcpy(values.data(), view.bgra, view.sizeBytes());
        return values;
    }
};

TEST_F(PicturePassesTest, composesPartsOfAllPasses) {
    part(3, 1, 13);
    part(0, 1, 10);
    part(1, 1, 11);
    EXPECT_TRUE(pictures.empty());
    part(2, 1, 12);
    ASSERT_EQ(pictures.size(), 1u);
    EXPECT_EQ(pixels(0), (Pixels{10, 11, 12, 13}));
}

// A canvas beside the first, half as wide. Its picture arrives with the frame's, and keeps its size when its node is
// lost.
TEST(OtherCanvases, haveAPictureOfEachFrame) {
    std::vector<WindowPicture> pictures;
    const auto only = [](size_t pass) {
        return [pass](const std::vector<Picture>& passes, OwnedPicture& into) { into.assign(passes[pass]); };
    };
    PictureAssembler assembler({0, 1}, {}, [&](WindowPicture picture) { pictures.push_back(std::move(picture)); },
                               {only(1)}, {Zoom{}, Zoom{.5, 1}});
    const auto part = [&](int node, uint32_t frame, uint32_t width, int value) {
        const wire::PictureHeader header{1, 1, frame, 0, 0, static_cast<int32_t>(width), 1, width, 1, 0, 0, 0};
        ByteBuffer rows = ByteBuffer::ofSize(size_t{4} * width);
        std::memset(rows.data(), value, rows.size());
        EXPECT_TRUE(assembler.part(node, header, std::move(rows)).ok());
    };
    part(1, 1, 4, 7);
    EXPECT_TRUE(pictures.empty()) << "both are shown together";
    part(0, 1, 8, 3);
    ASSERT_EQ(pictures.size(), 1u);
    EXPECT_EQ(pictures[0].picture->width(), 8);
    ASSERT_EQ(pictures[0].others.size(), 1u);
    EXPECT_EQ(pictures[0].others[0]->width(), 4);
    EXPECT_EQ(pictures[0].others[0]->view().bgra[0], std::byte{7});
    assembler.nodeLost(1);
    part(0, 2, 8, 4);
    ASSERT_EQ(pictures.size(), 2u);
    EXPECT_EQ(pictures[1].others[0]->view().bgra[0], std::byte{7}) << "as it was";
    part(0, 3, 12, 5); // the window has grown
    ASSERT_EQ(pictures.size(), 3u);
    EXPECT_EQ(pictures[2].others[0]->width(), 6);
    EXPECT_EQ(pictures[2].others[0]->view().bgra[0], std::byte{0});
}

TEST_F(PicturePassesTest, keepsFrameOrderWithLateParts) {
    part(0, 1, 10), part(1, 1, 11), part(2, 1, 12);
    frame(2, 20);
    ASSERT_EQ(pictures.size(), 1u) << "frame 2 waits for nobody";
    part(3, 1, 13);
    ASSERT_EQ(pictures.size(), 2u);
    EXPECT_EQ(pixels(0), (Pixels{20, 21, 22, 23}));
    EXPECT_EQ(pixels(1), (Pixels{10, 11, 12, 13})) << "of its own parts alone";
}

TEST_F(PicturePassesTest, keepsTheLastPartOfALostNode) {
    frame(1, 10);
    assembler.nodeLost(3);
    part(0, 2, 20), part(1, 2, 21), part(2, 2, 22);
    ASSERT_EQ(pictures.size(), 2u);
    EXPECT_EQ(pixels(1), (Pixels{20, 21, 22, 13}));
}

TEST_F(PicturePassesTest, keepsTheLastPictureOfALostPass) {
    frame(1, 10);
    part(0, 2, 20), part(1, 2, 21);
    assembler.nodeLost(2);
    assembler.nodeLost(3);
    ASSERT_EQ(pictures.size(), 2u) << "what waited for them is put together";
    EXPECT_EQ(pixels(1), (Pixels{20, 21, 12, 13}));
    part(0, 3, 30), part(1, 3, 31);
    EXPECT_EQ(pixels(2), (Pixels{30, 31, 12, 13}));
}

TEST_F(PicturePassesTest, showsAMissingPassBlack) {
    assembler.nodeLost(0);
    assembler.nodeLost(1);
    part(2, 1, 12), part(3, 1, 13);
    ASSERT_EQ(pictures.size(), 1u);
    EXPECT_EQ(pixels(0), (Pixels{0, 0, 12, 13}));
}

TEST_F(PicturePassesTest, showsALostPassOfAnotherSizeBlack) {
    frame(1, 10);
    assembler.nodeLost(2);
    assembler.nodeLost(3);
    part(0, 2, 20, 3), part(1, 2, 21, 3);
    ASSERT_EQ(pictures.size(), 2u);
    EXPECT_EQ(sizes.back(), (std::vector<int>{6, 6}));
    EXPECT_EQ(pixels(1), (Pixels{20, 20, 20, 21, 21, 21, 0, 0, 0, 0, 0, 0}));
}

TEST_F(PicturePassesTest, composesFinishedFramesWithoutAllParts) { // another node's phase
    part(0, 1, 10), part(2, 1, 12), part(3, 1, 13);
    assembler.frameDone(1, 1, 1, 1);
    ASSERT_EQ(pictures.size(), 1u);
    EXPECT_EQ(pixels(0), (Pixels{10, 0, 12, 13}));
}

TEST_F(PicturePassesTest, reusesMemoryOnlyAfterItsRelease) {
    for (uint32_t number = 1; number <= 40; ++number) frame(number, 10 * number);
    for (uint32_t number = 1; number <= 40; ++number)
        EXPECT_EQ(pixels(number - 1), (Pixels{10 * number, 10 * number + 1, 10 * number + 2, 10 * number + 3}));
}

} // namespace
} // namespace mural
