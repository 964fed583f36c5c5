// Encoding of the messages of remote walls.
#include <gtest/gtest.h>

#include "nodes/remote_wall/wall_message.hpp"

namespace mural::remote {
namespace {

template <class T> T again(const T& message) {
    auto parsed = parseMessage(encode(message));
    EXPECT_TRUE(parsed) << parsed.error().message;
    return std::get<T>(*parsed);
}

TEST(WallMessage, carriesGreetings) {
    Hello hello;
    hello.name = "museum";
    hello.codec = "jpeg-100";
    hello.session = 0x123456789abcdef0;
    hello.width = 3840, hello.height = 2160;
    hello.eyes = 2, hello.tile = 512;
    hello.source = 3, hello.sources = 4;
    EXPECT_EQ(again(hello), hello);
}

TEST(WallMessage, readsTheVersionOfOtherGreetings) {
    Hello hello;
    hello.version = kWallVersion + 1;
    EXPECT_EQ(again(hello).version, kWallVersion + 1);
}

TEST(WallMessage, carriesTilesAndEnds) {
    const std::vector<std::byte> bytes(100, std::byte{7});
    const Tile tile = again(Tile{5, {640, 480, 2}, 1, {512, 0, 128, 480}, 8, bytes});
    EXPECT_EQ(tile.frame, 5U);
    EXPECT_EQ(tile.size, (PictureSize{640, 480, 2}));
    EXPECT_EQ(tile.eye, 1);
    EXPECT_EQ(tile.area, (PixelViewport{512, 0, 128, 480}));
    EXPECT_EQ(tile.codec, 8);
    EXPECT_EQ(tile.bytes.size(), bytes.size());
    const FrameEnd end{6, {1920, 1080, 1}, 12, true, 77};
    EXPECT_EQ(again(end), end);
}

TEST(WallMessage, sendsAnUnchangedFrameInFewBytes) {
    EXPECT_LT(encode(FrameEnd{1'000'000, {7680, 4320, 1}, 0, false, 1'000'000}).size(), 32U);
}

TEST(WallMessage, carriesReplies) {
    EXPECT_EQ(again(Ack{9, 1234}), (Ack{9, 1234}));
    EXPECT_EQ(again(Want{30, 800, 600, true}), (Want{30, 800, 600, true}));
    EXPECT_EQ(again(Bye{"its window was closed", true}), (Bye{"its window was closed", true}));
    EXPECT_EQ(again(Bye{"two\nlines", false}).reason, "two lines");
}

TEST(WallMessage, carriesEvents) {
    Event event;
    event.input.kind = input::InputKind::Key;
    event.input.isDown = true;
    event.input.code = "k38";
    event.input.keysym = 0x61;
    EXPECT_EQ(again(event).input.code, "k38");
    EXPECT_EQ(again(event).input.keysym, 0x61U);
    event.input.kind = input::InputKind::Wheel;
    event.input.hasPlace = true;
    event.input.x = 0.25, event.input.y = 1;
    event.input.wheelY = -240;
    const Event wheel = again(event);
    EXPECT_EQ(wheel.input.x, 0.25);
    EXPECT_EQ(wheel.input.y, 1);
    EXPECT_EQ(wheel.input.wheelY, -240);
}

TEST(WallMessage, rejectsDamage) {
    EXPECT_FALSE(parseMessage({}));
    const std::vector<std::byte> unknown{std::byte{99}};
    EXPECT_FALSE(parseMessage(unknown));
    std::vector<std::byte> hello = encode(Hello{});
    hello[1] ^= std::byte{1}; // the magic number
    EXPECT_FALSE(parseMessage(hello));
    std::vector<std::byte> ack = encode(Ack{1, 2});
    ack.push_back(std::byte{0}); // too long
    EXPECT_FALSE(parseMessage(ack));
    const std::vector<std::byte> bytes(4);
    EXPECT_FALSE(parseMessage(encode(Tile{1, {64, 64, 1}, 0, {60, 0, 8, 8}, 0, bytes}))); // beyond the picture
    EXPECT_FALSE(parseMessage(encode(Tile{1, {64, 64, 1}, 1, {0, 0, 8, 8}, 0, bytes})));  // of another eye
    EXPECT_FALSE(parseMessage(encode(Tile{1, {64, 64, 1}, 0, {0, 0, 0, 8}, 0, {}})));
    const std::vector<std::byte> many(300);
    EXPECT_FALSE(parseMessage(encode(Tile{1, {64, 64, 1}, 0, {0, 0, 8, 8}, 0, many}))); // more than its pixels
    EXPECT_FALSE(parseMessage(encode(FrameEnd{1, {0, 64, 1}, 0, true, 1})));
    EXPECT_FALSE(parseMessage(encode(FrameEnd{1, {kMaxPictureSide, kMaxPictureSide, 1}, 0, true, 1})));
}

} // namespace
} // namespace mural::remote
