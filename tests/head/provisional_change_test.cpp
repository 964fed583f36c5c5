// Changes that revert by themselves.
#include "nodes/head/session/provisional_change.hpp"

#include <gtest/gtest.h>

#include <atomic>

namespace mural {
namespace {

using namespace std::chrono_literals;

struct Counted {
    std::atomic<int> reversions{0};
    ProvisionalChange change{[this] { ++reversions; }};

    bool reverts(int count) const {
        for (int i = 0; i < 5000 && reversions < count; ++i) std::this_thread::sleep_for(1ms);
        return reversions == count;
    }
};

TEST(ProvisionalChange, revertsWhenNobodyKeepsIt) {
    Counted c;
    EXPECT_FALSE(c.change.left());
    c.change.begin(10ms);
    EXPECT_TRUE(c.reverts(1));
    c.change.end();
    EXPECT_EQ(c.reversions, 1);
    EXPECT_FALSE(c.change.left());
}

TEST(ProvisionalChange, staysWhenKept) {
    Counted c;
    c.change.begin(1h);
    const auto left = c.change.left();
    ASSERT_TRUE(left);
    EXPECT_GT(*left, 59min);
    EXPECT_TRUE(c.change.keep());
    EXPECT_FALSE(c.change.keep());
    EXPECT_FALSE(c.change.left());
    c.change.begin(1ms);
    EXPECT_TRUE(c.reverts(1)) << "a later change is independent";
}

TEST(ProvisionalChange, hasNoTimeLeftDuringTheReversion) {
    std::atomic<bool> begun{false}, mayEnd{false};
    ProvisionalChange change([&] {
        begun = true;
        while (!mayEnd) std::this_thread::sleep_for(1ms);
    });
    change.begin(0ms);
    while (!begun) std::this_thread::sleep_for(1ms);
    EXPECT_EQ(change.left(), 0ms);
    EXPECT_FALSE(change.keep());
    mayEnd = true;
    change.end();
    EXPECT_FALSE(change.left());
}

TEST(ProvisionalChange, keepsThePendingChangeAtTheEnd) {
    Counted c;
    c.change.begin(1h);
    c.change.end();
    c.change.begin(0ms);
    c.change.end();
    EXPECT_EQ(c.reversions, 0);
}

} // namespace
} // namespace mural
