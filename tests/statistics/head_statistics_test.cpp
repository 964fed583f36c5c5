// A complete head with fake nodes: statistics on request, over the session's control socket.
#include <chrono>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/head/support/session_harness.hpp"
#include "tests/temporary_folder.hpp"
#include "tools/mural/stat/running_sessions.hpp"
#include "tools/mural/stat/session_frames.hpp"

namespace mural {
namespace {

constexpr uint32_t kFrames = 400;
constexpr size_t kEnough = 10; // frames in progress at the first request may lack spans

class ControlledHead : public SessionHarness {
public:
    explicit ControlledHead(int nodes) : SessionHarness(nodes) {
        config.socketPath = folder_.at("socket");
        options.goodbyePatienceMs = kTestPatienceMs;
    }
    [[nodiscard]] std::string controlPath() const { return folder_.at("control"); }

private:
    test::TemporaryFolder folder_;
};

// Draws frames and requests statistics until the head has some.
cli::SessionFrames framesOf(ControlledHead& head, FakeProgram& program) {
    cli::SessionFrames frames;
    for (uint32_t frame = 1; frame <= kFrames && frames.frames.size() < kEnough; ++frame) {
        const auto reply = cli::queryFrames(head.controlPath(), frames.next);
        EXPECT_TRUE(reply.has_value());
        if (!reply) return frames;
        EXPECT_TRUE(addReply(frames, *reply).ok());
        EXPECT_TRUE(program.publish(kFakeSwap, {frame, 1, 64, 48}) && program.waitFramesDone(frame));
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    dropPartialBegin(frames);
    return frames;
}

TEST(HeadStatistics, containTheSpansOfEveryNode) {
    ControlledHead head(3);
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    const cli::SessionFrames frames = framesOf(head, program);
    ASSERT_FALSE(frames.frames.empty());
    const FrameRecord& record = frames.frames.back();
    EXPECT_NE(record.doneNs, 0);
    EXPECT_EQ(record.window, 1u);
    int nodes = 0;
    for (const SpanTrack& track : record.tracks) {
        if (track.process != SpanProcess::Node) continue;
        ++nodes;
        EXPECT_EQ(track.spans.size(), 2u);
        EXPECT_EQ(track.spans.back().kind, SpanKind::Replay);
        EXPECT_LE(track.spans.back().endNs, record.doneNs);
    }
    EXPECT_EQ(nodes, 3);
    EXPECT_EQ(frames.status["nodes"].size(), 3u);
    EXPECT_EQ(frames.clocks.size(), 3u);
    head.finish();
    EXPECT_EQ(head.status(), 0);
}

TEST(HeadStatistics, requestNothingOfTheNodesWithoutAClient) {
    ControlledHead head(2);
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    for (uint32_t frame = 1; frame <= 20; ++frame) {
        ASSERT_TRUE(program.publish(kFakeSwap, {frame, 1, 64, 48}));
    }
    ASSERT_TRUE(program.waitFramesDone(20));
    for (const auto& packet : head.node(0).packets()) {
        const bool isStatistics =
            packet.stream == 0 && packet.words[0] == static_cast<uint32_t>(wire::HeadCommand::Statistics);
        EXPECT_FALSE(isStatistics);
    }
    head.finish();
}

TEST(HeadStatistics, endANodeThatSendsSpansThatOverlap) {
    ControlledHead head(2);
    head.behaviours[1].overlappingSpans = true;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    (void)framesOf(head, program);
    EXPECT_NE(head.waitForMessage("node 1 (local) was lost").find("statistics whose times overlap"), std::string::npos);
    head.finish();
}

} // namespace
} // namespace mural
