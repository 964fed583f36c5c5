// The tile delta sends only changed tiles, and detects lost and damaged planes.
#include <gtest/gtest.h>

#include "compositor/codecs/registry.hpp"
#include "compositor/codecs/tile_delta.hpp"
#include "tests/compositor/test_planes.hpp"

namespace mural::compositor::test {
namespace {

struct Link {
    std::unique_ptr<Codec> codec = std::move(CodecRegistry().make("bitplane").value());
    TileDeltaEncoder encoder;
    TileDeltaDecoder decoder;

    std::vector<std::byte> encoded(const Plane& plane) {
        std::vector<std::byte> bytes(encoder.boundBytes(shapeOf(plane.view()), *codec));
        bytes.resize(encoder.encode(plane.view(), *codec, bytes).value());
        return bytes;
    }
};

TEST(TileDelta, sendsChangesOnly) {
    std::mt19937 random(1);
    Link link;
    Plane plane = makePlane(random, PlaneFormat::Rgba8, Content::Noise, 1000, 300),
          there(PlaneFormat::Rgba8, 1000, 300);
    std::vector<std::byte> bytes = link.encoded(plane);
    EXPECT_EQ(link.encoder.changedTiles(), 4u * 5u);
    ASSERT_TRUE(link.decoder.decode(bytes, *link.codec, there.view()));
    ASSERT_EQ(there, plane);

    bytes = link.encoded(plane);
    EXPECT_EQ(bytes.size(), 8u + 3u) << "nothing but its head";
    ASSERT_TRUE(link.decoder.decode(bytes, *link.codec, there.view()));
    for (int frame = 0; frame < 20; ++frame) {
        for (unsigned i = 0; i < random() % 4; ++i) plane.bytes()[random() % plane.bytes().size()] ^= std::byte{1};
        bytes = link.encoded(plane);
        EXPECT_LE(link.encoder.changedTiles(), 3u);
        const auto decoded = link.decoder.decode(bytes, *link.codec, there.view());
        ASSERT_TRUE(decoded) << decoded.error().message;
        ASSERT_EQ(there, plane);
    }
}

TEST(TileDelta, detectsAMissingPlaneAndRestarts) {
    std::mt19937 random(2);
    Link link;
    Plane plane = makePlane(random, PlaneFormat::D24S8, Content::Surface, 300, 70), there(PlaneFormat::D24S8, 300, 70);
    ASSERT_TRUE(link.decoder.decode(link.encoded(plane), *link.codec, there.view()));
    plane.bytes()[4] ^= std::byte{1};
    (void)link.encoded(plane); // lost
    plane.bytes()[8] ^= std::byte{1};
    const auto refused = link.decoder.decode(link.encoded(plane), *link.codec, there.view());
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("its previous plane is not the current one"), std::string::npos);
    EXPECT_FALSE(link.decoder.decode(link.encoded(plane), *link.codec, there.view())) << "still";
    link.encoder.restart();
    ASSERT_TRUE(link.decoder.decode(link.encoded(plane), *link.codec, there.view()));
    EXPECT_EQ(there, plane);
    // Another shape restarts automatically.
    Plane larger = makePlane(random, PlaneFormat::D24S8, Content::Surface, 301, 70),
          target(PlaneFormat::D24S8, 301, 70);
    ASSERT_TRUE(link.decoder.decode(link.encoded(larger), *link.codec, target.view()));
    EXPECT_EQ(target, larger);
}

TEST(TileDelta, rejectsDamagedBytes) {
    std::mt19937 random(3);
    Link link;
    const Plane plane = makePlane(random, PlaneFormat::Rgba8, Content::Mixed, 300, 70);
    Plane there(PlaneFormat::Rgba8, 300, 70);
    const std::vector<std::byte> bytes = link.encoded(plane);
    for (size_t cut = 0; cut < bytes.size(); ++cut) {
        const std::vector<std::byte> piece(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(cut));
        ASSERT_FALSE(link.decoder.decode(piece, *link.codec, there.view())) << cut;
    }
    std::vector<std::byte> fewer = bytes;
    fewer[8] &= ~std::byte{1};
    EXPECT_FALSE(link.decoder.decode(fewer, *link.codec, there.view())) << "a first plane holds all tiles";
    fewer[8] |= std::byte{0x80};
    EXPECT_FALSE(link.decoder.decode(fewer, *link.codec, there.view())) << "a tile that the plane has not";
}

} // namespace
} // namespace mural::compositor::test
