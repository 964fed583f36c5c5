// Records of frames as JSON: nothing is lost, and invalid text is an error.
#include "common/json/json_text.hpp"
#include "nodes/head/statistics/frame_record.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tools/mural/stat/session_frames.hpp"

namespace mural {
namespace {

FrameRecord sampleRecord() {
    FrameRecord record{12, 3, 4, 99, 123'456'789'012'345, {}};
    record.tracks.push_back({SpanProcess::Program, 0, "gl", {{SpanKind::Capture, 1, 5}}});
    record.tracks.push_back(
        {SpanProcess::Node, 7, "pictures", {{SpanKind::WaitFrame, -3, 0}, {SpanKind::Compress, 0, 8}}});
    return record;
}

TEST(FrameRecord, keepsEverythingInJson) {
    const auto read = frameRecordFromJson(parseJson(jsonText(toJson(sampleRecord()))));
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read.value(), sampleRecord());
}

TEST(FrameRecord, rejectsJsonWithoutItsMembers) {
    for (const char* name : {"number", "client", "window", "frame", "doneNs", "tracks"}) {
        nlohmann::json json = toJson(sampleRecord());
        json.erase(name);
        EXPECT_FALSE(frameRecordFromJson(json).ok()) << name;
        json[name] = "text";
        EXPECT_FALSE(frameRecordFromJson(json).ok()) << name;
    }
    EXPECT_FALSE(frameRecordFromJson(nlohmann::json::array()).ok());
    nlohmann::json json = toJson(sampleRecord());
    json["tracks"][0]["spans"][0] = 5;
    EXPECT_FALSE(frameRecordFromJson(json).ok());
}

TEST(SessionFrames, rejectInvalidReplies) {
    const nlohmann::json reply = {
        {"frames", {toJson(sampleRecord())}}, {"next", 13u}, {"status", nlohmann::json::object()}};
    cli::SessionFrames frames;
    ASSERT_TRUE(addReply(frames, reply).ok());
    EXPECT_EQ(frames.frames.size(), 1u);
    EXPECT_EQ(frames.next, 13u);
    for (const char* name : {"frames", "next", "status"}) {
        nlohmann::json other = reply;
        other[name] = "text";
        EXPECT_FALSE(addReply(frames, other).ok()) << name;
    }
}

TEST(SessionFrames, dropFramesThatWereInProgressAtTheBegin) {
    cli::SessionFrames frames;
    for (uint32_t frame = 1; frame <= 5; ++frame) {
        FrameRecord record;
        record.frame = frame;
        for (int node = 0; node < 2; ++node)
            if (frame > 2 || (frame == 2 && node == 1))
                record.tracks.push_back({SpanProcess::Node, node, "replay", {{SpanKind::Replay, 0, 1}}});
        frames.frames.push_back(record);
    }
    dropPartialBegin(frames);
    ASSERT_EQ(frames.frames.size(), 3u);
    EXPECT_EQ(frames.frames.front().frame, 3u);
    dropPartialBegin(frames);
    EXPECT_EQ(frames.frames.size(), 3u);
}

// The first track of a frame in progress may be the report of its end, which follows the first track of the next frame.
TEST(SessionFrames, dropFramesInProgressThatFollowTheFirstCompleteOne) {
    cli::SessionFrames frames;
    for (const uint32_t frame : {1u, 3u, 2u, 4u}) {
        FrameRecord record;
        record.frame = frame;
        if (frame > 2) record.tracks.push_back({SpanProcess::Node, 0, "replay", {{SpanKind::Replay, 0, 1}}});
        frames.frames.push_back(record);
    }
    dropPartialBegin(frames);
    ASSERT_EQ(frames.frames.size(), 2u);
    EXPECT_EQ(frames.frames[0].frame, 3u);
    EXPECT_EQ(frames.frames[1].frame, 4u);
}

} // namespace
} // namespace mural
