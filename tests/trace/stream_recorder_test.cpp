// The recording thread: order, a full disk, a blocked disk, a killed head.
#include <filesystem>
#include <gtest/gtest.h>

#include "streamcodec/trace/stream_recorder.hpp"
#include "streamcodec/wire/packet.hpp"
#include "tests/recorded_log.hpp"
#include "tests/trace/recorded.hpp"

namespace mural::trace {
namespace {

class StreamRecorderTest : public ::testing::Test {
protected:
    StreamRecorderTest()
        : path_(
              (std::filesystem::temp_directory_path() / ("mural-recorder-test." + std::to_string(getpid()))).string()) {
    }
    ~StreamRecorderTest() override { std::filesystem::remove(path_); }

    std::unique_ptr<StreamRecorder> recorder(RecorderConfig config = {}, const std::string& path = "") {
        auto made = StreamRecorder::create(path.empty() ? path_ : path, std::move(config));
        EXPECT_TRUE(made);
        return made ? std::move(*made) : nullptr;
    }

    const std::string path_;
    const RecordedLog log_;
};

TEST_F(StreamRecorderTest, keepsOrderWithASmallQueue) {
    RecorderConfig config;
    config.queueBytes = 256;
    auto r = recorder(config);
    r->begin({});
    r->event({Event::ClientCame, 1, 5, "x"});
    for (uint32_t i = 1; i <= 1000; ++i) r->packet(wire::streamOf(1, i % 3), PacketBuilder().swap(1, i).bytes());
    r->packet(0, PacketBuilder().record(1, {}).bytes()); // the head's own commands do not belong to programs
    const WriterTotals totals = r->finish(Deadline::inMs(20'000));
    EXPECT_EQ(totals.frames, 1000);
    auto reader = TraceReader::open(path_);
    ASSERT_TRUE(reader) << reader.error().message;
    const auto entries = entriesOf(**reader);
    ASSERT_EQ(entries.size(), 1001u);
    for (uint32_t i = 1; i <= 1000; ++i) {
        uint32_t frame = 0;
        std::memcpy(&frame, entries[i].payload.data() + 8, 4);
        ASSERT_EQ(frame, i);
        ASSERT_EQ(entries[i].stream, wire::streamOf(1, i % 3));
        ASSERT_GE(entries[i].timeNs, entries[i - 1].timeNs);
    }
    EXPECT_TRUE(log_.texts().empty());
}

// Main window 1 (200x100) and window 2 (20x10) of program 1, with frames up to 7.
StreamBefore before() {
    StreamBefore before;
    before.programs.push_back({Event::ClientCame, 1, 5, "x"});
    PacketBuilder packet; // owns the bytes
    const auto bytes = packet.context(1).window(1, 200, 100).window(2, 20, 10).swap(1, 0).bytes();
    before.packets.push_back({wire::streamOf(1, 0), {bytes.begin(), bytes.end()}});
    before.wall.packet(wire::streamOf(1, 0), PacketBuilder().window(1, 200, 100).window(2, 20, 10).bytes());
    for (uint32_t i = 1; i <= 7; ++i) before.wall.packet(wire::streamOf(1, 0), PacketBuilder().swap(1, i).bytes());
    return before;
}

uint32_t frameOf(const Written& entry) {
    uint32_t frame = 0;
    std::memcpy(&frame, entry.payload.data() + 8, 4);
    return frame;
}

TEST_F(StreamRecorderTest, beginsWithTheStateBeforeItsFirstPacket) {
    auto r = StreamRecorder::createWaiting(path_, {});
    const uint32_t main = wire::streamOf(1, 0);
    r->packet(main, PacketBuilder().swap(2, 8).bytes()); // not of the wall, and before its next frame
    r->packet(main, PacketBuilder().swap(1, 9).bytes());
    EXPECT_FALSE(std::filesystem::exists(path_));
    ASSERT_TRUE(r->beginAfter({}, before()));
    r->packet(main, PacketBuilder().swap(2, 10).bytes());
    r->event({Event::ClientCame, 2, 6, "y"});
    r->packet(wire::streamOf(2, 0), PacketBuilder().swap(1, 1).bytes());
    const WriterTotals totals = r->finish(Deadline::inMs(20'000));
    EXPECT_EQ(totals.frames, 1); // the second program's window has no size
    auto reader = TraceReader::open(path_);
    ASSERT_TRUE(reader) << reader.error().message;
    const auto entries = entriesOf(**reader);
    ASSERT_EQ(entries.size(), 7U);
    EXPECT_EQ(entries[0].stream, 0U);
    EXPECT_EQ(entries[1].payload, before().packets[0].payload);
    EXPECT_EQ(frameOf(entries[2]), wire::kUnseenFrame);
    EXPECT_EQ(frameOf(entries[3]), 1U);
    EXPECT_EQ(frameOf(entries[4]), 2U);
    EXPECT_EQ(entries[5].stream, 0U);
    EXPECT_EQ(frameOf(entries[6]), 1U);
    EXPECT_TRUE(log_.texts().empty());
}

TEST_F(StreamRecorderTest, leavesNoFileAfterAFailedBeginning) {
    auto full = StreamRecorder::createWaiting("/dev/full", {});
    const auto begun = full->beginAfter({}, before());
    ASSERT_FALSE(begun);
    EXPECT_NE(begun.error().message.find("No space left"), std::string::npos) << begun.error().message;
    auto discarded = StreamRecorder::createWaiting(path_, {});
    discarded->discard();
    EXPECT_FALSE(discarded->beginAfter({}, before()));
    EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(StreamRecorderTest, endsWithTheLastFrame) {
    RecorderConfig config;
    config.lastFrame = 3;
    auto r = recorder(config);
    r->begin({});
    for (uint32_t i = 1; i <= 10; ++i) r->packet(wire::streamOf(1, 0), PacketBuilder().swap(1, i).bytes());
    r->event({Event::ClientGone, 1, 0, ""});
    EXPECT_EQ(r->finish(Deadline::inMs(20'000)).frames, 3);
    auto reader = TraceReader::open(path_);
    ASSERT_TRUE(reader);
    EXPECT_EQ(entriesOf(**reader).size(), 4u);
}

TEST_F(StreamRecorderTest, stopsWithOneLineOnAFullDisk) {
    auto r = recorder({}, "/dev/full");
    r->begin({});
    for (uint32_t i = 1; i <= 100; ++i) r->packet(wire::streamOf(1, 0), PacketBuilder().swap(1, i).bytes());
    r->finish(Deadline::inMs(20'000));
    r->packet(wire::streamOf(1, 0), PacketBuilder().swap(1, 101).bytes());
    ASSERT_EQ(log_.texts().size(), 1u);
    EXPECT_EQ(log_.texts()[0],
              "trace /dev/full: cannot be written: No space left on device; free space, or choose another "
              "place; the trace ends after 0 frames, the program continues");
}

TEST_F(StreamRecorderTest, stopsWithOneLineOnABlockedDisk) {
    RecorderConfig config;
    config.queueBytes = 1024;
    config.patienceMs = 50;
    auto r = recorder(config); // not started: nothing is written
    for (uint32_t i = 1; i <= 1000; ++i) r->packet(wire::streamOf(1, 0), PacketBuilder().swap(1, i).bytes());
    ASSERT_EQ(log_.texts().size(), 1u);
    EXPECT_NE(log_.texts()[0].find("the disk may be too slow"), std::string::npos) << log_.texts()[0];
}

TEST_F(StreamRecorderTest, preservesDataOlderThanASecondWhenTheHeadIsKilled) {
    RecorderConfig config;
    config.wholeEveryMs = 20;
    {
        auto r = recorder(config);
        r->begin({});
        r->packet(wire::streamOf(1, 0), PacketBuilder().swap(1, 1).bytes());
        const Deadline deadline = Deadline::inMs(20'000);
        while (!deadline.passed()) {
            auto reader = TraceReader::open(path_);
            if (reader && (*reader)->frames() == 1) break;
            usleep(5000);
        }
    } // without finish(): as if killed
    auto reader = TraceReader::open(path_);
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ((*reader)->frames(), 1);
    EXPECT_NE((*reader)->notice(), "");
    EXPECT_EQ(entriesOf(**reader).size(), 1u);
}

} // namespace
} // namespace mural::trace
