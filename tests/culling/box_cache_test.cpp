#include "nodes/culling/box_cache.hpp"

#include <gtest/gtest.h>

namespace mural::culling {
namespace {

BoxKey keyOf(uint64_t number) {
    BoxKey key;
    key.add(number);
    key.add(7);
    return key;
}

std::shared_ptr<const DrawBoxes> boxesOf(size_t floats) {
    return std::make_shared<DrawBoxes>(1, std::vector<float>(2),
                                       std::vector<DrawBoxes::Level>{{1, std::vector<float>(floats)}});
}

TEST(BoxCache, wantsBoxesAtTheSecondSighting) {
    BoxCache cache;
    EXPECT_FALSE(cache.look(keyOf(1)).wantsBoxes());
    EXPECT_FALSE(cache.look(keyOf(2)).wantsBoxes());
    EXPECT_TRUE(cache.look(keyOf(1)).wantsBoxes());
    cache.store(boxesOf(2));
    EXPECT_TRUE(cache.look(keyOf(1)).boxes);
    EXPECT_FALSE(cache.look(keyOf(1)).wantsBoxes());
    cache.look(keyOf(2));
    cache.store(nullptr);
    EXPECT_FALSE(cache.look(keyOf(2)).wantsBoxes()) << "impossible boxes are not tried again";
}

TEST(BoxCache, dropsWhatWasNotUsedForLongAtItsBound) {
    BoxCache cache(100'000);
    for (const uint64_t i : {0, 1}) {
        cache.look(keyOf(i));
        cache.look(keyOf(i));
        cache.store(boxesOf(1000));
    }
    for (uint64_t i = 2; i < 2000; ++i) { // contents that change with each draw
        cache.look(keyOf(i));
        cache.look(keyOf(0));
        EXPECT_LE(cache.memoryBytes(), 100'000U);
    }
    EXPECT_TRUE(cache.look(keyOf(0)).boxes);
    EXPECT_FALSE(cache.look(keyOf(1)).boxes);
    EXPECT_LE(cache.peakBytes(), 100'000U);
    cache.look(keyOf(5));
    cache.look(keyOf(5));
    cache.store(boxesOf(100'000)); // alone above the bound
    EXPECT_TRUE(cache.look(keyOf(5)).boxes);
}

TEST(BoxCache, keysWithTooManyNumbersAreIncomplete) {
    BoxKey key;
    for (int i = 0; i < 24; ++i) key.add(1);
    EXPECT_TRUE(key.isComplete());
    key.add(1);
    EXPECT_FALSE(key.isComplete());
}

} // namespace
} // namespace mural::culling
