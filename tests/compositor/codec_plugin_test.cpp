// Codec plug-ins are found by name. Invalid ones are rejected with a reason.
#include <gtest/gtest.h>

#include "compositor/codecs/registry.hpp"
#include "tests/compositor/random_bytes.hpp"

namespace mural::compositor::test {
namespace {

TEST(CodecPlugin, isFoundByNameAndWorks) {
    CodecRegistry registry(MURAL_TEST_PLUGINS);
    const size_t own = registry.known().size();
    auto codec = registry.make("inverted");
    ASSERT_TRUE(codec) << codec.error().message;
    ASSERT_TRUE(registry.make("inverted"));
    ASSERT_EQ(registry.known().size(), own + 1) << "opened once";
    const auto info = registry.find("inverted");
    ASSERT_TRUE(info);
    EXPECT_TRUE(info.value().lossless && info.value().takes(PlaneFormat::Rgba8) &&
                !info.value().takes(PlaneFormat::D32F));
    std::mt19937 random(1);
    Plane plane(PlaneFormat::Rgba8, 13, 7), back(PlaneFormat::Rgba8, 13, 7);
    fillRandomly(random, plane.bytes());
    std::vector<std::byte> bytes((*codec)->boundBytes(shapeOf(plane.view())));
    auto size = (*codec)->encode(plane.view(), bytes);
    ASSERT_TRUE(size);
    EXPECT_EQ(bytes[5], ~plane.bytes()[5]);
    ASSERT_TRUE((*codec)->decode(std::span(bytes).first(*size), back.view()));
    EXPECT_EQ(back, plane);
    const auto refused = (*codec)->decode(std::span(bytes).first(3), back.view());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, "codec inverted: another size; check the sender");
}

TEST(CodecPlugin, isRejectedWithAReasonWhenUnfit) {
    CodecRegistry registry(MURAL_TEST_PLUGINS);
    const auto why = [&](const char* name) {
        auto codec = registry.make(name);
        return codec ? std::string() : codec.error().message;
    };
    EXPECT_NE(why("noentry").find("no function mural_get_codec_plugin"), std::string::npos) << why("noentry");
    EXPECT_NE(why("older").find("version 0"), std::string::npos) << why("older");
    EXPECT_NE(why("short").find("truncated"), std::string::npos) << why("short");
    EXPECT_NE(why("renamed").find("the codec \"other\""), std::string::npos) << why("renamed");
    EXPECT_NE(why("missing").find("the plug-in is missing"), std::string::npos) << why("missing");
    EXPECT_NE(why("../inverted").find("unknown codec"), std::string::npos) << why("../inverted");
    auto liar = registry.make("liar");
    ASSERT_TRUE(liar);
    Plane plane(PlaneFormat::Rgba8, 2, 2);
    std::vector<std::byte> bytes(16);
    EXPECT_FALSE((*liar)->encode(plane.view(), bytes)) << "it says that it wrote more than there is room for";
}

} // namespace
} // namespace mural::compositor::test
