// Parsing of the head's events, and the report for the user.
#include "tools/mural/head_events.hpp"

#include <gtest/gtest.h>

#include "tools/mural/console.hpp"

namespace mural::cli {
namespace {

HeadEvent event(const std::string& line) {
    auto parsed = parseHeadEvent(line);
    EXPECT_TRUE(parsed.ok()) << line;
    return parsed.ok() ? parsed.value() : HeadEvent{};
}

TEST(HeadEvents, readEachLineOfTheProtocol) {
    EXPECT_EQ(event(R"({"event":"ready","explain":["a","b"],"nodes":[]})").explain,
              (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(event(R"({"event":"error","text":"no GL"})").text, "no GL");
    EXPECT_EQ(event(R"({"event":"clients","count":2})").clients, 2);
    const HeadEvent frame = event(R"({"event":"frame","frame":120,"framesPerSecond":58.2,"bytesPerFrame":12345})");
    EXPECT_EQ(frame.frame, 120);
    EXPECT_DOUBLE_EQ(frame.framesPerSecond, 58.2);
    EXPECT_DOUBLE_EQ(frame.bytesPerFrame, 12345);
    EXPECT_EQ(event(R"({"event":"frames-reached"})").kind, HeadEvent::Kind::FramesReached);
}

TEST(HeadEvents, rejectMalformedLinesWithoutThrowing) {
    for (const char* line : {"", "{", "[]", "7", "null", R"({"text":"x"})"})
        EXPECT_FALSE(parseHeadEvent(line).ok()) << line;
    EXPECT_EQ(event(R"({"event":"later"})").kind, HeadEvent::Kind::Unknown);
    EXPECT_EQ(event(R"({"event":7})").kind, HeadEvent::Kind::Unknown);
    EXPECT_EQ(event(R"({"event":"clients","count":"two"})").clients, 0);
    EXPECT_EQ(event(R"({"event":"report","frames":[],"nodes":[1,{"node":3,"lost":true}]})").report.nodes.size(), 1u);
}

TEST(Report, showsDifferencesAndLostNodes) {
    const HeadEvent e = event(
        R"({"event":"report","frames":90,"seconds":1.5,"framesPerSecond":60.0,"bytesPerFrame":12345,"verifiedFrames":90,)"
        R"("verifiedPixels":70778880,"differingPixels":3,"largestDifference":2,"squaredDifference":9,"savedPictures":1,"lastPicture":"out/a.png","recording":"a.mural","recordedFrames":90,"recordedBytes":1234567,)"
        R"("callsUnsupported":1,"nodes":[{"node":0,"frames":90},{"node":1,"frames":12,"lost":true,"hasConnected":true},{"node":2,"lost":true}]})");
    EXPECT_EQ(
        reportLines(e.report),
        (std::vector<std::string>{"90 frames in 1.5 s, 60.0 frames/s, 12.3 kB per frame to each node, 0 round trips",
                                  "verified 90 frames, 70778880 pixels: 3 differ, by up to 2 of 255, PSNR 123.1 dB",
                                  "saved 1 picture, the last in out/a.png", "recorded 90 frames in a.mural, 1.23 MB",
                                  "1 call of unsupported commands; see mural list-commands --unsupported",
                                  "node 1 was lost after 12 frames", "node 2 did not connect"}));
}

TEST(Report, showsUnverifiedFrames) {
    const HeadEvent e = event(
        R"({"event":"report","frames":9,"seconds":1,"framesPerSecond":9,"bytesPerFrame":120,"uncomparedFrames":3,)"
        R"("uncomparedFramesBy":{"front buffer":2,"window not current":1}})");
    EXPECT_EQ(reportLines(e.report).back(), "not verified: 3 frames (front buffer 2, window not current 1)");
}

TEST(Report, showsWhatDeltaCodingSaved) {
    const HeadEvent e = event(
        R"({"event":"report","frames":10,"seconds":1,"framesPerSecond":9,"bytesPerFrame":120,)"
        R"("delta":{"records":1000,"rawBytes":50000,"stagedBytes":3000,"wireBytes":1200,"pageHits":90,"newPages":10,"encodeSeconds":0.0003,"deferredRecords":7,"droppedRecords":5,"droppedBytes":4096}})");
    ASSERT_EQ(reportLines(e.report).size(), 3u);
    EXPECT_EQ(reportLines(e.report)[2],
              "filter: 7 records deferred until first use; 5 unused records dropped (4.1 kB)");
    EXPECT_EQ(reportLines(e.report)[1],
              "delta coding: 5.0 kB per frame, 300 B of it new to the nodes, 120 B compressed; "
              "90 of 100 pages were cached; encoding took 30 us per frame, 300 ns per call");
    EXPECT_EQ(reportLines(event(R"({"event":"report","frames":10,"delta":null})").report).size(), 1u);
}

TEST(Report, showsEqualizers) {
    const HeadEvent e = event(
        R"({"event":"report","frames":10,"seconds":1,"framesPerSecond":9,"bytesPerFrame":120,"equalizers":[)"
        R"({"name":"wall.queue","kind":"tile_queue","divides":"picture","frames":8,"moves":2,"efficiency":0.91,"nodes":[{"node":0,"part":0.2},{"node":1,"part":0.8}]},)"
        R"({"name":"of nothing","frames":0},7]})");
    ASSERT_EQ(reportLines(e.report).size(), 2u);
    EXPECT_EQ(reportLines(e.report)[1],
              "equalizer \"wall.queue\": parts of the picture moved after 2 of 8 frames; at the "
              "end node 0 20 %, node 1 80 %; nodes were busy for 91 % of the longest time");
    EXPECT_EQ(reportLines(event(R"({"event":"report","frames":10,"equalizers":null})").report).size(), 1u);
}

TEST(Report, showsCommandsThatCauseRoundTrips) {
    const HeadEvent e =
        event(R"({"event":"report","frames":10,"seconds":1,"framesPerSecond":9,"bytesPerFrame":1,"roundTrips":5,)"
              R"("roundTripsBy":{"glGetQueryObjectuiv":1,"glReadPixels":4,"odd":"x"}})");
    EXPECT_EQ(reportLines(e.report).front(), "10 frames in 1.0 s, 9.0 frames/s, 1 B per frame to each node, "
                                             "5 round trips (0.50 per frame: glReadPixels 4, glGetQueryObjectuiv 1)");
}

TEST(Report, namesUnsupportedCommands) {
    const HeadEvent e = event(R"({"event":"report","frames":10,"callsUnsupported":5,)"
                              R"("callsUnsupportedBy":{"glGetTexParameterxv":1,"glTexBumpParameterfvATI":4}})");
    EXPECT_EQ(reportLines(e.report).back(), "5 calls of unsupported commands: glTexBumpParameterfvATI 4, "
                                            "glGetTexParameterxv 1; see mural list-commands --unsupported");
}

TEST(Report, formatsSizesWithThreeDigits) {
    EXPECT_EQ(sizeText(0), "0 B");
    EXPECT_EQ(sizeText(999), "999 B");
    EXPECT_EQ(sizeText(1000), "1.0 kB");
    EXPECT_EQ(sizeText(4.56e6), "4.56 MB");
    EXPECT_EQ(sizeText(7.8e9), "7.80 GB");
}

} // namespace
} // namespace mural::cli
