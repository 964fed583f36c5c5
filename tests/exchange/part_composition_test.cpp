// Parts of a picture composited in any pairing equal the picture of a single node.
#include <gtest/gtest.h>

#include "tests/exchange/test_parts.hpp"

namespace mural::test {
namespace {

void fold(PicturePart& into, const PicturePart& other, LayerOrder side, const CompositeRule& rule) {
    compositeRow({into.colour.data(), into.depth.data(), other.colour.data(), other.depth.data(), into.colour.size()},
                 side, rule);
}

// Three nodes draw a third each; any pairing gives the picture of a single node.
TEST(PartComposition, givesOneNodesPictureForAnyPairing) {
    std::mt19937 random(5);
    for (const auto function : kOrders)
        for (const bool deep : {false, true})
            for (int round = 0; round < 40; ++round) {
                const CompositeRule rule = ruleOf(function, deep);
                PicturePart whole = clearedPart(37, 3, rule);
                std::vector<PicturePart> parts(3, whole);
                for (PicturePart& part : parts)
                    for (const Fragment& f : fragmentsOf(random, whole.colour.size(), rule)) {
                        draw(whole, f.at, f.colour, f.depth, rule);
                        draw(part, f.at, f.colour, f.depth, rule);
                    }
                PicturePart left = parts[0];
                fold(left, parts[1], LayerOrder::Later, rule);
                fold(left, parts[2], LayerOrder::Later, rule);
                PicturePart right = parts[2];
                fold(right, parts[1], LayerOrder::Earlier, rule);
                fold(right, parts[0], LayerOrder::Earlier, rule);
                PicturePart middle = parts[1];
                fold(middle, parts[2], LayerOrder::Later, rule);
                fold(middle, parts[0], LayerOrder::Earlier, rule);
                for (const PicturePart* made : {&left, &right, &middle}) {
                    ASSERT_EQ(made->colour, whole.colour)
                        << "function " << static_cast<int>(function) << (deep ? ", deep" : "");
                    ASSERT_EQ(made->depth, whole.depth);
                }
            }
}

// All 32 bits count.
TEST(PartComposition, comparesAllBitsOfDeepBuffers) {
    const CompositeRule rule = ruleOf(compositor::DepthFunction::Less, true);
    PicturePart into = clearedPart(1, 1, rule), later = into;
    draw(into, 0, 1, 0x80000001u, rule);
    draw(later, 0, 2, 0x80000000u, rule);
    fold(into, later, LayerOrder::Later, rule);
    EXPECT_EQ(into.colour[0], 2u);
}

} // namespace
} // namespace mural::test
