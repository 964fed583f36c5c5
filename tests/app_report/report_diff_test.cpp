// mural app-report --diff.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tools/mural/app_report/output/report_diff.hpp"

namespace mural::cli {
namespace {

using nlohmann::json;

json reportOf(const char* verdict, double framesPerSecond, double differing) {
    return {
        {"appReport", 1},
        {"verdict", verdict},
        {"recommended", "mural run"},
        {"sections",
         {{"speed", {{"facts", {{"native", {{"value", framesPerSecond}, {"text", std::to_string(framesPerSecond)}}}}}}},
          {"divisions",
           {{"facts",
             {{"tiles", {{"value", {{"differing", differing}, {"frames", differing + 5}}}, {"text", "pixels"}}}}}}},
          {"ends", {{"facts", {{"native", {{"value", framesPerSecond}, {"text", "1 s"}}}}}}}}}};
}

TEST(AppReportDiff, ignoresVaryingNumbers) {
    const auto lines = differencesOf(reportOf("works, exact", 60, 0), reportOf("works, exact", 57, 0));
    ASSERT_TRUE(lines.ok());
    EXPECT_TRUE(lines.value().empty()) << lines.value().front();
}

TEST(AppReportDiff, reportsEachChangedFact) {
    const auto lines = differencesOf(reportOf("works, exact", 60, 0), reportOf("works, with differences", 30, 4));
    ASSERT_TRUE(lines.ok());
    ASSERT_EQ(lines.value().size(), 3u);
    EXPECT_EQ(lines.value()[0], "divisions.tiles: pixels => pixels");
    EXPECT_EQ(lines.value()[1], "speed.native: 60.000000 => 30.000000 (-50 %)");
    EXPECT_EQ(lines.value()[2], "verdict: works, exact => works, with differences");
}

TEST(AppReportDiff, reportsFactsOfOneReportOnly) {
    json second = reportOf("works, exact", 60, 0);
    second["sections"].erase("speed");
    const auto lines = differencesOf(reportOf("works, exact", 60, 0), second);
    ASSERT_EQ(lines.value().size(), 1u);
    EXPECT_NE(lines.value()[0].find("=> absent"), std::string::npos);
}

TEST(AppReportDiff, refusesOtherFiles) {
    EXPECT_FALSE(differencesOf(json::object(), reportOf("", 1, 0)).ok());
    EXPECT_FALSE(differencesOf(reportOf("", 1, 0), json::array()).ok());
}

TEST(AppReportDiff, survivesMistypedFields) {
    json odd = {{"appReport", 1}, {"verdict", 3}, {"sections", {{"a", {{"facts", {{"b", 1}}}}}, {"c", 2}}}};
    EXPECT_TRUE(differencesOf(odd, odd).ok());
}

} // namespace
} // namespace mural::cli
