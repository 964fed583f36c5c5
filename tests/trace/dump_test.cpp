// Records as text, and the selection of records.
#include <GL/gl.h>
#include <GL/glext.h>
#include <gtest/gtest.h>

#include "gl_opcodes.hpp"
#include "streamcodec/trace/dump/dump.hpp"
#include "streamcodec/trace/dump/record_text.hpp"
#include "streamcodec/trace/dump/value_text.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "tests/trace/recorded.hpp"

namespace mural::trace {
namespace {

std::string textOf(uint16_t opcode, const std::vector<uint32_t>& arguments) {
    PacketBuilder packet;
    packet.record(opcode, arguments);
    wire::RecordWalk walk(packet.bytes());
    wire::RecordView r;
    StreamBlobs blobs;
    return walk.next(r) ? recordText(r, blobs) : "no record";
}

TEST(RecordText, namesEnumsByTheirGroup) {
    EXPECT_EQ(textOf(op::glBegin, {GL_TRIANGLES}), "glBegin(mode=GL_TRIANGLES)");
    EXPECT_EQ(textOf(op::glBlendFunc, {GL_ONE, GL_ZERO}), "glBlendFunc(sfactor=GL_ONE, dfactor=GL_ZERO)");
    EXPECT_EQ(textOf(op::glClear, {0x4000 | 0x80000000}), "glClear(mask=GL_COLOR_BUFFER_BIT|0x80000000)");
    EXPECT_EQ(textOf(op::glBegin, {0xabcdef}), "glBegin(mode=0xabcdef)");
    EXPECT_EQ(textOf(op::glDepthMask, {1}), "glDepthMask(flag=GL_TRUE)");
}

TEST(RecordText, showsValuesAndTexts) {
    EXPECT_EQ(textOf(op::glVertex2f, {0x3f800000, 0xbf000000}), "glVertex2f(x=1, y=-0.5)");
    EXPECT_EQ(textOf(op::glVertex2fv, {0x3f800000, 0xbf000000}), "glVertex2fv(v=[1, -0.5])");
    EXPECT_EQ(textOf(op::glDeleteTextures, {2, 8, 5, 6}), "glDeleteTextures(n=2, textures=[5, 6])");
    EXPECT_EQ(textOf(op::glDeleteTextures, {2, record::kTagNull}), "glDeleteTextures(n=2, textures=NULL)");
    EXPECT_EQ(textOf(op::glDrawElements, {GL_LINES, 2, GL_UNSIGNED_BYTE, record::kTagOffset, 16, 0}),
              "glDrawElements(mode=GL_LINES, count=2, type=GL_UNSIGNED_BYTE, indices=offset 16)");
    EXPECT_EQ(textOf(op::glShaderSource, {3, 1, 8, 4, 0x0a226f76}),
              "glShaderSource(shader=3, count=1, string=[\"vo\\\"\\n\"])");
    EXPECT_EQ(textOf(op::glCreateShader, {GL_VERTEX_SHADER, 9}), "glCreateShader(type=GL_VERTEX_SHADER, made=9)");
    EXPECT_EQ(textOf(wire::kOpSwap, {1, 5}), "Mural.Swap(window=1, frame=5)");
}

TEST(RecordText, marksMalformedRecords) {
    EXPECT_EQ(textOf(op::glVertex2f, {0}), "glVertex2f(x=0, y=0), malformed");
    EXPECT_EQ(textOf(op::glDeleteTextures, {2, 400, 5}), "glDeleteTextures(n=2, textures=NULL), malformed");
    EXPECT_EQ(textOf(op::glDeleteTextures, {2, record::kTagBlob}), "glDeleteTextures(n=2, textures=NULL), malformed");
    EXPECT_EQ(textOf(60, {0}), "opcode 60(4 bytes), unknown");
    EXPECT_EQ(textOf(wire::kOpClientArrays, {1000, 1}), "Mural.ClientArrays(malformed)");
}

TEST(ValueText, isShortForLongValues) {
    const std::vector<uint16_t> many(1000, 7);
    EXPECT_EQ(arrayText(Element::U16, 0, std::as_bytes(std::span(many))),
              "[7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, … 1000 in all]");
    EXPECT_EQ(arrayText(Element::Bytes, 0, std::as_bytes(std::span(many))), "<2000 bytes>");
    const std::string text(200, 'x');
    EXPECT_EQ(quoted(std::as_bytes(std::span(text))), "\"" + std::string(120, 'x') + "…\" (200 bytes)");
}

// Two frames of a program, and records after them.
class Dumped : public ::testing::Test {
protected:
    void write(const PacketBuilder& behind) {
        auto writer = TraceWriter::create("/proc/self/fd/" + std::to_string(file_.get()));
        ASSERT_TRUE(writer);
        ASSERT_TRUE((*writer)->begin({}, wire::kVersion, registryDigest()));
        const auto append = [&](const PacketBuilder& packet) {
            ASSERT_TRUE((*writer)->append({wire::streamOf(1, 0), 0, packet.bytes()}));
        };
        append(PacketBuilder().window(1, 20, 10).record(op::glClear, {GL_COLOR_BUFFER_BIT}).swap(1, 1));
        append(PacketBuilder().record(op::glDepthMask, {1}).swap(1, 2).append(behind));
        ASSERT_TRUE((*writer)->flush());
        ASSERT_TRUE((*writer)->finish());
        auto opened = TraceReader::open(FileDescriptor(dup(file_.get())), "in memory");
        ASSERT_TRUE(opened);
        reader_ = std::move(*opened);
    }
    std::string errorOf(int64_t lastFrame) {
        const auto there = checkFrames(*reader_, lastFrame);
        return there ? "" : there.error().message;
    }
    std::vector<std::string> absent(const DumpOptions& options) {
        auto dumped = dump(*reader_, options, [](const std::string&) { return true; });
        EXPECT_TRUE(dumped);
        return dumped ? dumped->absent : std::vector<std::string>();
    }

