// The schedule of announcements.
#include "transport/discovery/announcer.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

constexpr int64_t kMs = 1'000'000;

class AnnouncerRun {
public:
    AnnouncerRun() : announcer_(Announcement{AnnouncementKind::Here, 4278, {}, "wall1", "0.1.0"}, 7) {}
    // Runs until a time, as an event loop with timers; queries every questionEveryNs, 0: never.
    void run(int64_t untilNs, int64_t questionEveryNs) {
        int64_t questionNs = questionEveryNs;
        while (nowNs_ < untilNs) {
            const int64_t nextNs = announcer_.tick(nowNs_, [&](std::span<const std::byte> bytes) {
                EXPECT_TRUE(decodeAnnouncement(bytes));
                sentNs.push_back(nowNs_);
            });
            ASSERT_GT(nextNs, nowNs_);
            nowNs_ = nextNs;
            if (questionEveryNs != 0 && questionNs <= nextNs) {
                nowNs_ = questionNs;
                questionNs += questionEveryNs;
                announcer_.onAnnouncement({AnnouncementKind::Search, 0, {}, "", ""}, nowNs_);
            }
        }
    }
    std::vector<int64_t> sentNs;

private:
    Announcer announcer_;
    int64_t nowNs_ = 0;
};

TEST(Announcer, announcesEverySecond) {
    AnnouncerRun announced;
    announced.run(10'500 * kMs, 0);
    EXPECT_EQ(announced.sentNs.size(), 11u);
}

TEST(Announcer, answersQueriesPromptly) {
    AnnouncerRun announced;
    announced.run(1'400 * kMs, 1'300 * kMs);
    ASSERT_EQ(announced.sentNs.size(), 3u);
    EXPECT_LT(announced.sentNs.back(), 1'350 * kMs);
}

// A thousand queries per second get as many answers as five.
TEST(Announcer, limitsItsRateUnderManyQueries) {
    AnnouncerRun announced;
    announced.run(10'000 * kMs, kMs);
    EXPECT_LE(announced.sentNs.size(), 51u);
    EXPECT_GE(announced.sentNs.size(), 35u);
    for (size_t i = 1; i < announced.sentNs.size(); ++i)
        EXPECT_GE(announced.sentNs[i] - announced.sentNs[i - 1], Announcer::kMinBetweenNs);
}

TEST(Announcer, ignoresAnnouncementsOfOthers) {
    Announcer announcer({AnnouncementKind::Here, 1, {}, "a", "0"}, 1);
    const int64_t dueNs = announcer.tick(0, [](auto) {});
    announcer.onAnnouncement({AnnouncementKind::Here, 1, {}, "b", "0"}, kMs);
    EXPECT_EQ(announcer.tick(kMs, [](auto) { FAIL(); }), dueNs);
    EXPECT_EQ(decodeAnnouncement(announcer.farewell())->kind, AnnouncementKind::Gone);
}

} // namespace
} // namespace mural
