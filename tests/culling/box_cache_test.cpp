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
    return std::make_shared<DrawBoxes>(1, std::vector<float>(floats), std::vector<DrawBoxes::Level>{});
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

TEST(BoxCache, dropsTheLeastRecentlyUsedAtItsBound) {
    BoxCache cache(100'000);
    for (uint64_t i = 0; i < 40; ++i) {
        cache.look(keyOf(i));
        cache.look(keyOf(0));
        cache.look(keyOf(i));
        cache.store(boxesOf(1000));
        EXPECT_LE(cache.memoryBytes(), 100'000U);
    }
    EXPECT_TRUE(cache.look(keyOf(0)).boxes);
    EXPECT_TRUE(cache.look(keyOf(39)).boxes);
    EXPECT_FALSE(cache.look(keyOf(1)).boxes);
    EXPECT_LE(cache.peakBytes(), 100'000U);
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
