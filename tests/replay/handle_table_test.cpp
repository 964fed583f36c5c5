// Translation of bindless handles from the program to a node.
#include "nodes/replay/engine/handle_table.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

using Of = HandleTable::Of;

TEST(HandleTable, keepsEqualHandles) {
    HandleTable t;
    EXPECT_TRUE(t.set(Of::Texture, 1, 1));
    EXPECT_TRUE(t.set(Of::Texture, 2, 2));
    EXPECT_FALSE(t.differ());
    EXPECT_EQ(t.find(Of::Texture, 2), 2u);
    EXPECT_EQ(t.find(Of::Image, 2), 0u);
    EXPECT_EQ(t.value(Of::Texture, 77), 77u); // a number that is no handle
}

TEST(HandleTable, reportsTheFirstDifference) {
    HandleTable t;
    EXPECT_TRUE(t.set(Of::Texture, 1, 1));
    EXPECT_FALSE(t.set(Of::Texture, 2, 9));
    EXPECT_TRUE(t.set(Of::Texture, 3, 10));
    EXPECT_TRUE(t.differ());
    EXPECT_EQ(t.value(Of::Texture, 1), 1u);
    EXPECT_EQ(t.value(Of::Texture, 2), 9u);
    EXPECT_EQ(t.value(Of::Texture, 77), 77u);
}

TEST(HandleTable, replacesAReusedHandle) {
    HandleTable t;
    t.set(Of::Texture, 4, 8);
    t.set(Of::Texture, 4, 5);
    EXPECT_EQ(t.find(Of::Texture, 4), 5u);
    t.set(Of::Texture, 4, 4);
    EXPECT_EQ(t.value(Of::Texture, 4), 4u);
}

TEST(HandleTable, separatesTexturesAndImages) {
    HandleTable t;
    t.set(Of::Texture, 1, 100);
    t.set(Of::Image, 1, 200);
    t.set(Of::Image, 2, 300);
    EXPECT_EQ(t.value(Of::Texture, 1), 100u);
    EXPECT_EQ(t.value(Of::Image, 1), 200u);
    EXPECT_EQ(t.value(Of::Texture, 2), 300u); // there is no such texture
}

} // namespace
} // namespace mural
