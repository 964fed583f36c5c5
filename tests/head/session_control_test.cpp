// The control interface of a complete head: its operations, events, and documentation.
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>

#include "common/log/log.hpp"
#include "tests/head/support/controlled_session.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

TEST(SessionControl, introducesTheSession) {
    ControlledSession head(1);
    head.open();
    EXPECT_EQ(head.hello["session"], head.config.session);
    EXPECT_EQ(head.hello["headPid"], getpid());
    head.finish();
    EXPECT_EQ(head.line(), Json()); // the connection ends with the session
}

TEST(SessionControl, repliesWithStatusReportAndNodes) {
    ControlledSession head(2);
    head.open();
    const Json status = head.request("status");
    EXPECT_EQ(status["result"]["nodes"].size(), 2U) << status;
    EXPECT_EQ(head.request("nodes")["result"]["nodes"][1]["state"], "alive");
    const Json report = head.request("report");
    EXPECT_EQ(report["result"]["nodes"].size(), 2U) << report;
    EXPECT_EQ(head.request("stat")["code"], "unknown-operation");
    EXPECT_EQ(head.request("equalizers")["result"]["equalizers"], Json()) << "the session has none";
    const Json set = head.request("equalizer-freeze", {{"name", "none"}, {"frozen", true}});
    EXPECT_NE(set.value("error", std::string()).find("no equalizers"), std::string::npos) << set;
    head.finish();
}

TEST(SessionControl, repliesWithTheStatisticsOfFrames) {
    ControlledSession head(2);
    head.open();
    const Json reply = head.request("frames", {{"since", 3}});
    EXPECT_EQ(reply["result"]["frames"], Json::array()) << reply;
    EXPECT_EQ(reply["result"]["next"], 3) << reply;
    EXPECT_EQ(reply["result"]["status"]["nodes"].size(), 2U) << reply;
    EXPECT_EQ(head.request("frames")["result"]["next"], 1);
    EXPECT_EQ(head.request("frames", {{"since", -1}})["code"], "failed");
    EXPECT_EQ(head.request("frames", {{"since", "3"}})["code"], "bad-argument");
    head.finish();
}

TEST(SessionControl, changesLogLevels) {
    const log::Levels before = log::currentLevels();
    ControlledSession head(1);
    head.open();
    EXPECT_EQ(head.request("log-level")["result"]["levels"]["rsp"], "info");
    EXPECT_EQ(head.request("log-level", {{"levels", "rsp:debug"}})["result"]["levels"]["rsp"], "debug");
    EXPECT_TRUE(log::enabled(log::Topic::Rsp, log::Level::Debug));
    EXPECT_EQ(head.request("log-level", {{"levels", "rsp:loud"}})["code"], "failed");
    head.finish();
    log::setLevels(before);
}

TEST(SessionControl, requestsTheEndFromTheRun) {
    ControlledSession head(1);
    head.open();
    EXPECT_EQ(head.request("stop")["ok"], true);
    head.waitFor("stop-requested");
    head.finish();
    EXPECT_EQ(head.status(), 0);
}

TEST(SessionControl, removesANodeWhoseTilesOthersTake) {
    ControlledSession head(3);
    head.config.tileWidth = head.config.tileHeight = 16;
    head.open();
    EXPECT_EQ(head.request("subscribe", {{"topic", "events"}, {"interval", 20}})["ok"], true);
    EXPECT_EQ(head.request("remove-node", {{"node", 1}})["ok"], true);
    EXPECT_EQ(head.event("node-lost")["node"], 1);
    const Json nodes = head.request("nodes")["result"]["nodes"];
    EXPECT_EQ(nodes[1]["state"], "lost");
    EXPECT_EQ(nodes[2]["state"], "alive");
    head.finish();
}

TEST(SessionControl, keepsANodeWhosePartNoOtherTakes) {
    ControlledSession head(2);
    head.open();
    const Json refused = head.request("remove-node", {{"node", 1}});
    EXPECT_EQ(refused["code"], "failed");
    EXPECT_NE(refused["error"].get<std::string>().find("force"), std::string::npos) << refused;
    EXPECT_EQ(head.request("remove-node", {{"node", 2}})["code"], "failed");
    EXPECT_EQ(head.request("remove-node", {{"node", -1}})["code"], "failed");
    EXPECT_EQ(head.request("nodes")["result"]["nodes"][1]["state"], "alive");
    EXPECT_EQ(head.request("remove-node", {{"node", 1}, {"force", true}})["ok"], true);
    head.waitForMessage("an operator removes it");
    const Json last = head.request("remove-node", {{"node", 0}, {"force", true}});
    EXPECT_EQ(last["code"], "failed") << last;
    head.finish();
}

TEST(SessionControl, restartsOnlyNodesThatCanReturn) {
    ControlledSession head(2);
    head.open();
    const Json refused = head.request("restart-node", {{"node", 1}});
    EXPECT_EQ(refused["code"], "failed"); // the fake nodes of this test cannot be started again
    EXPECT_NE(refused["error"].get<std::string>().find("--restart-nodes"), std::string::npos) << refused;
    head.finish();
}

TEST(SessionControl, documentsEveryOperation) {
    ControlledSession head(1);
    head.open();
    std::ifstream file(std::string(MURAL_SOURCE_DIR) + "/docs/reference/control.md");
    const std::string page{std::istreambuf_iterator<char>(file), {}};
    const Json operations = head.request("help")["result"]["operations"];
    EXPECT_GE(operations.size(), 10U);
    for (const Json& operation : operations) {
        EXPECT_NE(page.find("`" + operation["name"].get<std::string>() + "`"), std::string::npos) << operation;
        EXPECT_NE(page.find("`" + operation["usage"].get<std::string>() + "`"), std::string::npos) << operation;
    }
    head.finish();
}

TEST(SessionControl, changesEqualizers) {
    ControlledSession head(2);
    head.config.balance = balance::Balance::Load;
    head.open();
    const Json reply = head.request("equalizers");
    const Json listed = reply["result"]["equalizers"];
    EXPECT_EQ(listed.size(), 1u) << reply;
    EXPECT_EQ(listed[0]["kind"], "load_equalizer");
    EXPECT_EQ(listed[0]["parameters"]["damping"], "0.5");
    const std::string name = listed[0]["name"];
    EXPECT_EQ(head.request("equalizer-set", {{"name", name}, {"parameter", "damping"}, {"value", .25}})["ok"], true);
    EXPECT_EQ(head.request("equalizer-freeze", {{"name", name}, {"frozen", true}})["ok"], true);
    const Json changed = head.request("equalizers")["result"]["equalizers"];
    EXPECT_EQ(changed[0]["parameters"]["damping"], "0.25");
    EXPECT_EQ(changed[0]["frozen"], true);
    EXPECT_EQ(head.request("equalizer-set", {{"name", name}, {"parameter", "damping"}, {"value", 7}})["ok"], false);
    EXPECT_EQ(head.request("equalizer-set", {{"name", name}, {"parameter", "taste"}, {"value", 1}})["ok"], false);
    EXPECT_EQ(head.request("equalizer-freeze", {{"name", "none"}, {"frozen", true}})["ok"], false);
    head.finish();
}

} // namespace
} // namespace mural
