// The protocol of one control client, without sockets: half messages, bad messages, limits, subscriptions.
#include "common/json/json_text.hpp"
#include "nodes/head/control/control_protocol.hpp"

#include <gtest/gtest.h>

#include "common/base/clock.hpp"
#include "nodes/head/control/control_feed.hpp"
#include "nodes/head/control/control_request.hpp"
#include "tests/control/sample_operations.hpp"
#include "tests/sanitized.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

constexpr size_t kMany = 1000;

class ControlProtocolTest : public ::testing::Test {
protected:
    ControlProtocolTest() : client(operations, {{"session", "mural-1-0"}}) { hello = takeLines(client).at(0); }

    std::vector<Json> send(const std::string& bytes, int64_t nowNs = 0) {
        client.receive(bytes);
        client.perform(kMany, nowNs);
        return takeLines(client);
    }
    Json reply(const std::string& line) {
        const auto lines = send(line + "\n");
        EXPECT_EQ(lines.size(), 1U) << line;
        return lines.empty() ? Json() : lines[0];
    }

    ControlOperations operations = sampleOperations();
    ControlProtocol client;
    Json hello;
};

TEST_F(ControlProtocolTest, beginsWithAHello) {
    EXPECT_EQ(hello, parseJson(R"({"hello":{"protocol":1,"session":"mural-1-0"}})"));
}

TEST_F(ControlProtocolTest, repliesWithTheIdOfTheRequest) {
    EXPECT_EQ(reply(R"({"id":41,"op":"status"})"), parseJson(R"({"id":41,"ok":true,"result":{"frames":7}})"));
    EXPECT_EQ(reply(R"({"id":-1,"op":"echo","args":{"text":"ä"}})")["result"]["text"], "ä");
    EXPECT_EQ(reply(R"({"id":3,"op":"restart-node","args":{"node":2}})"),
              parseJson(R"({"id":3,"ok":false,"code":"failed",
                              "error":"the session has no node 2; its nodes are 0 to 1"})"));
}

TEST_F(ControlProtocolTest, assemblesHalfMessages) {
    const std::string line = "{\"id\":1,\"op\":\"status\"}\r\n";
    for (size_t i = 0; i + 1 < line.size(); ++i) EXPECT_TRUE(send(line.substr(i, 1)).empty());
    EXPECT_EQ(send("\n").size(), 1U);
    EXPECT_EQ(send(line + "\n  \n" + line + line.substr(0, 5)).size(), 2U); // empty lines have no reply
    EXPECT_EQ(send(line.substr(5)).size(), 1U);
}

TEST_F(ControlProtocolTest, rejectsWrongTypes) {
    for (const char* line :
         {"x", "1", "null", "\"status\"", "[]", "{}", R"({"id":1})", R"({"op":"status"})",
          R"({"id":"1","op":"status"})", R"({"id":1.5,"op":"status"})", R"({"id":1,"op":7})",
          R"({"id":1,"op":"status","more":0})", R"({"id":1,"op":"status"} {"id":2,"op":"status"})",
          R"({"id":1,"op":"status")", "{\"id\":1,\"op\":\"st\xff\"}", "{\"id\":1,\"op\":\"a\tb\"}"}) {
        const Json answer = reply(line);
        EXPECT_EQ(answer["ok"], false) << line;
        EXPECT_EQ(answer["code"], "bad-request") << line;
        EXPECT_EQ(answer["error"].get<std::string>().find('\n'), std::string::npos);
    }
    EXPECT_EQ(reply(R"({"id":9,"op":7})")["id"], 9);
    EXPECT_EQ(reply("x")["id"], Json());
    EXPECT_EQ(reply(R"({"id":1,"op":"status","args":7})")["code"], "bad-argument");
    EXPECT_EQ(reply(R"({"id":1,"op":"status"})")["ok"], true); // the connection continues
}

TEST_F(ControlProtocolTest, namesNearOperations) {
    const std::string error = reply(R"({"id":1,"op":"subscrib"})")["error"];
    EXPECT_NE(error.find("subscribe"), std::string::npos) << error;
}

TEST_F(ControlProtocolTest, listsAllOperations) {
    const Json help = reply(R"({"id":1,"op":"help"})");
    std::vector<std::string> names;
    for (const Json& operation : help["result"]["operations"]) names.push_back(operation["name"]);
    EXPECT_EQ(names, (std::vector<std::string>{"echo", "restart-node", "status", "help", "subscribe", "unsubscribe"}));
}

