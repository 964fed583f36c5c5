// The draws that `mural trim` drops, and the draws that it must keep.
#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>
#include <deque>
#include <filesystem>
#include <gtest/gtest.h>

#include "gl_opcodes.hpp"
#include "streamcodec/trace/dump/dump.hpp"
#include "streamcodec/trace/trim/trim.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "tests/trace/recorded.hpp"

namespace mural::trace {
namespace {

constexpr uint32_t kAll = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;

class Trim : public ::testing::Test {
protected:
    Trim() : folder_(std::filesystem::temp_directory_path() / ("mural-trim-test." + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder_);
        begin().context(1).window(1, 20, 10).record(wire::kOpMakeCurrent, {1, 1, 1});
    }
    ~Trim() override { std::filesystem::remove_all(folder_); }

    // Starts the next packet of the program's first thread.
    PacketBuilder& begin() { return packets_.emplace_back(); }
    PacketBuilder& clear(uint32_t mask = kAll) { return begin().record(op::glClear, {mask}); }
    void draw() { begin().record(op::glDrawArrays, {GL_TRIANGLES, 0, 3}); }
    void swap() { begin().swap(1, ++frame_); }
    void frame(uint32_t mask = kAll) {
        if (mask != 0) clear(mask);
        draw();
        swap();
    }

    // The remaining calls of the frames first to last, as printed by `mural dump`.
    std::vector<std::string> trimmed(int64_t first, int64_t last) {
        const std::string whole = (folder_ / "a").string(), part = (folder_ / "b").string();
        auto writer = TraceWriter::create(whole);
        EXPECT_TRUE((*writer)->begin({}, wire::kVersion, registryDigest()));
        for (const PacketBuilder& p : packets_) EXPECT_TRUE((*writer)->append({wire::streamOf(1, 0), 0, p.bytes()}));
        EXPECT_TRUE((*writer)->flush());
        EXPECT_TRUE((*writer)->finish());
        auto reader = TraceReader::open(whole);
        auto report = trim(**reader, first, last, part);
        error_ = report ? "" : report.error().message;
        if (report) report_ = *report;
        if (!report) return {};
        auto result = TraceReader::open(part);
        std::vector<std::string> lines;
        EXPECT_TRUE(dump(**result, {}, [&](const std::string& line) {
            lines.push_back(line.substr(line.find_first_not_of(" 0123456789.")));
            return true;
        }));
        frames_ = (*result)->frames();
        return lines;
    }
    uint64_t dropped(int64_t first, int64_t last) {
        trimmed(first, last);
        return (report_.drawsBefore - report_.drawsWritten);
    }

