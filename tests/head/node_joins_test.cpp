// A node becomes a member at one position of the stream: what waits for it, and from which position on.
#include <future>
#include <gtest/gtest.h>

#include "gl_opcodes.hpp"
#include "nodes/head/results/reply_assembler.hpp"
#include "nodes/head/frames/frame_tracker.hpp"
#include "nodes/head/membership/kept_streams.hpp"
#include "nodes/head/membership/rejoin_log.hpp"
#include "nodes/head/results/driver_event_merger.hpp"
#include "nodes/head/frames/picture_assembler.hpp"
#include "streamcodec/wire/record_walk.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/node_messages.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/replies.hpp"
#include "tests/trace/recorded.hpp"

namespace mural {
namespace {

constexpr uint32_t kView = 1;

TEST(NodeJoins, includeTheNodeInPicturesFromItsPositionOn) {
    std::vector<uint32_t> frames;
    PictureAssembler assembler(2, [&](WindowPicture picture) { frames.push_back(picture.frame); });
    const auto part = [&](int node, uint32_t frame) {
        const wire::PictureHeader header{1, 1, frame, node * 2, 0, 2, 1, 4, 1, 0, 0, 0};
        ByteBuffer rows = ByteBuffer::ofSize(8);
        std::memset(rows.data(), 7, 8);
        EXPECT_TRUE(assembler.part(node, header, std::move(rows)).ok());
        assembler.frameDone(node, 1, 1, frame);
    };
    assembler.nodeLost(1);
    part(0, 1);
    assembler.nodeJoins(1, kView);
    part(1, 3); // it is ahead, and frame 3 is after its position
    part(0, 2); // frame 2 is before it: the other node has not reached that position
    EXPECT_EQ(frames, (std::vector<uint32_t>{1, 2}));
    assembler.nodeInView(0, kView);
    part(0, 3);
    part(0, 4);
    EXPECT_EQ(frames, (std::vector<uint32_t>{1, 2, 3})) << "frame 4 needs both";
    part(1, 4);
    EXPECT_EQ(frames.back(), 4u);
    part(0, 5);
    assembler.nodeLost(1);
    EXPECT_EQ(frames.back(), 5u) << "lost again: not waited for";
    assembler.nodeJoins(1, kView + 1);
    part(0, 6);
    EXPECT_EQ(frames.back(), 6u) << "nor before the other is where it joins";
}

TEST(NodeJoins, includeTheNodeInAnswersFromItsPositionOn) {
    std::vector<std::pair<uint32_t, uint64_t>> sums;
    ReplyAssembler assembler(2, [&](uint32_t, Reply reply) {
        uint64_t value = 0;
        std::memcpy(&value, reply.bytes.data(), sizeof value);
        sums.emplace_back(reply.header.requestId, value);
    });
    const auto answer = [&](int node, uint32_t request, uint64_t value) {
        ByteBuffer bytes = ByteBuffer::ofSize(sizeof value);
        std::memcpy(bytes.data(), &value, sizeof value);
        const wire::ReplyPartHeader header{1, request, static_cast<uint32_t>(wire::ReplyKind::Sum), 0, 0, 0, 0, 0,
                                           0, 1};
        EXPECT_TRUE(assembler.answer(node, header, std::move(bytes)).ok());
    };
    assembler.nodeLost(1);
    assembler.nodeJoins(1, kView);
    answer(0, 1, 10); // requested before
    EXPECT_EQ(sums.size(), 1u);
    assembler.nodeInView(0, kView);
    answer(0, 2, 20);
    EXPECT_EQ(sums.size(), 1u);
    answer(1, 2, 5);
    ASSERT_EQ(sums.size(), 2u);
    EXPECT_EQ(sums[1], (std::pair<uint32_t, uint64_t>{2, 25}));
    EXPECT_EQ(assembler.openRequests(), 0u);
}

TEST(NodeJoins, makeCreditWaitForTheNode) {
    std::vector<uint32_t> finished;
    FrameTracker tracker(2, [&](uint32_t, uint32_t f, uint32_t) { finished.push_back(f); });
    const auto done = [&](int node, uint32_t frame) {
        wire::FrameDoneMessage m{};
        m.client = m.window = 1;
        m.frame = frame;
        m.width = m.height = 10;
        return tracker.frameDone(node, m, 1).ok();
    };
    done(0, 1);
    done(1, 1);
    tracker.nodeLost(1, 2);
    done(0, 2);
    EXPECT_EQ(finished.back(), 2u);
    tracker.nodeJoins(1); // its progress is still unknown
    done(0, 3);
    EXPECT_EQ(finished.back(), 2u);
    tracker.nodeJoined(1, {{1, 4}}, 3); // it has replayed frames 3 and 4 without messages
    EXPECT_EQ(finished.back(), 3u);
    done(0, 4);
    EXPECT_EQ(finished.back(), 4u);
    done(0, 5);
    EXPECT_EQ(finished.back(), 4u);
    EXPECT_TRUE(done(1, 4)) << "swapped late by another thread";
    EXPECT_TRUE(done(1, 5));
    EXPECT_EQ(finished.back(), 5u);
    EXPECT_FALSE(done(1, 5));
}

TEST(NodeJoins, takeTheProgressOfTheOnlyNode) {
    std::vector<uint32_t> finished;
    FrameTracker tracker(1, [&](uint32_t, uint32_t f, uint32_t) { finished.push_back(f); });
    tracker.nodeLost(0, 1);
    tracker.nodeJoins(0);
    tracker.nodeJoined(0, {{1, 7}}, 2); // the program waits for frame 7, which no living node has shown
    EXPECT_EQ(finished, (std::vector<uint32_t>{7}));
}

TEST(NodeJoins, repeatNoDriverEvents) {
    DriverEventMerger merger;
    const wire::DriverEvent event{1, 2, 1, 0, 0, 0, 0, 0};
    EXPECT_TRUE(merger.isNew(0, event, "a"));
    merger.nodeJoins(1);
    EXPECT_FALSE(merger.isNew(0, event, "a") && merger.isNew(1, event, "a")) << "the second of each is one message";
}

size_t contextsIn(const RejoinLog::Snapshot& snapshot) {
    size_t contexts = 0;
    for (const snapshot::SnapshotPacket& packet : snapshot.packets) {
        wire::RecordWalk walk(packet.payload);
        for (wire::RecordView r; walk.next(r);) contexts += r.opcode == wire::kOpCreateContext ? 1 : 0;
    }
    return contexts;
}

TEST(RejoinLog, returnsAllEarlierPacketsAndForgetsEndedPrograms) {
    RejoinLog log(1 << 20, makeCapturedStream);
    const auto makes = [&](uint32_t stream, uint32_t context) {
        log.append(stream, trace::PacketBuilder().context(context).swap(1, context).bytes());
    };
    makes(wire::streamOf(1, 0), 7);
    makes(wire::streamOf(2, 0), 8);
    makes(wire::streamOf(1, 1), 9);
    const uint64_t first = log.pause();
    makes(wire::streamOf(2, 0), 10); // after it
    const uint64_t second = log.pause();
    auto later = std::async(std::launch::async, [&] { return log.snapshot(second, Deadline::inMs(10'000)); });
    auto snapshot = log.snapshot(first, Deadline::inMs(10'000));
    ASSERT_TRUE(snapshot.ok());
    EXPECT_EQ(contextsIn(*snapshot), 3u);
    ASSERT_EQ(snapshot->frames.size(), 2u);
    EXPECT_EQ(snapshot->frames[0].frame, 9u);
    EXPECT_EQ(snapshot->frames[1].frame, 8u);
    auto all = later.get();
    ASSERT_TRUE(all.ok());
    EXPECT_EQ(contextsIn(*all), 4u);
    log.programGone(1);
    auto rest = log.snapshot(log.pause(), Deadline::inMs(10'000));
    ASSERT_TRUE(rest.ok());
    EXPECT_EQ(contextsIn(*rest), 2u);
}

TEST(RejoinLog, reportsOverflowUntilTheProgramsAreGone) {
    RejoinLog log(1 << 20, makeCapturedStream);
    const auto fits = [&] { return log.snapshot(log.pause(), Deadline::inMs(10'000)).ok(); };
    const std::vector<uint32_t> much(65536, 1); // a command without a rule: it stays in the log
    log.append(wire::streamOf(1, 0),
               trace::PacketBuilder().context(1).window(1, 9, 9).record(wire::kOpMakeCurrent, {1, 1, 1}).bytes());
    EXPECT_TRUE(fits());
    for (int i = 0; i < 16; ++i)
        log.append(wire::streamOf(1, 0), trace::PacketBuilder().longRecord(op::glAlphaFragmentOp1ATI, much).bytes());
    log.append(wire::streamOf(2, 0), trace::PacketBuilder().context(1).bytes());
    EXPECT_FALSE(fits());
    EXPECT_FALSE(log.complete());
    log.programGone(1);
    EXPECT_FALSE(fits()) << "what they shared is not known any more";
    log.programGone(2);
    EXPECT_TRUE(fits()) << "nobody is left";
    log.append(wire::streamOf(3, 0), trace::PacketBuilder().context(1).bytes());
    EXPECT_TRUE(fits());
}

} // namespace
} // namespace mural
