#include "nodes/render/replay_spans.hpp"

#include <array>
#include <gtest/gtest.h>
#include <thread>

namespace mural {
namespace {

constexpr std::array<uint32_t, 2> kSwitch = {0, 1};

std::span<const std::byte> argumentsFor(bool isOn) {
    return std::as_bytes(std::span(kSwitch).subspan(isOn ? 1 : 0, 1));
}

void work() { std::this_thread::sleep_for(std::chrono::microseconds(100)); }

// ReplaySpans belongs to a thread; each test uses one of its own.
template <typename Test> void onThread(Test test) { std::thread(test).join(); }

TEST(ReplaySpans, areAbsentWithoutStatistics) {
    onThread([] {
        ReplaySpans spans;
        work();
        EXPECT_TRUE(spans.take().empty());
    });
}

TEST(ReplaySpans, dropTheFrameInWhichStatisticsBegin) {
    onThread([] {
        ReplaySpans spans;
        ASSERT_TRUE(spans.record(argumentsFor(true)));
        work();
        ASSERT_TRUE(spans.record(argumentsFor(true))); // announced twice
        work();
        EXPECT_TRUE(spans.take().empty());
        work();
        EXPECT_EQ(spans.take().size(), 1u);
        ASSERT_TRUE(spans.record(argumentsFor(false)));
        work();
        EXPECT_TRUE(spans.take().empty());
        ASSERT_TRUE(spans.record(argumentsFor(true)));
        work();
        EXPECT_TRUE(spans.take().empty());
    });
}

TEST(ReplaySpans, keepTheFirstFrameOfANodeThatStartsWithStatistics) {
    onThread([] {
        ReplaySpans spans;
        spans.record(true);
        work();
        EXPECT_EQ(spans.take().size(), 1u);
    });
}

TEST(ReplaySpans, rejectInvalidArguments) {
    onThread([] {
        ReplaySpans spans;
        EXPECT_FALSE(spans.record(argumentsFor(true).first(3)));
        EXPECT_TRUE(spans.take().empty());
    });
}

} // namespace
} // namespace mural
