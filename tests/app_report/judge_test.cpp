// Verdicts, reasons and recommendations of mural app-report.
#include <gtest/gtest.h>

#include "tools/mural/app_report/division_facts.hpp"
#include "tools/mural/app_report/judge.hpp"
#include "tools/mural/app_report/round_trip_advice.hpp"
#include "tools/mural/app_report/traffic_facts.hpp"

namespace mural::cli {
namespace {

using nlohmann::json;

AppRun runOf(const char* name, json report) {
    AppRun run;
    run.name = name;
    run.report = std::move(report);
    run.outcome.endedItself = false;
    return run;
}

// A program that works: each run was ended after its time.
AppMeasured works() {
    AppMeasured m;
    m.program = {"app", "a b"};
    m.seconds = 5;
    m.native = runOf("native", {{"frames", 300}, {"framesPerSecond", 60.0}});
    m.tiles = runOf("tiles", {{"frames", 100},
                              {"verifiedFrames", 100},
                              {"verifiedPixels", 1000},
                              {"differingPixels", 0},
                              {"bytesPerFrame", 50},
                              {"roundTripsBy", {{"--verify", 200}, {"glReadPixels", 100}}},
                              {"delta", {{"programBytes", 100000.0}}}});
    m.balance = runOf("balance", {{"frames", 200}, {"framesPerSecond", 40.0}, {"limits", json::array()}});
    m.db = runOf("db", {{"frames", 50}, {"verifiedPixels", 1000}, {"sharedDraws", {{"frames", 100}, {"shared", 75}}}});
    return m;
}

const Fact* factOf(const Section& section, const std::string& key) {
    for (const Fact& fact : section.facts)
        if (fact.key == key) return &fact;
    return nullptr;
}

TEST(AppReportJudge, isExactWithoutDifferingPixels) {
    const AppMeasured m = works();
    EXPECT_EQ(judge(m).verdict, Verdict::Exact);
    EXPECT_EQ(recommendedCommand(m, Verdict::Exact),
              "mural run --balance auto --nodes HOST1,HOST2 --display windows -- app 'a b'");
}

TEST(AppReportJudge, reportsDifferingPixels) {
    AppMeasured m = works();
    m.tiles.report["differingPixels"] = 7;
    m.tiles.report["largestDifference"] = 3;
    const Judgement j = judge(m);
    EXPECT_EQ(j.verdict, Verdict::Differences);
    EXPECT_EQ(j.sentence, "7 of 1000 pixels in 100 frames differ, largest difference 3 of 255");
}

TEST(AppReportJudge, isNotExactWithoutAComparison) {
    AppMeasured m = works();
    m.tiles.report["verifiedPixels"] = 0;
    m.tiles.report["uncomparedFrames"] = 100;
    m.tiles.report["uncomparedFramesBy"] = {{"front buffer", 100}};
    const Judgement j = judge(m);
    EXPECT_EQ(j.verdict, Verdict::Differences);
    EXPECT_NE(j.sentence.find("front buffer 100"), std::string::npos) << j.sentence;
}

TEST(AppReportJudge, reportsACrashOnMuralOnly) {
    AppMeasured m = works();
    m.tiles.outcome.endedItself = true;
    m.tiles.outcome.exitStatus = 139;
    const Judgement j = judge(m);
    EXPECT_EQ(j.verdict, Verdict::Differences);
    EXPECT_EQ(j.sentence, "it ends with signal 11 on Mural, but not without it");
}

TEST(AppReportJudge, runsAloneIfItsDrawingBypassesMural) {
    AppMeasured m = works();
    m.tiles.report = {{"frames", 0}, {"bypass", {"app seems to draw with Vulkan"}}, {"noFrame", ""}};
    const Judgement j = judge(m);
    EXPECT_EQ(j.verdict, Verdict::Alone);
    EXPECT_EQ(j.sentence, "app seems to draw with Vulkan");
    EXPECT_EQ(recommendedCommand(m, j.verdict), "");
    EXPECT_EQ(exitStatusOf(j.verdict), 2);
}

TEST(AppReportJudge, namesTheEndOfAProgramThatFailsNatively) {
    AppMeasured m = works();
    m.native.report = nullptr;
    m.native.outcome.endedItself = true;
    m.native.outcome.exitStatus = 1;
    m.native.outcome.lastWords = {"cannot connect to server"};
    m.tiles.report = {{"frames", 0}, {"noFrame", "app ended"}};
    const Judgement j = judge(m);
    EXPECT_EQ(j.verdict, Verdict::NotCapturable);
    EXPECT_EQ(j.sentence,
              "it fails without Mural too (exit status 1) before a picture; it printed: cannot connect to server");
}

TEST(AppReportJudge, namesAProgramThatShowsNothing) {
    AppMeasured m = works();
    m.native.report = nullptr;
    m.tiles.report = {{"frames", 0}, {"noFrame", "app made no GL calls"}};
    m.seen.inetSockets = 1;
    const Judgement j = judge(m);
    EXPECT_EQ(j.verdict, Verdict::NotCapturable);
    EXPECT_NE(j.sentence.find("no picture through GL within 5 s, and has IP sockets"), std::string::npos) << j.sentence;
}

TEST(AppReportJudge, refusesWhatCannotBeStarted) {
    AppMeasured m = works();
    m.refused = "app was not found in PATH";
    EXPECT_EQ(judge(m).sentence, m.refused);
    EXPECT_EQ(judge(m).verdict, Verdict::NotCapturable);
}

TEST(AppReportJudge, keepsTilesThatCannotMove) {
    AppMeasured m = works();
    m.balance.report["limits"] = json::array({{{"code", "areas-stay"}, {"text", "frames do not clear"}}});
    EXPECT_FALSE(tilesMove(m));
    EXPECT_EQ(recommendedCommand(m, Verdict::Exact).find("mural run --tiles 2x2"), 0u);
    const Section s = divisionFacts(m);
    ASSERT_NE(factOf(s, "tilesMove"), nullptr);
    EXPECT_EQ(factOf(s, "tilesMove")->text, "no: frames do not clear");
}

TEST(AppReportJudge, knowsNothingAboutMovesAfterFewFrames) {
    AppMeasured m = works();
    m.balance.report["frames"] = 3;
    EXPECT_FALSE(tilesMove(m));
    EXPECT_TRUE(factOf(divisionFacts(m), "tilesMove")->value.is_null());
}

TEST(AppReportJudge, reportsTheShareOfSharedDraws) {
    AppMeasured m = works();
    EXPECT_DOUBLE_EQ(sharedPart(m), 0.75);
    m.db.report["sharedDraws"]["shared"] = 0;
    m.db.report["limits"] = json::array({{{"code", "draws-unshared"}, {"text", "no draws"}}});
    EXPECT_EQ(factOf(divisionFacts(m), "sharedDraws")->text, "no: no draws");
    m.db.report = nullptr;
    EXPECT_DOUBLE_EQ(sharedPart(m), -1);
}

TEST(AppReportJudge, countsNoRoundTripsOfTheComparison) {
    const AppMeasured m = works();
    EXPECT_DOUBLE_EQ(roundTripsPerFrame(m), 1);
    const Section s = roundTripFacts(m);
    EXPECT_EQ(s.facts.size(), 2u);
    EXPECT_NE(factOf(s, "by.glReadPixels")->advice.find("pixel pack buffer"), std::string::npos);
}

TEST(AppReportJudge, estimatesTheLimitOfALink) {
    const Section s = speedFacts(works());
    ASSERT_NE(factOf(s, "limitOf1Gbit"), nullptr);
    EXPECT_NEAR(factOf(s, "limitOf1Gbit")->value.get<double>(), 1e9 / 8 * 0.9 / 50, 1);
    EXPECT_NEAR(factOf(s, "limitOfRoundTrips")->value.get<double>(), 5000, 1);
}

TEST(AppReportJudge, makesAReportOfRunsThatWereNotPerformed) {
    AppMeasured m;
    m.program = {"app"};
    m.refused = "app is a setuid program";
    for (AppRun* run : {&m.native, &m.tiles, &m.balance, &m.db}) run->skipped = "the program cannot be started";
    const AppReport report = makeReport(m);
    EXPECT_EQ(report.verdict, Verdict::NotCapturable);
    EXPECT_EQ(report.runs.size(), 4u);
    for (const Section& section : report.sections)
        EXPECT_TRUE(section.key == "ends" || section.key == "speed") << section.key;
}

TEST(AppReportAdvice, coversCommandsWithRoundTrips) {
    for (const char* command : {"glReadPixels", "glGetQueryObjectuiv", "glFinish", "glMapBufferRange", "glGetTexImage"})
        EXPECT_FALSE(roundTripAdvice(command).empty()) << command;
    EXPECT_TRUE(roundTripAdvice("others").empty());
}

} // namespace
} // namespace mural::cli