TEST_F(ControlProtocolTest, acceptsLongRequestsUpToTheLimit) {
    const std::string before = R"({"id":1,"op":"echo","args":{"text":")", after = R"("}})";
    const size_t room = kMaxControlRequestBytes - before.size() - after.size();
    EXPECT_EQ(reply(before + std::string(room, 'x') + after)["ok"], true);
    EXPECT_FALSE(client.isOver());
    const Json answer = reply(before + std::string(room + 1, 'x') + after);
    EXPECT_EQ(answer["code"], "limit");
    EXPECT_TRUE(client.isOver());
}

TEST_F(ControlProtocolTest, endsWithAnEndlessLine) {
    size_t received = 0;
    while (client.acceptsBytes() && received < 10 * kMaxControlRequestBytes) {
        client.receive(std::string(4096, '['));
        received += 4096;
    }
    EXPECT_LE(received, kMaxControlRequestBytes + 4096);
    client.perform(1, 0);
    EXPECT_TRUE(client.isOver());
    EXPECT_EQ(takeLines(client).at(0)["code"], "limit");
    EXPECT_TRUE(send("{\"id\":1,\"op\":\"status\"}\n").empty());
}

TEST_F(ControlProtocolTest, rejectsDeepValues) {
    const std::string deep(30'000, '[');
    EXPECT_EQ(reply("{\"id\":1,\"op\":\"echo\",\"args\":" + deep)["code"], "bad-request");
    EXPECT_EQ(reply(R"({"id":1,"op":"echo","args":{"text":"[[[[[[[[[[[[[[[[[[[[[[[["}})")["ok"], true);
    EXPECT_EQ(reply(R"({"id":1,"op":"echo","args":{"text":"\"[[[[[[[[[[[[[[[[[[[["}})")["ok"], true);
}

TEST_F(ControlProtocolTest, performsALimitedNumberPerCall) {
    std::string lines;
    for (int i = 0; i < 10; ++i) lines += "{\"id\":" + std::to_string(i) + ",\"op\":\"status\"}\n";
    client.receive(lines);
    client.perform(3, 0);
    EXPECT_EQ(takeLines(client).size(), 3U);
    EXPECT_TRUE(client.hasRequest());
    client.perform(kMany, 0);
    EXPECT_EQ(takeLines(client).back()["id"], 9);
    EXPECT_FALSE(client.hasRequest());
}

TEST_F(ControlProtocolTest, performsManyRequests) {
    constexpr int kRequests =
        mural::testing::kSanitized ? 20'000 : 200'000; // 1 000 000 take five times as long, and pass
    const std::string line = "{\"id\":1,\"op\":\"echo\"}\n";
    int replies = 0;
    size_t largestUnsent = 0;
    for (int sent = 0; replies < kRequests;) {
        for (; client.acceptsBytes() && sent < kRequests; ++sent) client.receive(line);
        while (client.hasRequest()) client.perform(64, 0);
        const std::string_view unsent = client.unsent();
        largestUnsent = std::max(largestUnsent, unsent.size());
        replies += static_cast<int>(std::ranges::count(unsent, '\n'));
        client.sent(unsent.size());
    }
    EXPECT_EQ(replies, kRequests);
    EXPECT_LE(largestUnsent, kMaxControlUnsentBytes + 1024);
}

TEST_F(ControlProtocolTest, stopsWhileTheClientReadsNothing) {
    const std::string line = "{\"id\":1,\"op\":\"help\"}\n";
    size_t received = 0;
    while (client.acceptsBytes()) {
        client.receive(line);
        received += line.size();
        client.perform(kMany, 0);
        ASSERT_LT(received, size_t{10} << 20);
    }
    EXPECT_LT(client.unsent().size(), kMaxControlUnsentBytes + 4096);
    EXPECT_FALSE(client.hasRequest());
    takeLines(client); // the client reads again
    EXPECT_TRUE(client.acceptsBytes());
    EXPECT_EQ(reply(R"({"id":1,"op":"status"})")["ok"], true);
}

TEST_F(ControlProtocolTest, sendsTheStatusAtTheInterval) {
    EXPECT_EQ(client.nextMessageNs(), INT64_MAX);
    const auto lines = send("{\"id\":1,\"op\":\"subscribe\",\"args\":{\"topic\":\"status\",\"interval\":250}}\n", 5);
    EXPECT_EQ(lines.at(0)["result"], parseJson(R"({"topic":"status","interval":250})"));
    EXPECT_EQ(client.nextMessageNs(), 5);
    client.sendMessages(5);
    EXPECT_EQ(takeLines(client).at(0), parseJson(R"({"topic":"status","dropped":0,"data":{"frames":7}})"));
    EXPECT_EQ(client.nextMessageNs(), 5 + 250 * kNsPerMs);
    client.sendMessages(6);
    EXPECT_TRUE(takeLines(client).empty());
    client.sendMessages(5 + 250 * kNsPerMs);
    EXPECT_EQ(takeLines(client).size(), 1U);
    send("{\"id\":2,\"op\":\"unsubscribe\",\"args\":{\"topic\":\"status\"}}\n");
    EXPECT_EQ(client.nextMessageNs(), INT64_MAX);
}

TEST_F(ControlProtocolTest, gathersEntriesBetweenMessages) {
    client.offer(ControlTopic::Events, "1"); // no subscription yet
    send("{\"id\":1,\"op\":\"subscribe\",\"args\":{\"topic\":\"events\"}}\n");
    EXPECT_EQ(client.nextMessageNs(), INT64_MAX);
    client.offer(ControlTopic::Events, R"({"event":"clients"})");
    client.offer(ControlTopic::Log, R"({"text":"a"})");
    client.sendMessages(0);
    client.offer(ControlTopic::Events, "3");
    client.sendMessages(1);
    EXPECT_EQ(takeLines(client),
              std::vector<Json>{parseJson(R"({"topic":"events","dropped":0,"data":[{"event":"clients"}]})")});
    client.sendMessages(kNsPerS);
    EXPECT_EQ(takeLines(client).at(0)["data"], Json({3}));
}

TEST_F(ControlProtocolTest, countsDroppedEntries) {
    send("{\"id\":1,\"op\":\"subscribe\",\"args\":{\"topic\":\"log\"}}\n");
    for (size_t i = 0; i < kMaxControlWaitingEntries + 5; ++i) client.offer(ControlTopic::Log, "1");
    client.countDropped(ControlTopic::Log, 2);
    client.sendMessages(0);
    const Json message = takeLines(client).at(0);
    EXPECT_EQ(message["dropped"], 7);
    EXPECT_EQ(message["data"].size(), kMaxControlWaitingEntries);
}

TEST_F(ControlProtocolTest, dropsMessagesWhileTheClientReadsNothing) {
    send("{\"id\":1,\"op\":\"subscribe\",\"args\":{\"topic\":\"log\",\"interval\":20}}\n");
    send("{\"id\":1,\"op\":\"subscribe\",\"args\":{\"topic\":\"status\",\"interval\":20}}\n");
    const std::string entry = jsonText(Json(std::string(2000, 'x')));
    for (int64_t i = 0; i < 5000; ++i) {
        client.offer(ControlTopic::Log, entry);
        client.sendMessages(i * kNsPerS);
    }
    EXPECT_LT(client.unsent().size(), kMaxControlUnsentBytes * 3 / 4);
    takeLines(client);
    client.sendMessages(6000 * kNsPerS);
    for (const Json& message : takeLines(client)) EXPECT_GT(message["dropped"], 0) << message["topic"];
}

TEST_F(ControlProtocolTest, rejectsOtherTopicsAndIntervals) {
    for (const char* args : {R"({"topic":"frames"})", R"({"topic":"log","interval":0})",
                             R"({"topic":"log","interval":99999999999})", R"({"topic":"log","interval":-5})"})
        EXPECT_EQ(reply(std::string(R"({"id":1,"op":"subscribe","args":)") + args + "}")["code"], "failed") << args;
    EXPECT_EQ(reply(R"({"id":1,"op":"subscribe"})")["code"], "bad-argument");
}

TEST(ControlFeed, publishesOnlyWantedTopics) {
    ControlFeed feed;
    feed.publish(ControlTopic::Log, {{"text", "early"}});
    feed.setWanted(ControlTopic::Log, true);
    feed.publish(ControlTopic::Log, {{"text", "bad \xff"}});
    feed.publish(ControlTopic::Events, {{"event", "frame"}});
    const ControlFeed::Batch batch = feed.take();
    ASSERT_EQ(batch.entries.size(), 1U);
    EXPECT_TRUE(Json::accept(batch.entries[0].json));
    for (int i = 0; i < 2000; ++i) feed.publish(ControlTopic::Log, 1);
    const ControlFeed::Batch full = feed.take();
    EXPECT_EQ(full.entries.size() + full.dropped[indexOf(ControlTopic::Log)], 2000U);
    EXPECT_GT(full.dropped[indexOf(ControlTopic::Log)], 0U);
}

} // namespace
} // namespace mural
