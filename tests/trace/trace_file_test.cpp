// Trace files: round trips, and truncated, modified or foreign files.
#include <filesystem>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "tests/trace/recorded.hpp"

namespace mural::trace {
namespace {

class TraceFile : public ::testing::Test {
protected:
    TraceFile()
        : folder_(std::filesystem::temp_directory_path() / ("mural-recording-test." + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder_);
    }
    ~TraceFile() override { std::filesystem::remove_all(folder_); }
    [[nodiscard]] std::string path() const { return (folder_ / "a.mural").string(); }

    // Writes two programs and three frames of the larger window in two blocks; returns the entries.
    std::vector<Written> writeSmall() {
        std::vector<Written> put;
        auto writer = TraceWriter::create(path());
        EXPECT_TRUE(writer);
        TraceWriter& w = **writer;
        EXPECT_TRUE(w.begin({"9.9", {"a GL"}, ""}, wire::kVersion, registryDigest()));
        const auto add = [&](uint32_t stream, std::span<const std::byte> payload) {
            put.push_back({stream, 1000 * put.size(), Bytes(payload.begin(), payload.end())});
            EXPECT_TRUE(w.append({stream, put.back().timeNs, payload}));
        };
        add(0, eventBytes({Event::ClientCame, 1, 77, "first"}));
        add(wire::streamOf(1, 0), PacketBuilder().window(1, 20, 10).swap(1, 1).bytes());
        add(0, eventBytes({Event::ClientCame, 2, 78, "second"}));
        add(wire::streamOf(2, 3),
            PacketBuilder().window(5, 4, 4).swap(5, 1).longRecord(wire::kOpBlobData, {4, 42}).bytes());
        EXPECT_TRUE(w.flush());
        add(wire::streamOf(1, 1), PacketBuilder().swap(1, 2).swap(1, 3).bytes());
        add(0, eventBytes({Event::ClientGone, 1, 0, ""}));
        EXPECT_TRUE(w.flush());
        EXPECT_TRUE(w.finish());
        EXPECT_EQ(w.totals().frames, 3);
        EXPECT_FALSE(w.hasUnwritten());
        return put;
    }

