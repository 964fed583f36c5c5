// Rates of mural stat from two states of a session.
#include "common/json/json_text.hpp"
#include "tools/mural/stat/session_rates.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tools/mural/stat/running_sessions.hpp"

namespace mural::cli {
namespace {

using Json = nlohmann::json;

Json stateAt(double atSeconds, int frames, int calls, int bytes, int trips, double framesWait) {
    return {{"session", "mural-7-0123456789abcdef"},
            {"runPid", 7},
            {"headPid", 8},
            {"atSeconds", atSeconds},
            {"tiles", "2x1"},
            {"display", "app"},
            {"latency", 1},
            {"frames", frames},
            {"programs",
             {{{"client", 1},
               {"pid", 9},
               {"command", "glxgears -info"},
               {"frames", frames},
               {"calls", calls},
               {"bytes", bytes},
               {"roundTrips", trips},
               {"roundTripsBy", {{"glReadPixels", trips}}},
               {"waitSeconds", {{"frames", framesWait}, {"space", 0.0}}},
               {"waitingFor", "frames"},
               {"waitsForNodes", {1, 3}}}}},
            {"nodes",
             {{{"node", 0},
               {"where", "local"},
               {"pid", 10},
               {"gl", "llvmpipe"},
               {"state", "alive"},
               {"silentSeconds", 0.1},
               {"frames", frames},
               {"replaySeconds", atSeconds / 4},
               {"readbackSeconds", 0.0}},
              {{"node", 1},
               {"where", "wall2"},
               {"stream", "multicast"},
               {"pid", 11},
               {"gl", "llvmpipe"},
               {"state", "lost"},
               {"frames", 3}}}}};
}

TEST(SessionRates, areDifferencesOfTwoStates) {
    const auto both = withRates({stateAt(10, 100, 1000, 5000, 4, 1.0)}, {stateAt(12, 150, 2000, 105000, 29, 2.5)});
    const Json& recent = both[0]["programs"][0]["recent"];
    EXPECT_DOUBLE_EQ(recent["framesPerSecond"].get<double>(), 25);
    EXPECT_DOUBLE_EQ(recent["callsPerFrame"].get<double>(), 20);
    EXPECT_DOUBLE_EQ(recent["bytesPerFrame"].get<double>(), 2000);
    EXPECT_DOUBLE_EQ(recent["roundTripsPerFrame"].get<double>(), 0.5);
    EXPECT_DOUBLE_EQ(recent["waitShares"]["frames"].get<double>(), 0.75);
    EXPECT_DOUBLE_EQ(both[0]["nodes"][0]["recent"]["busyShare"].get<double>(), 0.25);
    EXPECT_EQ(statLines(both[0]),
              (std::vector<std::string>{"session 7  2x1 tiles, display app, latency 1, 150 frames on the wall; head 8",
                                        "  program 9  glxgears -info",
                                        "    150 frames, 25.0 frames/s, 20 calls and 2.0 kB per frame",
                                        "    0.50 round trips per frame, 29 in all: glReadPixels 29",
                                        "    waits 75 % of the time for the nodes to finish frames, now for node 1, 3",
                                        "  node 0  local, pid 10, llvmpipe: 150 frames, busy 25 %",
                                        "  node 1  wall2, by multicast, pid 11, llvmpipe: lost"}));
}

TEST(SessionRates, includeDeltaCoding) {
    const auto with = [](Json session, int frames) {
        session["delta"] = {
            {"records", 100 * frames},      {"rawBytes", 5000 * frames},      {"stagedBytes", 300 * frames},
            {"wireBytes", 120 * frames},    {"pageHits", 9 * frames},         {"newPages", frames},
            {"patches", 2 * frames},        {"encodeSeconds", 3e-5 * frames}, {"programBytes", 9000 * frames},
            {"deferredRecords", 4},         {"deferredBytes", 2000},          {"droppedRecords", 2 * frames},
            {"droppedBytes", 4000 * frames}};
        return session;
    };
    const auto both = withRates({with(stateAt(10, 100, 1000, 5000, 4, 1.0), 100)},
                                {with(stateAt(12, 150, 2000, 105000, 29, 2.5), 150)});
    EXPECT_DOUBLE_EQ(both[0]["delta"]["recent"]["wireBytesPerFrame"].get<double>(), 120);
    EXPECT_EQ(statLines(both[0])[5], "  delta    5.0 kB per frame, 300 B of it new to the nodes, 120 B compressed; 9.0 "
                                     "of 10.0 pages per frame cached, encoding 30 us");
    EXPECT_EQ(statLines(both[0])[6],
              "  filter   9.0 kB per frame, 4.0 kB of it dropped (2.0 records); 2.0 kB deferred now");
}

TEST(SessionRates, includeTransferredPictures) {
    auto session = stateAt(10, 100, 1000, 5000, 4, 1.0);
    session["nodes"][0]["pictureRawBytes"] = 300000.0;
    session["nodes"][0]["pictureBytes"] = 2000.0;
    const auto lines = statLines(withRates({}, {session})[0]);
    EXPECT_TRUE(std::ranges::any_of(lines, [](const std::string& line) {
        return line.find("100 frames, pictures of 3.0 kB compressed to 20 B per frame") != std::string::npos;
    })) << lines.back();
}

TEST(SessionRates, includeEqualizers) {
    auto session = stateAt(10, 100, 1000, 5000, 4, 1.0);
    session["equalizers"] = {{{"name", "wall.load"},
                              {"kind", "load_equalizer"},
                              {"divides", "picture"},
                              {"frozen", false},
                              {"decision", "cuts moved towards equal times"},
                              {"frames", 8},
                              {"moves", 2},
                              {"efficiency", .9},
                              {"nodes", {{{"node", 0}, {"part", .2}}, {{"node", 1}, {"part", .8}}}}}};
    session["equalizers"].push_back(session["equalizers"][0]);
    session["equalizers"][1]["name"] = "draws";
    session["equalizers"][1]["divides"] = "draws";
    session["equalizers"][1]["frozen"] = true;
    const auto lines = statLines(withRates({}, {session})[0]);
    EXPECT_NE(std::ranges::find(lines,
                                "  equalizer \"wall.load\"  picture: node 0 20 %, node 1 80 %; moved after 2 of 8 "
                                "frames; busy 90 % of the longest time; cuts moved towards equal times"),
              lines.end());
    EXPECT_NE(std::ranges::find(lines, "  equalizer \"draws\"  draws: node 0 20 %, node 1 80 %; moved after 2 of 8 "
                                       "frames; busy 90 % of the longest time; frozen"),
              lines.end());
}

TEST(SessionRates, areOmittedForIdleAndNewEntries) {
    const auto still = withRates({stateAt(10, 100, 1000, 5000, 0, 1.0)}, {stateAt(11, 100, 1000, 5000, 0, 1.0)});
    EXPECT_EQ(still[0]["programs"][0]["recent"].count("callsPerFrame"), 0u);
    EXPECT_DOUBLE_EQ(still[0]["programs"][0]["recent"]["framesPerSecond"].get<double>(), 0);
    const auto fresh = withRates({}, {stateAt(11, 100, 1000, 5000, 0, 1.0)});
    EXPECT_EQ(fresh[0]["programs"][0].count("recent"), 0u);
    EXPECT_EQ(statLines(fresh[0])[3], "    0 round trips in all: glReadPixels 0");
}

TEST(SessionRates, surviveMalformedStates) {
    for (const char* text : {"{}", R"({"programs":[{}],"nodes":[{}]})", R"({"programs":7,"nodes":"x","atSeconds":[]})",
                             R"({"programs":[1,null],"nodes":[[]]})",
                             R"({"programs":[{"waitSeconds":{"frames":"x"},"client":1}],"nodes":[]})"}) {
        const Json odd = parseJson(text);
        EXPECT_GE(statLines(withRates({odd}, {odd})[0]).size(), 1u) << text;
    }
}

TEST(RunningSessions, areFoundByTheirControlSockets) {
    const std::string sockets =
        "Num       RefCount Protocol Flags    Type St Inode Path\n"
        "0000000000000000: 00000002 00000000 00010000 0001 01 411 /run/user/1/mural-123-00ff00ff00ff00ff/control\n"
        "0000000000000000: 00000003 00000000 00000000 0001 03 412 /run/user/1/mural-123-00ff00ff00ff00ff/control\n"
        "0000000000000000: 00000002 00000000 00010000 0001 01 413 @mural-test-123-1\n"
        "0000000000000000: 00000002 00000000 00010000 0001 01 414 /tmp/mural-9-00ff00ff00ff00ff/socket\n"
        "0000000000000000: 00000002 00000000 00010000 0001 01 415 /a b/ c/mural-45-0123456789abcdef/control\n"
        "0000000000000000: 00000002 00000000 00010000 0001 01 417 @/tmp/mural-8-00ff00ff00ff00ff/control\n"
        "0000000000000000: 00000003 00000000 00000000 0002 01 416\n";
    EXPECT_EQ(sessionsIn(sockets), (std::vector<RunningSession>{
                                       {"mural-123-00ff00ff00ff00ff", "/run/user/1/mural-123-00ff00ff00ff00ff/control"},
                                       {"mural-45-0123456789abcdef", "/a b/ c/mural-45-0123456789abcdef/control"}}));
}

} // namespace
} // namespace mural::cli
