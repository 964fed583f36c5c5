// The timeline: valid JSON in the Chrome trace event format.
#include "common/json/json_text.hpp"
#include "tools/mural/stat/chrome_trace.hpp"

#include <gtest/gtest.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/statistics/sample_frames.hpp"

namespace mural::cli {
namespace {

using Json = nlohmann::json;

class ChromeTrace : public ::testing::Test {
protected:
    std::vector<Json> eventsOf(const std::string& phase) const {
        std::vector<Json> events;
        for (const Json& event : trace_["traceEvents"])
            if (event["ph"] == phase) events.push_back(event);
        return events;
    }

    static std::pair<int, int> threadOf(const Json& event) {
        return {event["pid"].get<int>(), event["tid"].get<int>()};
    }

    const Json trace_ = parseJson(jsonText(chromeTrace(sampleFrames())));
};

TEST_F(ChromeTrace, hasTheMembersThatItsFormatRequires) {
    ASSERT_TRUE(trace_["traceEvents"].is_array());
    const std::map<std::string, std::vector<const char*>> members = {{"X", {"name", "ts", "dur", "pid", "tid", "cat"}},
                                                                     {"M", {"name", "pid", "args"}},
                                                                     {"C", {"name", "ts", "pid", "args"}},
                                                                     {"i", {"name", "ts", "pid", "tid", "s"}},
                                                                     {"s", {"name", "ts", "pid", "tid", "id", "cat"}},
                                                                     {"f", {"name", "ts", "pid", "tid", "id", "bp"}}};
    for (const Json& event : trace_["traceEvents"]) {
        const auto wanted = members.find(event["ph"]);
        ASSERT_NE(wanted, members.end()) << event;
        for (const char* member : wanted->second) EXPECT_TRUE(event.contains(member)) << event;
        if (event.contains("ts")) {
            EXPECT_GE(event["ts"].get<double>(), 0);
        }
        if (event.contains("dur")) {
            EXPECT_GE(event["dur"].get<double>(), 0);
        }
    }
}

TEST_F(ChromeTrace, namesEveryProcessAndThread) {
    std::set<std::string> processes;
    std::set<std::pair<int, int>> named;
    for (const Json& event : eventsOf("M")) {
        if (event["name"] == "process_name") processes.insert(event["args"]["name"]);
        if (event["name"] == "thread_name") named.insert(threadOf(event));
    }
    EXPECT_EQ(processes, (std::set<std::string>{"head", "node 0", "node 1", "program 1"}));
    for (const Json& event : eventsOf("X")) EXPECT_TRUE(named.contains(threadOf(event))) << event;
}

TEST_F(ChromeTrace, hasASpanForEachSpanWithItsDuration) {
    size_t spans = 0;
    for (const FrameRecord& record : sampleFrames().frames)
        for (const SpanTrack& track : record.tracks) spans += track.spans.size();
    EXPECT_EQ(eventsOf("X").size(), spans);
    for (const Json& event : eventsOf("X")) {
        if (event["name"] == "capture") {
            EXPECT_DOUBLE_EQ(event["dur"].get<double>(), 1000);
        }
    }
}

// An arrow belongs to the span that encloses its end.
TEST_F(ChromeTrace, drawsArrowsBetweenSpans) {
    const auto isInSpan = [&](const Json& end) {
        for (const Json& span : eventsOf("X"))
            if (span["pid"] == end["pid"] && span["tid"] == end["tid"] && span["cat"] == "work" &&
                span["ts"].get<double>() <= end["ts"].get<double>() &&
                end["ts"].get<double>() <= span["ts"].get<double>() + span["dur"].get<double>())
                return true;
        return false;
    };
    const auto begins = eventsOf("s"), ends = eventsOf("f");
    ASSERT_EQ(begins.size(), 3u * 2 * 2); // per frame and node: from the program, and to the head
    ASSERT_EQ(ends.size(), begins.size());
    for (size_t i = 0; i < begins.size(); ++i) {
        EXPECT_EQ(begins[i]["id"], ends[i]["id"]);
        EXPECT_TRUE(isInSpan(begins[i])) << begins[i];
        EXPECT_TRUE(isInSpan(ends[i])) << ends[i];
    }
}

TEST_F(ChromeTrace, countsTheTimeOfEachFrame) {
    const auto counters = eventsOf("C");
    ASSERT_EQ(counters.size(), 2u);
    for (const Json& counter : counters) EXPECT_DOUBLE_EQ(counter["args"]["ms"].get<double>(), 10);
}

TEST_F(ChromeTrace, isValidWithoutFrames) {
    const Json empty = parseJson(jsonText(chromeTrace(SessionFrames{Json::object(), Json::array(), {}, 1})));
    EXPECT_TRUE(empty["traceEvents"].empty());
}

} // namespace
} // namespace mural::cli