    const std::filesystem::path folder_;
};

TEST_F(TraceFile, roundTrips) {
    const auto put = writeSmall();
    auto reader = TraceReader::open(path());
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ((*reader)->notice(), "");
    EXPECT_EQ((*reader)->about().version, "9.9");
    EXPECT_EQ((*reader)->about().nodes, std::vector<std::string>{"a GL"});
    EXPECT_EQ((*reader)->frames(), 3);
    ASSERT_EQ((*reader)->blocks().size(), 2u);
    EXPECT_EQ((*reader)->blocks()[1].firstFrame, 2u);
    EXPECT_EQ((*reader)->blocks()[1].framesEnded, 2u);
    std::string problem;
    EXPECT_EQ(entriesOf(**reader, &problem), put);
    EXPECT_EQ(problem, "");
}

TEST_F(TraceFile, isReadableUpToTheLastCompleteBlockWhenTruncated) {
    const auto put = writeSmall();
    const Bytes whole = readWhole(path());
    auto all = readerOf(whole);
    ASSERT_TRUE(all);
    const uint64_t second = (*all)->blocks()[1].offset;
    const size_t inFirst = (*all)->blocks()[0].entries;
    size_t maxRead = 0;
    for (size_t bytes = 0; bytes < whole.size(); ++bytes) {
        auto cut = readerOf(std::span(whole).first(bytes));
        if (!cut) { // within the header
            EXPECT_LT(bytes, (*all)->blocks()[0].offset) << cut.error().message;
            continue;
        }
        EXPECT_NE((*cut)->notice().find("its end is missing"), std::string::npos) << bytes;
        std::string problem;
        const auto entries = entriesOf(**cut, &problem);
        EXPECT_EQ(problem, "") << bytes;
        EXPECT_TRUE(std::equal(entries.begin(), entries.end(), put.begin())) << bytes;
        EXPECT_EQ(entries.size() >= inFirst, bytes >= second) << bytes;
        maxRead = std::max(maxRead, entries.size());
    }
    EXPECT_EQ(maxRead, put.size()); // only the index is missing
}

TEST_F(TraceFile, detectsEveryChangedByte) {
    const auto put = writeSmall();
    const Bytes whole = readWhole(path());
    for (size_t at = 0; at < whole.size(); ++at) {
        for (const uint8_t change : {0x01, 0x80, 0xff}) {
            Bytes changed = whole;
            changed[at] ^= std::byte{change};
            auto reader = readerOf(changed);
            std::string problem = reader ? (*reader)->notice() : reader.error().message;
            if (reader) entriesOf(**reader, &problem);
            EXPECT_NE(problem, "") << "byte " << at << " of " << whole.size() << ", changed by " << int{change};
            EXPECT_EQ(problem.find('\n'), std::string::npos);
        }
    }
}

TEST_F(TraceFile, reportsProblemAndRemedy) {
    writeSmall();
    const Bytes whole = readWhole(path());
    const auto errorOf = [&](size_t at, uint32_t value) {
        Bytes changed = whole;
        std::memcpy(changed.data() + at, &value, 4);
        auto reader = readerOf(changed);
        return reader ? "" : reader.error().message;
    };
    EXPECT_EQ(
        errorOf(offsetof(Header, version), 2),
        "trace in memory has version 2 of the format, but this Mural reads version 1; use the Mural that recorded it");
    EXPECT_EQ(errorOf(0, 0x464c457f), "in memory is not a trace of Mural; choose a file of mural run --record");
    EXPECT_EQ(errorOf(offsetof(Header, aboutBytes), 0xffffffff),
              "trace in memory is damaged at byte 0: its header is longer than the file; use another copy of it, or "
              "record it again");
    EXPECT_EQ(TraceReader::open("/nowhere.mural").error().message,
              "trace /nowhere.mural: cannot be read: No such file or directory; check the name");
    EXPECT_EQ(TraceReader::open("/").error().message, "trace /: is not a file; choose a file of mural run --record");
    EXPECT_EQ(TraceWriter::create("/nowhere/a.mural").error().message,
              "trace /nowhere/a.mural: cannot be written: No such file or directory; choose another place");
}

// A blocking open would wait for a reader.
TEST_F(TraceFile, refusesAFifoWithoutAReader) {
    ASSERT_EQ(mkfifo(path().c_str(), 0600), 0);
    EXPECT_EQ(TraceWriter::create(path()).error().message,
              "trace " + path() + ": cannot be written: No such device or address; choose another place");
}

TEST_F(TraceFile, keepsFramesBeforeADamagedBlock) {
    const auto put = writeSmall();
    const Bytes whole = readWhole(path());
    const auto blocks = (*TraceReader::open(path()))->blocks();
    for (uint64_t at = blocks[1].offset; at < blocks[1].offset + sizeof(BlockHeader) + 4; ++at) {
        Bytes changed = whole;
        changed[at] ^= std::byte{0xff};
        auto reader = readerOf(changed);
        ASSERT_TRUE(reader) << at << ": " << reader.error().message;
        EXPECT_EQ(entriesOf(**reader).size(), blocks[0].entries) << at;
        const auto verified = (*reader)->verify();
        ASSERT_FALSE(verified) << at;
        EXPECT_TRUE(verified.error().message.starts_with("trace in memory is damaged at byte " +
                                                         std::to_string(blocks[1].offset) + ": "))
            << verified.error().message;
        EXPECT_TRUE(
            verified.error().message.ends_with("; earlier frames are valid (1): extract them with mural trim in memory "
                                               "1 -o good.mural, use another copy of it, or record it again"))
            << verified.error().message;
    }
    Bytes changed = whole;
    changed[blocks[0].offset + sizeof(BlockHeader)] ^= std::byte{0xff};
    EXPECT_EQ((*readerOf(changed))->verify().error().message,
              "trace in memory is damaged at byte " + std::to_string(blocks[0].offset) +
                  ": the checksum of a block is wrong, and no frame ends before it; use another copy of it, or record "
                  "it again");
}

TEST_F(TraceFile, explainsMissingFrames) {
    writeSmall();
    const Bytes whole = readWhole(path());
    const uint64_t first = (*TraceReader::open(path()))->blocks()[0].offset;
    const size_t bytes = first + sizeof(BlockHeader) + 1;
    EXPECT_EQ((*readerOf(std::span(whole).first(bytes)))->noSuchFrames(0).message,
              "trace in memory has no complete frame: its end is missing (the head was killed, or the file is "
              "truncated), valid data ends at byte " +
                  std::to_string(first) + " of " + std::to_string(bytes) +
                  "; use another copy of it, or record it again");
    EXPECT_EQ((*readerOf(whole))->noSuchFrames(0).message,
              "trace in memory has no frame, because its program showed no picture; mural dump prints its calls");
    EXPECT_EQ((*readerOf(whole))->noSuchFrames(3).message, "the trace has 3 frames; choose some of them, such as 1-3");
    EXPECT_EQ((*readerOf(std::span(whole).first(whole.size() - 1)))->noSuchFrames(3).message,
              "the trace has 3 frames, as its end is missing (the head was killed, or the file is truncated); choose "
              "some of them, such as 1-3");
}

TEST_F(TraceFile, rejectsOtherCommandTables) {
    auto writer = TraceWriter::create(path());
    ASSERT_TRUE((*writer)->begin({"9.9", {}, ""}, wire::kVersion, registryDigest() ^ 1));
    ASSERT_TRUE((*writer)->finish());
    auto reader = TraceReader::open(path());
    ASSERT_FALSE(reader);
    EXPECT_EQ(reader.error().message, "trace " + path() +
                                          " was recorded by a Mural with other commands (version 9.9); read it with "
                                          "that version, or record it again");
}

TEST_F(TraceFile, dividesLargeFramesIntoBoundedBlocks) {
    auto writer = TraceWriter::create(path());
    TraceWriter& w = **writer;
    ASSERT_TRUE(w.begin({}, wire::kVersion, registryDigest()));
    const std::vector<uint32_t> noise(200'000, 7);
    PacketBuilder large;
    large.longRecord(wire::kOpBlobData, noise);
    for (int i = 0; i < 40; ++i) ASSERT_TRUE(w.append({wire::streamOf(1, 0), 0, large.bytes()})); // 32 MB, one frame
    ASSERT_TRUE(w.append({wire::streamOf(1, 0), 0, PacketBuilder().swap(1, 1).bytes()}));
    ASSERT_TRUE(w.flush());
    ASSERT_TRUE(w.finish());
    auto reader = TraceReader::open(path());
    ASSERT_TRUE(reader);
    EXPECT_GE((*reader)->blocks().size(), 4u);
    EXPECT_EQ(entriesOf(**reader).size(), 41u);
    EXPECT_EQ((*reader)->frames(), 1);
}

TEST(RecordWalk, stopsAtAnInvalidRecord) {
    const uint32_t endless[] = {wire::kOpFinish | 2u << 16, 0, 99u << 16 | wire::kOpSwap, 0};
    wire::RecordWalk walk(std::as_bytes(std::span(endless)));
    wire::RecordView r;
    EXPECT_TRUE(walk.next(r));
    EXPECT_EQ(r.opcode, wire::kOpFinish);
    EXPECT_FALSE(walk.next(r));
    EXPECT_TRUE(walk.malformed());
    const uint32_t shortLong[] = {0xffff0000u | wire::kOpSwap, 1};
    wire::RecordWalk second(std::as_bytes(std::span(shortLong)));
    EXPECT_FALSE(second.next(r));
    EXPECT_TRUE(second.malformed());
    const uint32_t zero[] = {0};
    wire::RecordWalk third(std::as_bytes(std::span(zero)));
    EXPECT_FALSE(third.next(r));
    EXPECT_TRUE(third.malformed());
}

TEST(RecordedFrames, countTheMainWindowOnly) {
    WallFrames frames;
    EXPECT_EQ(
        frames.packet(wire::streamOf(1, 0), PacketBuilder().window(1, 10, 10).window(2, 20, 20).swap(1, 1).bytes()),
        1u);
    // the larger one is now the main window
    EXPECT_EQ(frames.packet(wire::streamOf(1, 0), PacketBuilder().swap(2, 2).swap(1, 3).bytes()), 1u);
    EXPECT_EQ(
        frames.packet(wire::streamOf(1, 0), PacketBuilder().record(wire::kOpDestroyWindow, {2}).swap(1, 4).bytes()),
        1u);
    EXPECT_EQ(frames.packet(wire::streamOf(1, 0), PacketBuilder().swap(1, 0).bytes()), 0u); // not shown
    EXPECT_EQ(frames.frames(), 3);
}

} // namespace
} // namespace mural::trace