    const std::filesystem::path folder_;
    std::deque<PacketBuilder> packets_;
    uint32_t frame_ = 0;
    TrimReport report_;
    std::string error_;
    int64_t frames_ = 0;
};

TEST_F(Trim, dropsDrawsThatALaterClearCovers) {
    for (int i = 0; i < 4; ++i) frame();
    const auto lines = trimmed(3, 3);
    const std::vector<std::string> wanted{
        "Mural.CreateContext(context=1, share=0, api=0, major=0, minor=0, profile=0x0, flags=0x0, config=0x0 rgba "
        "0,0,0,0 depth 0 stencil 0 samples 0 single)",
        "Mural.Window(window=1, config=20x10 rgba 8,8,8,0 depth 0 stencil 0 samples 0 double)",
        "Mural.MakeCurrent(context=1, draw=1, read=1)",
        "glClear(mask=GL_DEPTH_BUFFER_BIT|GL_STENCIL_BUFFER_BIT|GL_COLOR_BUFFER_BIT)",
        "glDrawArrays(mode=GL_TRIANGLES, first=0, count=3)",
        "Mural.Swap(window=1, frame=1)"};
    EXPECT_EQ(lines, wanted);
    EXPECT_EQ(frames_, 1);
    EXPECT_EQ((report_.drawsBefore - report_.drawsWritten), 2u);
    EXPECT_EQ(report_.drawsBefore, 2u);
}

TEST_F(Trim, keepsAllOfTheFirstFrames) {
    for (int i = 0; i < 4; ++i) frame();
    EXPECT_EQ(dropped(1, 2), 0u);
    EXPECT_EQ(frames_, 2);
}

TEST_F(Trim, keepsDrawsThatNoClearCovers) {
    frame();
    frame(0);
    frame(0);
    EXPECT_EQ(dropped(3, 3), 0u);
    frame(); // a clear covers this one
    EXPECT_EQ(dropped(4, 4), 3u);
}

TEST_F(Trim, keepsDepthOnceItIsTested) {
    begin().window(1, 20, 10, 24);
    for (int i = 0; i < 3; ++i) frame(GL_COLOR_BUFFER_BIT);
    EXPECT_EQ(dropped(3, 3), 2u);
    begin().record(op::glEnable, {GL_DEPTH_TEST});
    for (int i = 0; i < 3; ++i) frame(GL_COLOR_BUFFER_BIT); // frames 4 to 6
    EXPECT_EQ(dropped(6, 6), 3u);                           // those before the test was enabled
    clear(GL_DEPTH_BUFFER_BIT);
    frame(GL_COLOR_BUFFER_BIT);
    EXPECT_EQ(dropped(7, 7), 6u);
}

TEST_F(Trim, ignoresClearsWithScissorOrMask) {
    begin().record(op::glEnable, {GL_SCISSOR_TEST});
    for (int i = 0; i < 3; ++i) frame();
    EXPECT_EQ(dropped(3, 3), 0u);
    begin().record(op::glDisable, {GL_SCISSOR_TEST}).record(op::glColorMask, {1, 1, 0, 1});
    frame();
    EXPECT_EQ(dropped(4, 4), 0u);
    begin().record(op::glColorMask, {1, 1, 1, 1});
    frame();
    EXPECT_EQ(dropped(5, 5), 4u);
    begin().record(op::glPushAttrib, {0xffffffff}).record(op::glPopAttrib, {});
    frame();
    EXPECT_EQ(dropped(6, 6), 5u);
    begin().record(op::glPushAttrib, {GL_COLOR_BUFFER_BIT}).record(op::glColorMask, {1, 0, 1, 1});
    frame();
    begin().record(op::glPopAttrib, {});
    EXPECT_EQ(dropped(7, 7), 5u);
    frame();
    EXPECT_EQ(dropped(8, 8), 7u);
}

TEST_F(Trim, keepsDrawsThatAreRead) {
    frame();
    begin().record(op::glCopyTexSubImage2D, {GL_TEXTURE_2D, 0, 0, 0, 0, 0, 4, 4});
    frame();
    frame();
    EXPECT_EQ(dropped(3, 3), 1u); // of the second frame
}

TEST_F(Trim, keepsDrawsToOtherTargets) {
    begin()
        .record(op::glGenTextures, {1, 4, 5})
        .record(op::glBindTexture, {GL_TEXTURE_2D, 5})
        .record(op::glBindFramebuffer, {GL_FRAMEBUFFER, 7});
    begin().record(op::glFramebufferTexture2D, {GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 5, 0});
    draw();
    begin().record(op::glBindFramebuffer, {GL_FRAMEBUFFER, 0});
    frame();
    frame();
    EXPECT_EQ(dropped(2, 2), 1u);
}

TEST_F(Trim, keepsQueriesAndFeedback) {
    begin().record(op::glBeginQuery, {GL_SAMPLES_PASSED, 1});
    draw();
    begin().record(op::glEndQuery, {GL_SAMPLES_PASSED}).record(op::glBeginTransformFeedback, {GL_POINTS});
    draw();
    begin().record(op::glEndTransformFeedback, {}).record(op::glNewList, {1, GL_COMPILE});
    draw();
    begin().record(op::glEndList, {});
    frame();
    frame();
    EXPECT_EQ(dropped(2, 2), 2u); // draws of the query and of the list stay; the transform feedback has no buffer
}

TEST_F(Trim, keepsEverythingBeforeAnUnknownCommand) {
    for (int i = 0; i < 3; ++i) frame();
    begin().record(op::glConvolutionParameterfEXT, {0, 0, 0}); // no rule names it
    frame();
    EXPECT_EQ(dropped(4, 4), 2u); // it may depend on the third frame
    EXPECT_EQ(dropped(3, 3), 2u);
}

TEST_F(Trim, dropsVerticesAndKeepsCurrentValues) {
    clear()
        .record(op::glBegin, {GL_TRIANGLES})
        .record(op::glColor3f, {0, 0, 0})
        .record(op::glVertex2f, {0, 0})
        .record(op::glEnd, {});
    swap();
    frame();
    const auto lines = trimmed(2, 2);
    EXPECT_EQ((report_.drawsBefore - report_.drawsWritten), 1u);
    EXPECT_EQ(std::ranges::count_if(lines, [](const auto& l) { return l.starts_with("glColor3f"); }), 1);
    EXPECT_EQ(std::ranges::count_if(lines, [](const auto& l) { return l.starts_with("glVertex2f"); }), 0);
    EXPECT_EQ(std::ranges::count_if(lines, [](const auto& l) { return l.starts_with("glBegin"); }), 0);
}

TEST_F(Trim, dropsBlobsWithTheirDraw) {
    begin().record(op::glGenBuffers, {1, 4, 1});
    // Two blobs: the first belongs to a draw, the second to a buffer.
    begin()
        .record(wire::kOpBlobBegin, {4, 0})
        .record(wire::kOpBlobData, {4, 11})
        .record(op::glDrawElements, {GL_TRIANGLES, 1, GL_UNSIGNED_INT, record::kTagBlob});
    begin()
        .record(wire::kOpBlobBegin, {4, 0})
        .record(wire::kOpBlobData, {4, 22})
        .record(wire::kOpBufferBytes, {1, 0, 0, record::kTagBlob});
    frame();
    frame();
    const auto lines = trimmed(2, 2);
    EXPECT_EQ((report_.drawsBefore - report_.drawsWritten), 2u);
    EXPECT_EQ(std::ranges::count_if(lines, [](const auto& l) { return l.starts_with("Mural.BlobBegin"); }), 1);
    EXPECT_TRUE(std::ranges::none_of(lines, [](const auto& l) { return l.find("malformed") != std::string::npos; }));
    EXPECT_EQ(std::ranges::count(lines, "Mural.BufferBytes(buffer=1, offset=0, bytes=<4 bytes>)"), 1);
}

TEST_F(Trim, reportsMissingFrames) {
    frame();
    trimmed(1, 2);
    EXPECT_EQ(error_, "the trace has 1 frames; choose some of them, such as 1-1");
}

TEST_F(Trim, explainsTracesWithoutFrames) {
    draw();
    trimmed(2, 5);
    EXPECT_EQ(error_, "trace " + (folder_ / "a").string() +
                          " has no frame, because its program showed no picture; mural dump prints its calls");
}

TEST_F(Trim, keepsFramesBeforeADamagedBlock) {
    const std::string whole = (folder_ / "a").string(), part = (folder_ / "b").string();
    frame();
    frame();
    auto writer = TraceWriter::create(whole);
    ASSERT_TRUE((*writer)->begin({}, wire::kVersion, registryDigest()));
    for (const PacketBuilder& p : packets_) ASSERT_TRUE((*writer)->append({wire::streamOf(1, 0), 0, p.bytes()}));
    ASSERT_TRUE((*writer)->flush());
    ASSERT_TRUE((*writer)->append({wire::streamOf(1, 0), 0, PacketBuilder().swap(1, 3).bytes()}));
    ASSERT_TRUE((*writer)->flush());
    ASSERT_TRUE((*writer)->finish());
    Bytes changed = readWhole(whole);
    changed[(*TraceReader::open(whole))->blocks()[1].offset] ^= std::byte{0xff}; // no longer a block
    auto reader = readerOf(changed);
    ASSERT_TRUE(reader) << reader.error().message;
    const auto tooMany = trim(**reader, 1, 3, part);
    ASSERT_FALSE(tooMany);
    EXPECT_NE(tooMany.error().message.find("mural trim in memory 1-2 -o good.mural"), std::string::npos)
        << tooMany.error().message;
    const auto good = trim(**reader, 1, 2, part); // as the message advises
    ASSERT_TRUE(good) << good.error().message;
    EXPECT_TRUE((*TraceReader::open(part))->verify());
    EXPECT_EQ((*TraceReader::open(part))->frames(), 2);
}

} // namespace
} // namespace mural::trace
