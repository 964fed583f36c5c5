#include <gtest/gtest.h>

#include "nodes/head/usual_time.hpp"

namespace mural {
namespace {

TEST(UsualTime, isNotThatOfOneThatSomethingElseHasDisturbed) {
    UsualTime time;
    EXPECT_EQ(time.value(), 0);
    time.add(30'000);
    EXPECT_EQ(time.value(), 30'000) << "there is no other";
    time.add(20);
    EXPECT_EQ(time.value(), 20);
    for (const double ns : {22.0, 4e6, 21.0, 5e6, 23.0}) {
        time.add(ns);
        EXPECT_LT(time.value(), 30) << ns;
    }
}

TEST(UsualTime, followsWhatStaysOtherwise) {
    UsualTime time;
    for (int i = 0; i < 5; ++i) time.add(20);
    for (int i = 0; i < 3; ++i) time.add(90);
    EXPECT_EQ(time.value(), 90);
}

} // namespace
} // namespace mural
