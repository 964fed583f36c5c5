// Parts of pictures from several nodes become whole frames.
#include "nodes/head/frames/picture_assembler.hpp"
#include "streamcodec/wire/node_messages.hpp"

#include <cstring>
#include <gtest/gtest.h>

namespace mural {
namespace {

class PictureAssemblerTest : public testing::Test {
protected:
    PictureAssembler assembler{2, [this](WindowPicture picture) { pictures.push_back(std::move(picture)); }};
    std::vector<WindowPicture> pictures;

    // Delivers one part of a window of 4 × 1 pixels. Node 0 draws the left half, node 1 the right one.
    bool part(int node, uint32_t frame, uint32_t pixel, uint32_t window = 1, uint32_t width = 4,
              PictureFormat format = PictureFormat::Bgra8) {
        const int32_t x = node == 0 ? 0 : 2;
        const wire::PictureHeader header{1, window, frame, x,     0, 2,
                                         1, width,  1,     0xabc, 0, static_cast<uint32_t>(format)};
        ByteBuffer rows = ByteBuffer::ofSize(8);
        std::memcpy(rows.data(), &pixel, 4);
        std::memcpy(rows.data() + 4, &pixel, 4);
        return assembler.part(node, header, std::move(rows)).ok();
    }
    std::vector<uint32_t> pixels(size_t index) const {
        const Picture view = pictures[index].picture->view();
        std::vector<uint32_t> values(static_cast<size_t>(view.width));
        std::memcpy(values.data(), view.bgra, view.sizeBytes());
        return values;
    }
};

using Pixels = std::vector<uint32_t>;

TEST_F(PictureAssemblerTest, acceptsPartsOutOfOrder) {
    part(0, 1, 10);
    part(0, 2, 20);
    part(0, 3, 30);
    EXPECT_TRUE(pictures.empty());
    part(1, 1, 11);
    part(1, 2, 21);
    part(1, 3, 31);
    ASSERT_EQ(pictures.size(), 3u);
    for (uint32_t i = 0; i < 3; ++i) EXPECT_EQ(pictures[i].frame, i + 1);
    EXPECT_EQ(pixels(0), (Pixels{10, 10, 11, 11})) << "kept though later ones came";
    EXPECT_EQ(pixels(2), (Pixels{30, 30, 31, 31}));
    EXPECT_EQ(pictures[0].nativeWindow, 0xabcu);
}

// A node whose driver has no surfaces of 10 bits sends 8, which 10 bits represent without loss.
TEST_F(PictureAssemblerTest, combinesPartsOfBothFormats) {
    const uint32_t deep = 3U << 30 | 0x201U << 20 | 1U << 10 | 0x3ffU, plain = 0xff8000ffU;
    part(0, 1, deep, 1, 4, PictureFormat::Bgr10A2);
    part(1, 1, plain);
    ASSERT_EQ(pictures.size(), 1u);
    EXPECT_EQ(pictures[0].picture->format(), PictureFormat::Bgr10A2);
    const uint32_t widened = 3U << 30 | 0x202U << 20 | 0x3ffU; // 0x80 of 255 is 513.5 of 1023
    EXPECT_EQ(pixels(0), (Pixels{deep, deep, widened, widened}));
    EXPECT_FALSE(part(0, 2, deep, 1, 4, static_cast<PictureFormat>(2)));
}

TEST_F(PictureAssemblerTest, keepsOldTilesOfALostNode) {
    part(0, 1, 10);
    part(1, 1, 11);
    part(0, 2, 20);
    part(0, 3, 30);
    assembler.nodeLost(1);
    ASSERT_EQ(pictures.size(), 3u);
    EXPECT_EQ(pixels(1), (Pixels{20, 20, 11, 11}));
    EXPECT_EQ(pixels(2), (Pixels{30, 30, 11, 11}));
    part(0, 4, 40);
    EXPECT_EQ(pixels(3), (Pixels{40, 40, 11, 11}));
    part(0, 5, 50, 1, 6); // resized: there is no old tile
    EXPECT_EQ(pixels(4), (Pixels{50, 50, 0, 0, 0, 0}));
}

TEST_F(PictureAssemblerTest, completesFramesWithoutParts) {
    assembler.frameDone(1, 1, 1, 1); // before the other node's part
    part(0, 1, 10);
    EXPECT_EQ(pictures.size(), 1u);
    part(0, 2, 20);
    assembler.frameDone(1, 1, 1, 2); // and after
    EXPECT_EQ(pictures.size(), 2u);
    assembler.frameDone(0, 1, 1, 3);
    assembler.frameDone(1, 1, 1, 3); // no part of any node: no picture
    EXPECT_EQ(pictures.size(), 2u);
}

// Alternating frames: one node has a part, the other none. The node with the part reports the frame done after it.
TEST_F(PictureAssemblerTest, assemblesAnyNumberOfAlternatingFrames) {
    constexpr uint32_t kFrames = 20'000;
    for (uint32_t frame = 1; frame <= kFrames; ++frame) {
        const int drawer = static_cast<int>(frame % 2);
        assembler.frameDone(1 - drawer, 1, 1, frame);
        ASSERT_TRUE(part(drawer, frame, frame)) << frame;
        ASSERT_EQ(pictures.size(), 1u);
        pictures.clear();
        assembler.frameDone(drawer, 1, 1, frame);
    }
}

TEST_F(PictureAssemblerTest, keepsNothingOfAnEndedProgram) {
    part(0, 1, 10);
    part(1, 1, 11);
    part(0, 2, 20);
    assembler.clientGone(1);
    assembler.nodeLost(1);
    EXPECT_EQ(pictures.size(), 1u);
    part(0, 3, 30);
    EXPECT_EQ(pixels(1), (Pixels{30, 30, 0, 0}));
}

TEST_F(PictureAssemblerTest, separatesWindows) {
    part(0, 1, 10, 1);
    part(1, 2, 21, 2);
    EXPECT_TRUE(pictures.empty());
    part(0, 2, 20, 2);
    ASSERT_EQ(pictures.size(), 1u);
    EXPECT_EQ(pictures[0].window, 2u);
}

TEST_F(PictureAssemblerTest, reusesMemoryOnlyWithoutReferences) {
    for (uint32_t frame = 1; frame <= 20; ++frame) {
        part(0, frame, frame);
        part(1, frame, frame);
    }
    for (uint32_t frame = 1; frame <= 20; ++frame) EXPECT_EQ(pixels(frame - 1), Pixels(4, frame));
}

TEST_F(PictureAssemblerTest, rejectsPartsOutsideTheirPicture) {
    const wire::PictureHeader bad[] = {
        {1, 1, 1, 3, 0, 2, 1, 4, 1, 0, 0, 0},     {1, 1, 1, -1, 0, 2, 1, 4, 1, 0, 0, 0},
        {1, 1, 1, 0, 1, 2, 1, 4, 1, 0, 0, 0},     {1, 1, 1, 0, 0, 2, 1, 0, 0, 0, 0, 0},
        {1, 1, 1, 0, 0, 2, 1, 40000, 1, 0, 0, 0}, {1, 1, 1, 0, 0, 2, 1, 32000, 32000, 0, 0, 0},
    };
    for (const auto& header : bad) EXPECT_FALSE(assembler.part(0, header, ByteBuffer::ofSize(8)).ok());
    EXPECT_TRUE(part(0, 1, 1));
    EXPECT_FALSE(part(0, 1, 1)) << "twice";
}

} // namespace
} // namespace mural
