// Messages with parts of pictures: round trips, omitted pixels, damaged input.
#include <gtest/gtest.h>

#include "nodes/exchange/part_message.hpp"
#include "tests/exchange/test_parts.hpp"
#include "tests/sanitized.hpp"

namespace mural::test {
namespace {

using compositor::DepthFunction;
using compositor::RowRange;

// Some rectangles of surfaces, edges and noise.
PicturePart drawnPart(std::mt19937& random, int32_t width, int32_t height, const CompositeRule& rule) {
    PicturePart part = clearedPart(width, height, rule);
    for (int i = 0; i < 4; ++i) {
        const auto x0 = static_cast<int32_t>(random() % static_cast<uint32_t>(width)),
                   y0 = static_cast<int32_t>(random() % static_cast<uint32_t>(height));
        const bool noise = random() % 3 == 0;
        for (int32_t y = y0; y < std::min(height, y0 + 90); ++y)
            for (int32_t x = x0; x < std::min(width, x0 + 130); ++x) {
                const auto depth =
                    noise ? static_cast<uint32_t>(random()) : static_cast<uint32_t>(0x300000 + 97 * x + 31 * y);
                draw(part, part.at(x, y),
                     noise ? static_cast<uint32_t>(random()) : 0xff00a000u + static_cast<uint32_t>(x),
                     rule.deep ? depth : widened(depth & 0xffffff), rule);
            }
    }
    return part;
}

Result<PartHead> unpackInto(PicturePart& into, std::span<const std::byte> message, const RowRange& rows,
                            const CompositeRule& rule) {
    PlaneDecoder decoder;
    return unpackPart(message, into.id, rows, rule, decoder, [&](const ArrivedPiece& p) {
        ASSERT_TRUE((PixelViewport{0, rows.first, into.id.box.w, rows.count()}.contains(p.area)));
        for (int32_t y = 0; y < p.area.h; ++y)
            for (int32_t x = 0; x < p.area.w; ++x) {
                into.colour[into.at(p.area.x + x, p.area.y + y)] = p.colour[y * p.area.w + x];
                if (p.depth != nullptr) into.depth[into.at(p.area.x + x, p.area.y + y)] = p.depth[y * p.area.w + x];
            }
    });
}

TEST(PartMessage, roundTripsRows) {
    std::mt19937 random(11);
    PlaneEncoder encoder;
    for (int round = 0; round < 60; ++round) {
        const CompositeRule rule = ruleOf(kOrders[round % 4], round % 3 == 0);
        const auto width = static_cast<int32_t>(1 + random() % 400), height = static_cast<int32_t>(1 + random() % 300);
        const PicturePart part = drawnPart(random, width, height, rule);
        const auto first = static_cast<int32_t>(random() % static_cast<uint32_t>(height));
        const RowRange rows{first, first + 1 + static_cast<int32_t>(random() % static_cast<uint32_t>(height - first))};
        const auto message = packPart(part, rows, rule, PartState::Complete, encoder);
        EXPECT_LE(message.size(), boundBytesOf(part.id.box, rows));
        PicturePart back = clearedPart(width, height, rule);
        auto done = unpackInto(back, message, rows, rule);
        ASSERT_TRUE(done) << done.error().message;
        for (int32_t y = 0; y < height; ++y)
            for (int32_t x = 0; x < width; ++x) {
                const bool sent = y >= rows.first && y < rows.end;
                ASSERT_EQ(back.colour[back.at(x, y)], sent ? part.colour[part.at(x, y)] : rule.clearedColour);
                ASSERT_EQ(back.depth[back.at(x, y)], sent ? part.depth[part.at(x, y)] : rule.clearedDepth);
            }
        encoder.transferred(1 << 20, round % 2 ? 1'000'000 : 100'000'000); // the rate changes, so codecs do
    }
}

TEST(PartMessage, omitsUndrawnPixels) {
    const CompositeRule rule = ruleOf(DepthFunction::Less, false);
    PlaneEncoder encoder;
    PicturePart part = clearedPart(1920, 1080, rule);
    EXPECT_EQ(packPart(part, {0, 1080}, rule, PartState::Complete, encoder).size(), 48u);
    draw(part, part.at(1000, 500), 1, 0, rule);
    EXPECT_LT(packPart(part, {0, 1080}, rule, PartState::Complete, encoder).size(), 1000u);
}

TEST(PartMessage, hasNoDepthIfThePartsAreBlended) {
    std::mt19937 random(5);
    CompositeRule rule;
    rule.blends = true;
    PicturePart part = clearedPart(200, 100, rule);
    for (size_t at = 0; at < part.colour.size(); at += 3) part.colour[at] = static_cast<uint32_t>(random());
    part.order = 77;
    PlaneEncoder encoder;
    CompositeRule deep = rule;
    deep.blends = false;
    const size_t withDepth = packPart(part, {0, 100}, deep, PartState::Complete, encoder).size();
    part.depth.clear();
    const auto message = packPart(part, {0, 100}, rule, PartState::Complete, encoder);
    EXPECT_LT(message.size(), withDepth);
    PicturePart back = clearedPart(200, 100, rule);
    back.depth.clear();
    const auto done = unpackInto(back, message, {0, 100}, rule);
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(done->order, 77u);
    EXPECT_EQ(back.colour, part.colour);
    PicturePart depths = clearedPart(200, 100, deep);
    depths.colour[7] = depths.depth[7] = 1;
    const auto other = unpackInto(back, packPart(depths, {0, 100}, deep, PartState::Complete, encoder), {0, 100}, rule);
    ASSERT_FALSE(other);
    EXPECT_NE(other.error().message.find("a piece has depth"), std::string::npos) << other.error().message;
}

TEST(PartMessage, enlargesNoiseByItsHeadersOnly) {
    std::mt19937 random(2);
    const CompositeRule rule = ruleOf(DepthFunction::Less, true);
    PicturePart part = clearedPart(300, 200, rule);
    for (auto& word : part.colour) word = static_cast<uint32_t>(random());
    for (auto& word : part.depth) word = static_cast<uint32_t>(random());
    PlaneEncoder encoder;
    for (int i = 0; i < 20; ++i)
        EXPECT_LE(packPart(part, {0, 200}, rule, PartState::Complete, encoder).size(),
                  boundBytesOf(part.id.box, {0, 200}));
}

TEST(PartMessage, distinguishesPictures) {
    const CompositeRule rule = ruleOf(DepthFunction::Less, false);
    PlaneEncoder encoder;
    PicturePart part = clearedPart(64, 64, rule);
    const auto message = packPart(part, {0, 32}, rule, PartState::Incomplete, encoder);
    EXPECT_EQ(unpackInto(part, message, {0, 32}, rule)->state, PartState::Incomplete);
    EXPECT_FALSE(unpackInto(part, message, {32, 64}, rule));
    ++part.id.serial;
    EXPECT_EQ(unpackInto(part, message, {0, 32}, rule).error().message,
              "parts of different pictures arrived together; this picture is incomplete");
}

TEST(PartMessage, reportsDamageInOneLine) {
    std::mt19937 random(3);
    const CompositeRule rule = ruleOf(DepthFunction::Less, false);
    PlaneEncoder encoder;
    PicturePart part = drawnPart(random, 200, 150, rule);
    const auto message = packPart(part, {0, 150}, rule, PartState::Complete, encoder);
    uint64_t refused = 0;
    for (uint64_t i = 0; i < mural::testing::rounds(3000); ++i) {
        auto damaged = message;
        if (i % 3 == 0)
            damaged.resize(random() % damaged.size());
        else
            for (uint32_t n = 0; n < 1 + random() % 4; ++n)
                damaged[random() % std::min<size_t>(damaged.size(), i % 2 ? 120 : SIZE_MAX)] =
                    static_cast<std::byte>(random());
        PicturePart into = clearedPart(200, 150, rule);
        auto done = unpackInto(into, damaged, {0, 150}, rule);
        if (done) continue;
        ++refused;
        EXPECT_EQ(done.error().message.find('\n'), std::string::npos);
    }
    EXPECT_GT(refused, mural::testing::rounds(1000));
}

} // namespace
} // namespace mural::test
