// Pictures through the encoder of tiles, the assembly and the canvas.
#include <gtest/gtest.h>

#include "nodes/remote_wall/frame_assembly.hpp"
#include "nodes/remote_wall/tile_canvas.hpp"
#include "nodes/remote_wall/tile_encoder.hpp"
#include "tests/remote_wall/test_pictures.hpp"

namespace mural::remote {
namespace {

using testing::decibels;
using testing::pictureOf;

class Way {
public:
    explicit Way(const std::string& codec) : encoder(codec, 128), canvas(codec) {}

    // Sends a frame; returns its end.
    FrameEnd through(std::span<const Picture> eyes) {
        bytes = 0;
        auto end = encoder.encode(++number, eyes, [&](const Tile& tile) -> Result<void> {
            const auto message = encode(tile);
            bytes += message.size();
            return assembly.add(0, std::get<Tile>(*parseMessage(message)));
        });
        EXPECT_TRUE(end);
        bytes += encode(*end).size();
        EXPECT_TRUE(assembly.end(0, *end));
        for (const CompleteFrame& frame : assembly.takeComplete()) EXPECT_TRUE(canvas.apply(frame));
        return *end;
    }
    FrameEnd through(const OwnedPicture& picture) {
        const Picture view = picture.view();
        return through(std::span(&view, 1));
    }

    TileEncoder encoder;
    FrameAssembly assembly{1};
    TileCanvas canvas;
    uint64_t number = 0;
    size_t bytes = 0; // of the latest frame
};

TEST(WallTiles, losslessCodecsKeepEveryPixel) {
    for (const char* codec : {"auto", "raw", "bitplane-zstd", "lz4"}) {
        Way way(codec);
        for (const int step : {0, 3, 9}) {
            const OwnedPicture picture = pictureOf(531, 257, step);
            way.through(picture);
            EXPECT_TRUE(comparePictures(picture.view(), way.canvas.picture(0)).same()) << codec << " " << step;
        }
    }
}

TEST(WallTiles, jpeg100IsCloseToThePicture) {
    Way way("jpeg-100");
    const OwnedPicture picture = pictureOf(531, 257, 4);
    way.through(picture);
    EXPECT_GE(decibels(picture.view(), way.canvas.picture(0)), 45);
}

TEST(WallTiles, sendsOnlyChangedTiles) {
    Way way("auto");
    const FrameEnd first = way.through(pictureOf(512, 256, 0));
    EXPECT_TRUE(first.isWhole);
    EXPECT_EQ(first.tiles, 8U);
    const FrameEnd second = way.through(pictureOf(512, 256, 1)); // within the same tile
    EXPECT_FALSE(second.isWhole);
    EXPECT_EQ(second.tiles, 1U);
    EXPECT_EQ(way.through(pictureOf(512, 256, 1)).tiles, 0U);
    EXPECT_LT(way.bytes, 200U);
    way.encoder.restart();
    EXPECT_EQ(way.through(pictureOf(512, 256, 1)).tiles, 8U);
}

TEST(WallTiles, followsTheSizeOfThePicture) {
    Way way("auto");
    way.through(pictureOf(200, 100, 0));
    const OwnedPicture large = pictureOf(300, 150, 2);
    EXPECT_TRUE(way.through(large).isWhole);
    EXPECT_TRUE(comparePictures(large.view(), way.canvas.picture(0)).same());
}

TEST(WallTiles, sendsBothEyes) {
    Way way("lz4");
    const OwnedPicture left = pictureOf(200, 100, 0), right = pictureOf(200, 100, 5);
    const Picture eyes[] = {left.view(), right.view()};
    way.through(eyes);
    EXPECT_EQ(way.canvas.size().eyes, 2);
    EXPECT_TRUE(comparePictures(left.view(), way.canvas.picture(0)).same());
    EXPECT_TRUE(comparePictures(right.view(), way.canvas.picture(1)).same());
}

TEST(WallTiles, sendsAllTilesAfterAFailure) {
    TileEncoder encoder("lz4", 64);
    const OwnedPicture picture = pictureOf(200, 100, 0);
    const Picture view = picture.view();
    const auto refuse = [](const Tile&) -> Result<void> { return Error{"gone"}; };
    EXPECT_FALSE(encoder.encode(1, std::span(&view, 1), refuse));
    const auto accept = [](const Tile&) { return Result<void>(); };
    EXPECT_TRUE(encoder.encode(2, std::span(&view, 1), accept)->isWhole);
}

TEST(WallTiles, rejectsTilesOfUnknownCodecs) {
    TileCanvas canvas("auto");
    CompleteFrame frame{1, 1, {64, 64, 1}, {{0, {0, 0, 64, 64}, 200, std::vector<std::byte>(8)}}};
    EXPECT_FALSE(canvas.apply(frame));
}

} // namespace
} // namespace mural::remote
