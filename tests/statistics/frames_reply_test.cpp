// The length of a reply.
#include "common/json/json_text.hpp"
#include "nodes/head/statistics/frames_reply.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "nodes/head/control/control_protocol.hpp"

namespace mural {
namespace {

constexpr int64_t kLateNs = 9'000'000'000'000'000; // a machine that has run for 100 days

// Frames with as many spans as a thread may have.
std::vector<FrameRecord> fullFrames(size_t count, size_t tracks) {
    std::vector<FrameRecord> records;
    for (size_t i = 0; i < count; ++i) {
        FrameRecord& record = records.emplace_back();
        record.number = 7 + i;
        for (size_t t = 0; t < tracks; ++t)
            record.tracks.push_back(
                {SpanProcess::Node, static_cast<int>(t), "pictures",
                 std::vector<Span>(ThreadSpans::kMaxSpans, {SpanKind::WaitPicture, kLateNs, kLateNs})});
    }
    return records;
}

TEST(FramesReply, fitsIntoTheUnsentBytesOfAClient) {
    const nlohmann::json reply = framesReply(fullFrames(600, 8), 7);
    EXPECT_TRUE(reply["more"].get<bool>());
    EXPECT_GT(reply["frames"].size(), 5u);
    EXPECT_LT(jsonText(reply).size(), kMaxControlUnsentBytes * 6 / 10);
    EXPECT_EQ(reply["next"].get<size_t>(), 7 + reply["frames"].size());
}

TEST(FramesReply, hasAFrameThatIsLongByItself) {
    const nlohmann::json reply = framesReply(fullFrames(2, 100), 7);
    EXPECT_EQ(reply["frames"].size(), 1u);
    EXPECT_EQ(reply["next"], 8);
    EXPECT_TRUE(reply["more"].get<bool>());
}

TEST(FramesReply, keepsTheNumberWithoutFrames) {
    const nlohmann::json reply = framesReply({}, 7);
    EXPECT_EQ(reply["next"], 7);
    EXPECT_FALSE(reply["more"].get<bool>());
}

} // namespace
} // namespace mural