    const FileDescriptor file_{memfd_create("dumped", MFD_CLOEXEC)};
    std::unique_ptr<TraceReader> reader_;
};

TEST_F(Dumped, reportsMissingFrames) {
    write({});
    EXPECT_EQ(errorOf(2), "");
    for (const int64_t last : {int64_t{3}, int64_t{99}, INT64_MAX})
        EXPECT_EQ(errorOf(last), "the trace has 2 frames; choose some of them, such as 1-2") << last;
}

TEST_F(Dumped, treatsRecordsAfterTheLastFrameAsOneMore) {
    write(PacketBuilder().record(op::glFlush, {}));
    EXPECT_EQ(errorOf(3), "");
    EXPECT_EQ(errorOf(4), "the trace has 2 frames; choose some of them, such as 1-2");
}

TEST_F(Dumped, reportsMissingCalls) {
    write({});
    DumpOptions options;
    options.calls = {"glClear", "glTexImage*", "glDepth*", "Mural.FillWindow"};
    const std::vector<std::string> never{"glTexImage*", "Mural.FillWindow"};
    EXPECT_EQ(absent(options), never);
    options.summary = true;
    EXPECT_EQ(absent(options), never);
    options.firstFrame = options.lastFrame = 2;
    EXPECT_EQ(absent(options), (std::vector<std::string>{"glClear", "glTexImage*", "Mural.FillWindow"}));
    options.calls.clear();
    EXPECT_EQ(absent(options), std::vector<std::string>());
}

TEST(DumpedCalls, haveKnownNames) {
    for (const char* pattern : {"glClear", "glTexImage*", "*Vertex*", "Mural.Swap", "Mural.*", "*", "glGetError"})
        EXPECT_TRUE(fitsSomeCall(pattern)) << pattern;
    for (const char* pattern : {"nosuch", "glclear", "Swap", "glClear*Nothing", "glXSwapBuffers", " glClear", ""})
        EXPECT_FALSE(fitsSomeCall(pattern)) << pattern;
}

} // namespace
} // namespace mural::trace
