#include "tools/mural/page/hub/topic_fan.hpp"

#include <gtest/gtest.h>
#include <vector>

#include "common/base/clock.hpp"

namespace mural::page {
namespace {

using Json = nlohmann::json;

class TopicFanTest : public ::testing::Test {
protected:
    void subscribe(int viewer, const char* topic, int64_t intervalMs) {
        EXPECT_TRUE(
            fan_.subscribe(viewer, {{"topic", topic}, {"interval", static_cast<uint64_t>(intervalMs)}}, nowNs_).ok());
    }
    // Returns the messages of the next time.
    std::vector<std::pair<int, Json>> flush(int64_t laterMs) {
        nowNs_ += laterMs * kNsPerMs;
        std::vector<std::pair<int, Json>> sent;
        fan_.flush(nowNs_, [&sent](int viewer, Json message) { sent.emplace_back(viewer, std::move(message)); });
        return sent;
    }
    TopicFan fan_;
    int64_t nowNs_ = kNsPerS;
};

TEST_F(TopicFanTest, sendsTheNewestStatusAtEachInterval) {
    subscribe(1, "status", 100);
    subscribe(2, "status", 1000);
    fan_.offer(PageTopic::Status, {{"frames", 1}}, 0);
    EXPECT_EQ(flush(0).size(), 2U);
    fan_.offer(PageTopic::Status, {{"frames", 2}}, 0);
    fan_.offer(PageTopic::Status, {{"frames", 3}}, 0);
    const auto sent = flush(100);
    ASSERT_EQ(sent.size(), 1U);
    EXPECT_EQ(sent[0].first, 1);
    EXPECT_EQ(sent[0].second["data"]["frames"], 3);
    EXPECT_EQ(flush(900).size(), 1U); // viewer 2
}

TEST_F(TopicFanTest, newSubscribersGetTheLatestStatusAtOnce) {
    fan_.offer(PageTopic::Status, {{"frames", 1}}, 0);
    subscribe(1, "status", 1000);
    EXPECT_EQ(flush(0).size(), 1U);
}

TEST_F(TopicFanTest, gathersEntriesAndCountsLostOnes) {
    subscribe(1, "events", 100);
    fan_.offer(PageTopic::Events, Json::array({1, 2}), 5);
    fan_.offer(PageTopic::Events, Json::array({3}), 0);
    const auto sent = flush(0);
    ASSERT_EQ(sent.size(), 1U);
    EXPECT_EQ(sent[0].second["data"], Json::array({1, 2, 3}));
    EXPECT_EQ(sent[0].second["dropped"], 5);
    Json many = Json::array();
    for (int i = 0; i < 1000; ++i) many.push_back(i);
    fan_.offer(PageTopic::Events, many, 0);
    const auto later = flush(100);
    ASSERT_EQ(later.size(), 1U);
    EXPECT_EQ(later[0].second["data"].size(), TopicFan::kMaxEntries);
    EXPECT_EQ(later[0].second["dropped"], 1000 - TopicFan::kMaxEntries);
}

TEST_F(TopicFanTest, joinsFramesOfTheTimeline) {
    subscribe(1, "timeline", 250);
    fan_.offer(PageTopic::Timeline, {{"frames", {1, 2}}, {"next", 3}}, 0);
    fan_.offer(PageTopic::Timeline, {{"frames", {3}}, {"next", 4}}, 0);
    const auto sent = flush(0);
    ASSERT_EQ(sent.size(), 1U);
    EXPECT_EQ(sent[0].second["data"]["frames"], Json::array({1, 2, 3}));
    EXPECT_EQ(sent[0].second["data"]["next"], 4);
}

TEST_F(TopicFanTest, checksArguments) {
    for (const Json& wrong :
         {Json::object(), Json{{"topic", "weather"}}, Json{{"topic", 1}}, Json{{"topic", "log"}, {"interval", 10}},
          Json{{"topic", "log"}, {"interval", -1}}, Json{{"topic", "log"}, {"more", 1}}})
        EXPECT_FALSE(fan_.subscribe(1, wrong, 0).ok()) << wrong.dump();
    EXPECT_EQ(fan_.wantedIntervalMs(PageTopic::Log), 0);
}

TEST_F(TopicFanTest, knowsTheSmallestIntervalUntilNobodyListens) {
    subscribe(1, "log", 100);
    subscribe(2, "log", 300);
    EXPECT_EQ(fan_.wantedIntervalMs(PageTopic::Log), 100);
    fan_.forget(1);
    EXPECT_EQ(fan_.wantedIntervalMs(PageTopic::Log), 300);
    EXPECT_TRUE(fan_.unsubscribe(2, {{"topic", "log"}}).ok());
    EXPECT_EQ(fan_.wantedIntervalMs(PageTopic::Log), 0);
    fan_.offer(PageTopic::Log, Json::array({1}), 0);
    EXPECT_TRUE(flush(1000).empty());
}

} // namespace
} // namespace mural::page
