// Metrics: the syntax of Prometheus' text format 0.0.4, and values.
#include "tools/mural/stat/prometheus_text.hpp"

#include <gtest/gtest.h>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "tests/statistics/sample_frames.hpp"

namespace mural::cli {
namespace {

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TEST(PrometheusText, hasOneBlockWithHelpAndTypePerFamily) {
    SessionFrames other = sampleFrames();
    other.status["session"] = "mural-8";
    const std::regex sample(R"re(^(mural_[a-z_]+)\{([a-z]+="([^"\\\n]|\\.)*",?)+\} -?[0-9.e+-]+$)re");
    std::map<std::string, std::string> types;
    std::set<std::string> samples;
    std::string family;
    const std::string text = prometheusText({sampleFrames(), other});
    EXPECT_EQ(text.back(), '\n');
    for (const std::string& line : linesOf(text)) {
        std::istringstream words(line);
        std::string hash, keyword, name, type;
        words >> hash >> keyword >> name >> type;
        if (keyword == "HELP" && hash == "#") {
            EXPECT_TRUE(types.emplace(name, "").second) << "two blocks: " << name;
            family = name;
        } else if (keyword == "TYPE" && hash == "#") {
            EXPECT_EQ(name, family);
            EXPECT_TRUE(type == "counter" || type == "gauge") << line;
            types[name] = type;
        } else {
            std::smatch found;
            ASSERT_TRUE(std::regex_match(line, found, sample)) << line;
            EXPECT_EQ(found[1], family) << line;
            EXPECT_TRUE(samples.insert(line.substr(0, line.rfind(' '))).second) << "sample twice: " << line;
        }
    }
    for (const auto& [name, type] : types) {
        EXPECT_EQ(name.ends_with("_total"), type == "counter") << name;
    }
}

TEST(PrometheusText, hasTheValuesOfTheSession) {
    SessionFrames frames = sampleFrames();
    frames.outputs = {{"nodes", {{{"node", 1}, {"hash", nullptr}, {"ageSeconds", 2.5}}}}};
    const std::string text = prometheusText({frames});
    const std::string session = R"(session="mural-7-\"x\\")";
    for (const std::string& line :
         {"mural_frames_total{" + session + "} 40", "mural_frame_seconds{" + session + "} 0.01",
          "mural_program_wait_seconds_total{" + session + R"(,program="1",reason="frames"} 1.5)",
          "mural_node_up{" + session + R"(,node="0"} 1)", "mural_node_up{" + session + R"(,node="1"} 0)",
          "mural_node_clock_error_seconds{" + session + R"(,node="1"} 4e-05)",
          "mural_output_age_seconds{" + session + R"(,node="1"} 2.5)",
          "mural_stage_seconds{" + session + R"(,process="node",node="1",stage="replay"} 0.004)"})
        EXPECT_NE(text.find(line + "\n"), std::string::npos) << line << "\n" << text;
}

TEST(PrometheusText, isEmptyWithoutSessions) { EXPECT_EQ(prometheusText({}), ""); }

} // namespace
} // namespace mural::cli
