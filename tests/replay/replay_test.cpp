// Streams that no encoder writes: class Replay rejects them and keeps its state.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "encoders.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/replies.hpp"
#include "tests/fuzz/fake_gl.hpp"
#include "tests/interposer/encoder_harness.hpp"
#include "tests/recorded_log.hpp"

namespace mural {
namespace {

class ReplayTest : public ::testing::Test {
protected:
    void SetUp() override { start({}); }
    void start(const PlayerLimits& limits, const fuzz::FakeGlOptions& options = {}) {
        PlayerConfig config;
        config.limits = limits;
        PlayerOutputs out;
        out.answer = [this](const wire::ReplyPartHeader& h, std::span<const std::byte> b) {
            ++answers_;
            header_ = h;
            answerBytes_ = b.size();
        };
        out.frameDone = [this](const PlayerOutputs::Frame& f) {
            frame_ = f;
            pictureBytes_ = f.pixels ? static_cast<int64_t>(f.pixels(f.region) != nullptr) * f.region.area() * 4 : -1;
        };
        out.driverEvent = [this](const wire::DriverEvent& n, const std::string& text) {
            EXPECT_EQ(n.client, 1u);
            EXPECT_EQ(n.context, 1u);
            EXPECT_EQ(n.textBytes, text.size());
            driverEvents_.push_back(n);
            messageText_ = text;
        };
        replay_ = std::make_unique<Replay>(fuzz::makeFakePlatform(options), config, out);
    }

    // Sends the encoded records to the replay, as packets of that thread of client 1.
    bool send(uint32_t thread = 1) {
        bool ok = true;
        for (const auto& packet : encoder_.takePackets()) ok = replay_->packet(wire::streamOf(1, thread), packet) && ok;
        return ok;
    }
    bool sendWords(const std::vector<uint32_t>& words) {
        return replay_->packet(wire::streamOf(1, 1), std::as_bytes(std::span(words)));
    }
    static constexpr uint32_t head(uint32_t opcode, uint32_t words) { return opcode | words << 16; }

    void begin(uint32_t thread = 1, uint32_t id = 1) {
        wire::WindowConfig c{};
        c.width = 64;
        c.height = 32;
        c.doubleBuffer = 1;
        records::window(t_, id, c);
        records::createContext(t_, {id, 0, 0, 4, 5, 0, 0, c});
        records::makeCurrent(t_, id, id, id);
        ASSERT_TRUE(send(thread));
    }

    testing::EncoderHarness encoder_;
    ThreadState& t_ = encoder_.thread();
    std::unique_ptr<Replay> replay_;
    PlayerOutputs::Frame frame_{};
    wire::ReplyPartHeader header_{};
    int64_t pictureBytes_ = 0;
    size_t answerBytes_ = 0;
    int answers_ = 0;
    RecordedLog log_;
    std::vector<wire::DriverEvent> driverEvents_;
    std::string messageText_;
};

TEST_F(ReplayTest, deliversAFrame) {
    begin();
    encode_glClear(t_, GL_COLOR_BUFFER_BIT);
    records::swap(t_, 1, 7);
    EXPECT_TRUE(send());
    EXPECT_EQ(frame_.frame, 7u);
    EXPECT_EQ(pictureBytes_, 64 * 32 * 4);
    EXPECT_EQ(replay_->counts().malformed, 0u);
}

// A node that cannot create the program's context shows black. Its frames count, so the program does not wait for them.
TEST_F(ReplayTest, showsBlackWithoutAContext) {
    wire::WindowConfig c{};
    c.width = 64;
    c.height = 32;
    records::window(t_, 1, c);
    records::swap(t_, 1, 3);
    EXPECT_TRUE(send());
    EXPECT_EQ(frame_.frame, 3u);
    EXPECT_EQ(pictureBytes_, 64 * 32 * 4);
}

// GL never receives a name that it would reject: an error would reach the program, and GL_NONE would stay.
TEST_F(ReplayTest, passesOnlyBufferNamesOfTheSurface) {
    for (const auto& [buffers, only] :
         {std::pair{gl::ColorBuffers::OneNamedFront, GL_FRONT_LEFT}, {gl::ColorBuffers::OneNamedBack, GL_BACK}}) {
        std::vector<GLenum> named;
        fuzz::FakeGlOptions options;
        options.colorBuffers = buffers;
        options.namedBuffer = [&](unsigned name) { named.push_back(name); };
        start({}, options);
        begin();
        for (const GLenum name :
             {GL_NONE, GL_BACK, GL_FRONT, GL_FRONT_AND_BACK, GL_LEFT, GL_BACK_LEFT, GL_FRONT_LEFT}) {
            encode_glDrawBuffer(t_, name);
            encode_glReadBuffer(t_, name);
            encode_glDrawBuffers(t_, 1, DataArg::of(&name, sizeof name));
        }
        records::swap(t_, 1, 7);
        EXPECT_TRUE(send());
        EXPECT_GE(std::ranges::count(named, only), 18);
        EXPECT_GE(std::ranges::count(named, GL_NONE), 3);
        EXPECT_EQ(std::ranges::count(named, only) + std::ranges::count(named, GL_NONE), std::ssize(named));
    }
}

TEST_F(ReplayTest, endsThePacketAtABrokenHeader) {
    begin();
    EXPECT_FALSE(sendWords({head(op::glEnd, 0)}));
    EXPECT_FALSE(sendWords({head(op::glEnd, 2)}));
    EXPECT_FALSE(sendWords({head(op::glEnd, record::kLongForm)}));
    for (const uint32_t words : {0u, 1u, 3u, 0x40000000u, 0xffffffffu})
        EXPECT_FALSE(sendWords({head(op::glEnd, record::kLongForm), words})) << words;
    EXPECT_TRUE(sendWords({head(op::glEnd, record::kLongForm), 2}));
    EXPECT_FALSE(sendWords({head(60, 1)}));     // a control opcode that does not exist
    EXPECT_FALSE(sendWords({head(0xfff0, 1)})); // beyond all GL opcodes
    EXPECT_TRUE(sendWords({head(op::glEnd, 1)}));
    const std::byte odd[3] = {};
    EXPECT_FALSE(replay_->packet(wire::streamOf(1, 1), odd));
}

TEST_F(ReplayTest, rejectsShortArgumentsWithTheCommandsName) {
    begin();
    EXPECT_FALSE(sendWords({head(op::glVertex3f, 3), 0, 0}));
    EXPECT_NE(log_.text().find("glVertex3f"), std::string::npos) << log_.text();
    EXPECT_EQ(replay_->counts().malformed, 1u);
    EXPECT_TRUE(sendWords({head(op::glVertex3f, 4), 0, 0, 0}));
}

TEST_F(ReplayTest, rejectsCountsThatOverflow) {
    begin();
    // 0x10000001 matrices of 64 bytes: 16 bytes in 32-bit arithmetic.
    EXPECT_FALSE(sendWords({head(op::glUniformMatrix4fv, 9), 0, 0x10000001, 0, 16, 0, 0, 0, 0}));
    EXPECT_FALSE(sendWords({head(op::glUniform4fv, 8), 0, 0x40000001, 16, 0, 0, 0, 0}));
}

TEST_F(ReplayTest, keepsNegativeCountsFromTheDriver) {
    begin();
    const GLfloat values[8] = {};
    for (const GLsizei count : {2, 0, -1, -5, INT32_MIN}) {
        encode_glNamedProgramLocalParameters4fvEXT(t_, 1, GL_VERTEX_PROGRAM_ARB, 5, count,
                                                   DataArg::of(values, count > 0 ? uint64_t(count) * 16 : 0));
        EXPECT_TRUE(send()) << count;
    }
    EXPECT_TRUE(sendWords({head(op::glDeleteTextures, 4), 0xffffffff, 4, 1}));
    EXPECT_EQ(replay_->counts().malformed, 0u);
}

TEST_F(ReplayTest, rejectsOffsetsWhereOnlyBytesAreValid) {
    begin();
    EXPECT_FALSE(sendWords({head(op::glDeleteTextures, 5), 1, record::kTagOffset, 64, 0}));
    EXPECT_FALSE(sendWords({head(op::glCallLists, 6), 1, GL_UNSIGNED_BYTE, record::kTagOffset, 64, 0}));
}

TEST_F(ReplayTest, doesNotReplaceAContext) {
    begin();
    wire::WindowConfig c{};
    records::createContext(t_, {1, 0, 0, 4, 5, 0, 0, c});
    EXPECT_FALSE(send());
    records::createContext(t_, {0, 0, 0, 4, 5, 0, 0, c});
    EXPECT_FALSE(send());
    encode_glClear(t_, GL_COLOR_BUFFER_BIT);
    EXPECT_TRUE(send());
}

// The number proves that it was freed: it can be used again.
TEST_F(ReplayTest, keepsADestroyedContextUntilItIsReleased) {
    begin();
    wire::WindowConfig c{};
    records::destroyContext(t_, 1);
    encode_glClear(t_, GL_COLOR_BUFFER_BIT);
    records::swap(t_, 1, 1);
    EXPECT_TRUE(send());
    EXPECT_EQ(pictureBytes_, 64 * 32 * 4);
    records::createContext(t_, {1, 0, 0, 4, 5, 0, 0, c});
    EXPECT_FALSE(send());
    records::makeCurrent(t_, 0, 0, 0);
    records::createContext(t_, {1, 0, 0, 4, 5, 0, 0, c});
    EXPECT_TRUE(send());
}

TEST_F(ReplayTest, keepsTheShareGroupOfADestroyedContext) {
    begin(1, 1);
    wire::WindowConfig c{};
    records::createContext(t_, {2, 1, 0, 4, 5, 0, 0, c});
    records::destroyContext(t_, 1);
    records::makeCurrent(t_, 2, 1, 1);
    records::createContext(t_, {1, 2, 0, 4, 5, 0, 0, c}); // the first context no longer exists
    encode_glClear(t_, GL_COLOR_BUFFER_BIT);
    records::swap(t_, 1, 1);
    EXPECT_TRUE(send());
    EXPECT_EQ(pictureBytes_, 64 * 32 * 4);
}

TEST_F(ReplayTest, keepsADestroyedWindowUntilItIsReleased) {
    begin();
    records::destroyWindow(t_, 1);
    encode_glClear(t_, GL_COLOR_BUFFER_BIT);
    records::swap(t_, 1, 1);
    EXPECT_TRUE(send());
    EXPECT_EQ(pictureBytes_, 64 * 32 * 4);
    records::makeCurrent(t_, 1, 0, 0);
    records::swap(t_, 1, 2);
    EXPECT_TRUE(send());
    EXPECT_EQ(pictureBytes_, -1); // the window no longer exists
}

TEST_F(ReplayTest, changesAWindowUnderAnotherThreadsContext) {
    begin(1);
    wire::WindowConfig c{};
    c.width = 128;
    c.height = 32;
    c.doubleBuffer = 1;
    records::window(t_, 1, c);
    records::swap(t_, 1, 1);
    EXPECT_TRUE(send(2)); // a thread without a context
    encode_glClear(t_, GL_COLOR_BUFFER_BIT);
    records::swap(t_, 1, 2);
    EXPECT_TRUE(send(1));
    EXPECT_EQ(pictureBytes_, 128 * 32 * 4);
    records::swap(t_, 1, 3); // GLX permits any thread to swap any window
    EXPECT_TRUE(send(2));
    EXPECT_EQ(pictureBytes_, 128 * 32 * 4);
    replay_->clientGone(1);
    begin(1);
}

// GLX: one context draws into two windows, and swaps both while one is current.
TEST_F(ReplayTest, showsAWindowThatIsNotCurrent) {
    begin();
    wire::WindowConfig c{};
    c.width = 16;
    c.height = 8;
    c.doubleBuffer = 1;
    records::window(t_, 2, c);
    records::makeCurrent(t_, 1, 2, 2);
    encode_glClear(t_, GL_COLOR_BUFFER_BIT);
    records::makeCurrent(t_, 1, 1, 1);
    encode_glClear(t_, GL_COLOR_BUFFER_BIT);
    records::swap(t_, 2, 1);
    EXPECT_TRUE(send());
    EXPECT_EQ(frame_.window, 2u);
    EXPECT_EQ(pictureBytes_, 16 * 8 * 4);
    encode_glClear(t_, GL_COLOR_BUFFER_BIT);
    records::swap(t_, 1, 2);
    EXPECT_TRUE(send());
    EXPECT_EQ(frame_.window, 1u);
    EXPECT_EQ(pictureBytes_, 64 * 32 * 4);
    EXPECT_EQ(log_.text(), "");
}

// The context that drew may be destroyed, and the swap may come from a thread that never had one.
TEST_F(ReplayTest, showsAWindowWithoutItsContext) {
    begin();
    encode_glClear(t_, GL_COLOR_BUFFER_BIT);
    wire::WindowConfig c{};
    c.width = 16;
    c.height = 8;
    records::createContext(t_, {2, 0, 0, 4, 5, 0, 0, c});
    records::window(t_, 2, c);
    records::makeCurrent(t_, 2, 2, 2);
    records::destroyContext(t_, 1);
    EXPECT_TRUE(send(1));
    records::swap(t_, 1, 1);
    EXPECT_TRUE(send(2));
    EXPECT_EQ(frame_.window, 1u);
    EXPECT_EQ(pictureBytes_, 64 * 32 * 4);
    records::swap(t_, 2, 2);
    EXPECT_TRUE(send(1));
    EXPECT_EQ(pictureBytes_, 16 * 8 * 4);
}

TEST_F(ReplayTest, limitsBlobs) {
    start({.blobBytes = 1000});
    begin();
    records::blobBegin(t_, 1001);
    EXPECT_FALSE(send());
    const std::vector<std::byte> bytes(600);
    records::blobBegin(t_, 600);
    records::blobData(t_, bytes.data(), 600);
    EXPECT_TRUE(send());
    records::blobBegin(t_, 600);
    EXPECT_FALSE(send()) << "600 bytes wait already";
    EXPECT_TRUE(sendWords({head(op::glBufferData, 6), GL_ARRAY_BUFFER, 600, 0, record::kTagBlob, GL_STATIC_DRAW}));
    records::blobBegin(t_, 600);
    EXPECT_TRUE(send()) << "the others have been taken";
    records::blobBegin(t_, 0);
    EXPECT_FALSE(send()) << "the one before is not complete";
    start({});
    begin();
    int taken = 0;
    while (taken < 100000 && (records::blobBegin(t_, 0), send())) ++taken;
    EXPECT_LT(taken, 1000) << "empty blobs must not pile up";
}

TEST_F(ReplayTest, rejectsAnIncompleteBlob) {
    begin();
    records::blobBegin(t_, 8);
    EXPECT_TRUE(send());
    EXPECT_FALSE(sendWords({head(op::glBufferData, 6), GL_ARRAY_BUFFER, 8, 0, record::kTagBlob, GL_STATIC_DRAW}));
}

TEST_F(ReplayTest, endsListsThatCallThemselves) {
    start({.listCommands = 1000});
    begin();
    encode_glNewList(t_, 1, GL_COMPILE);
    encode_glCallList(t_, 1);
    encode_glCallList(t_, 1);
    encode_glEndList(t_);
    encode_glCallList(t_, 1);
    EXPECT_TRUE(send());
}

TEST_F(ReplayTest, keepsLargeValuesOfLists) {
    begin();
    const std::vector<std::byte> pixels(100 * 50 * 4, std::byte{1});
    encode_glNewList(t_, 1, GL_COMPILE);
    encode_glDrawPixels(t_, 100, 50, GL_RGBA, GL_UNSIGNED_BYTE, DataArg::of(pixels.data(), pixels.size()));
    encode_glEndList(t_);
    encode_glCallList(t_, 1);
    encode_glCallList(t_, 1);
    // The list has consumed the blob: the next value uses its own.
    const std::vector<std::byte> data(20000);
    encode_glBufferData(t_, GL_ARRAY_BUFFER, 20000, DataArg::of(data.data(), data.size()), GL_STATIC_DRAW);
    EXPECT_TRUE(send());
    EXPECT_FALSE(sendWords({head(op::glBufferData, 6), GL_ARRAY_BUFFER, 8, 0, record::kTagBlob, GL_STATIC_DRAW}))
        << "no blob is left over";
}

TEST_F(ReplayTest, limitsAndAnswersRequests) {
    start({.answerBytes = 1 << 16});
    begin();
    records::requestPixels(t_, 1, 2147483647, 2147483647, 100, 100, GL_RGBA, GL_UNSIGNED_BYTE, 4);
    EXPECT_TRUE(send());
    EXPECT_EQ(answers_, 1);
    EXPECT_EQ(answerBytes_, 0u);
    records::requestPixels(t_, 2, -10, -10, 100, 100, GL_RGBA, GL_UNSIGNED_BYTE, 4);
    EXPECT_TRUE(send());
    EXPECT_EQ(answerBytes_, 64u * 32 * 4);
    records::requestPixels(t_, 3, 0, 0, 2147483647, 2147483647, GL_RGBA, GL_UNSIGNED_BYTE, 4);
    EXPECT_FALSE(send());
    records::requestTexImage(t_, 4, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, (1 << 16) + 1);
    EXPECT_FALSE(send());
    EXPECT_EQ(answers_, 2);
}

TEST_F(ReplayTest, keepsClientArraysWithinTheirSpans) {
    begin();
    const std::vector<std::byte> span(120);
    const DataArg data = DataArg::of(span.data(), span.size());
    client_arrays::ArrayRecord a{client_arrays::kVertex, 3, GL_FLOAT, 0, 12, 0, 0, 0, 10};
    records::clientArrays(t_, &a, 1, &data, 1);
    EXPECT_TRUE(send());
    for (const auto& spoil : std::initializer_list<std::function<void(client_arrays::ArrayRecord&)>>{
             [](auto& r) { r.elementCount = 11; }, [](auto& r) { r.elementCount = 0; },
             [](auto& r) { r.elementCount = 0xffffffff; }, [](auto& r) { r.strideBytes = 0xffffffff; },
             [](auto& r) { r.offsetBytes = 4; }, [](auto& r) { r.span = 1; },
             [](auto& r) { r.slot = client_arrays::kSlots; }}) {
        client_arrays::ArrayRecord bad = a;
        spoil(bad);
        records::clientArrays(t_, &bad, 1, &data, 1);
        EXPECT_FALSE(send());
    }
}

TEST_F(ReplayTest, reportsExhaustedMemory) {
    start({}, {.largestTexture = 100});
    begin();
    encode_glTexImage2D(t_, GL_TEXTURE_2D, 0, GL_RGBA, 10, 10, 0, GL_RGBA, GL_UNSIGNED_BYTE, {});
    EXPECT_TRUE(send());
    EXPECT_TRUE(driverEvents_.empty());
    encode_glTexImage2D(t_, GL_TEXTURE_2D, 0, GL_RGBA, 11, 10, 0, GL_RGBA, GL_UNSIGNED_BYTE, {});
    records::swap(t_, 1, 1);
    EXPECT_TRUE(send());
    ASSERT_EQ(driverEvents_.size(), 1u); // the swap reports nothing further
    EXPECT_EQ(driverEvents_[0].kind, static_cast<uint32_t>(wire::DriverEventKind::OutOfMemory));
    EXPECT_EQ(driverEvents_[0].type, 0u);
    records::errorReported(t_);
    encode_glTexImage2D(t_, GL_TEXTURE_2D, 0, GL_RGBA, 11, 10, 0, GL_RGBA, GL_UNSIGNED_BYTE, {});
    EXPECT_TRUE(send());
    ASSERT_EQ(driverEvents_.size(), 2u);
    EXPECT_EQ(driverEvents_[1].type, 1u); // the program has received an error before
}

TEST_F(ReplayTest, reportsALostContextOnce) {
    start({}, {.resetStatus = GL_GUILTY_CONTEXT_RESET});
    begin();
    for (uint32_t frame = 1; frame < 4; ++frame) records::swap(t_, 1, frame);
    EXPECT_TRUE(send());
    ASSERT_EQ(driverEvents_.size(), 1u);
    EXPECT_EQ(driverEvents_[0].kind, static_cast<uint32_t>(wire::DriverEventKind::ContextLost));
    EXPECT_EQ(driverEvents_[0].type, GLenum{GL_GUILTY_CONTEXT_RESET});
    EXPECT_NE(log_.text().find("lost"), std::string::npos);
}

TEST_F(ReplayTest, reportsDriverMessagesWithDebugOutput) {
    start({}, {.talks = true});
    begin();
    encode_glDrawArrays(t_, GL_POINTS, 0, 1);
    EXPECT_TRUE(send());
    EXPECT_TRUE(driverEvents_.empty()); // debug output is off
    encode_glEnable(t_, GL_DEBUG_OUTPUT);
    encode_glDrawArrays(t_, GL_POINTS, 0, 1);
    EXPECT_TRUE(send());
    ASSERT_EQ(driverEvents_.size(), 1u); // the program already has its own messages
    EXPECT_EQ(driverEvents_[0].kind, static_cast<uint32_t>(wire::DriverEventKind::DebugMessage));
    EXPECT_EQ(driverEvents_[0].source, GLenum{GL_DEBUG_SOURCE_API});
    EXPECT_EQ(messageText_, "a slow draw");
}

TEST_F(ReplayTest, keepsLabelsWithinTheirRecord) {
    begin();
    const std::string text(30, 'x');
    encode_glObjectLabel(t_, GL_TEXTURE, 1, 30, DataArg::of(text.data(), 30));
    encode_glObjectLabel(t_, GL_TEXTURE, 1, -1, DataArg::text(text.c_str()));
    encode_glObjectLabel(t_, GL_TEXTURE, 1, 0, {});
    encode_glPushDebugGroup(t_, GL_DEBUG_SOURCE_APPLICATION, 1, -1, DataArg::of(text.data(), 30)); // not terminated
    EXPECT_TRUE(send());
    encode_glObjectLabel(t_, GL_TEXTURE, 1, 31, DataArg::of(text.data(), 30));
    EXPECT_FALSE(send());
}

TEST_F(ReplayTest, ignoresGlWithoutAContext) {
    encode_glClear(t_, GL_COLOR_BUFFER_BIT);
    records::swap(t_, 1, 1);
    EXPECT_TRUE(send());
    EXPECT_EQ(pictureBytes_, -1);
}

// ---- texture handles: this node's driver numbers them differently than the program's

struct OtherHandles {
    std::vector<GLuint64> resident, notResident, uniforms;
    GLuint64 attribute = 0, next = 100;
    GLenum access = 0;
};
OtherHandles other;

class HandlesTest : public ReplayTest {
protected:
    void SetUp() override {
        ReplayTest::SetUp();
        begin();
        other = {};
        GlFunctions& gl = replay_->gl;
        gl.glGetTextureHandleARB = [](GLuint) { return other.next++; };
        gl.glGetTextureSamplerHandleARB = [](GLuint, GLuint) { return other.next++; };
        gl.glGetImageHandleARB = [](GLuint, GLint, GLboolean, GLint, GLenum) { return other.next++; };
        gl.glMakeTextureHandleResidentARB = [](GLuint64 h) { other.resident.push_back(h); };
        gl.glMakeTextureHandleNonResidentARB = [](GLuint64 h) { other.notResident.push_back(h); };
        gl.glMakeImageHandleResidentARB = [](GLuint64 h, GLenum access) {
            other.resident.push_back(h), other.access = access;
        };
        gl.glMakeImageHandleNonResidentARB = [](GLuint64 h) { other.notResident.push_back(h); };
        gl.glUniformHandleui64ARB = [](GLint, GLuint64 h) { other.uniforms.push_back(h); };
        gl.glUniformHandleui64vARB = [](GLint, GLsizei n, const GLuint64* h) {
            other.uniforms.insert(other.uniforms.end(), h, h + n);
        };
        gl.glProgramUniformHandleui64ARB = [](GLuint, GLint, GLuint64 h) { other.uniforms.push_back(h); };
        gl.glProgramUniformHandleui64vARB = [](GLuint, GLint, GLsizei n, const GLuint64* h) {
            other.uniforms.insert(other.uniforms.end(), h, h + n);
        };
        gl.glVertexAttribL1ui64ARB = [](GLuint, GLuint64EXT h) { other.attribute = h; };
    }
};

TEST_F(HandlesTest, mapsHandlesInEveryCommand) {
    encode_glGetTextureHandleARB(t_, 1, 7);                         // 100
    encode_glGetTextureSamplerHandleARB(t_, 1, 2, 8);               // 101
    encode_glGetImageHandleARB(t_, 1, 0, GL_FALSE, 0, GL_RGBA8, 9); // 102
    encode_glMakeTextureHandleResidentARB(t_, 8);
    encode_glMakeImageHandleResidentARB(t_, 9, GL_READ_WRITE);
    encode_glMakeTextureHandleNonResidentARB(t_, 7);
    encode_glMakeImageHandleNonResidentARB(t_, 9);
    const GLuint64 several[] = {8, 7, 3};
    encode_glUniformHandleui64ARB(t_, 0, 7);
    encode_glUniformHandleui64vARB(t_, 0, 3, DataArg::of(several, sizeof several));
    encode_glProgramUniformHandleui64ARB(t_, 1, 0, 9);
    encode_glProgramUniformHandleui64vARB(t_, 1, 0, 2, DataArg::of(several, 16));
    encode_glVertexAttribL1ui64ARB(t_, 3, 8);
    EXPECT_TRUE(send());
    EXPECT_EQ(other.resident, (std::vector<GLuint64>{101, 102}));
    EXPECT_EQ(other.access, GLenum{GL_READ_WRITE});
    EXPECT_EQ(other.notResident, (std::vector<GLuint64>{100, 102}));
    EXPECT_EQ(other.uniforms, (std::vector<GLuint64>{100, 101, 100, 3, 102, 101, 100}));
    EXPECT_EQ(other.attribute, 101u);
    const GLuint64 one = 7;
    encode_glVertexAttribL1ui64vARB(t_, 3, DataArg::of(&one, 8));
    EXPECT_TRUE(send());
    EXPECT_EQ(other.attribute, 100u);
}

TEST_F(HandlesTest, reportsUnmappedMemoryInOneLine) {
    other.next = 7;
    encode_glGetTextureHandleARB(t_, 1, 7);
    EXPECT_TRUE(send());
    EXPECT_EQ(log_.text(), "");
    encode_glGetTextureHandleARB(t_, 2, 9);
    encode_glGetTextureHandleARB(t_, 3, 10);
    EXPECT_TRUE(send());
    EXPECT_EQ(log_.texts().size(), 1u) << log_.text();
    EXPECT_NE(log_.text().find("0x8 for 0x9"), std::string::npos) << log_.text();
}

TEST_F(HandlesTest, makesNoUnknownHandleResident) {
    encode_glMakeTextureHandleResidentARB(t_, 100);
    encode_glMakeImageHandleResidentARB(t_, 100, GL_READ_ONLY);
    EXPECT_TRUE(send());
    EXPECT_TRUE(other.resident.empty());
}

TEST_F(HandlesTest, rejectsCountsThatAreTooLarge) {
    EXPECT_FALSE(sendWords({head(op::glUniformHandleui64vARB, 6), 0, 0x20000001, 8, 0, 0}));
    EXPECT_TRUE(other.uniforms.empty());
}

// ---- pages of sparse textures: this node's driver has larger ones than the program's

struct OtherPages {
    std::vector<std::array<GLint, 7>> commits; // x, y, z, sizes, commit
    std::vector<std::array<GLint64, 3>> buffers;
    GLenum error = 0;
};
OtherPages pages;

class PagesTest : public ReplayTest {
protected:
    static constexpr GLint kPage = 64, kWidth = 100, kHeight = 256; // the last page of a row is cut off
    void SetUp() override {
        ReplayTest::SetUp();
        begin();
        pages = {};
        GlFunctions& gl = replay_->gl;
        gl.glGetError = [] { return std::exchange(pages.error, GLenum{GL_NO_ERROR}); };
        gl.glTexPageCommitmentARB = [](GLenum, GLint, GLint x, GLint y, GLint z, GLsizei w, GLsizei h, GLsizei d,
                                       GLboolean commit) {
            const bool fits = x % kPage == 0 && y % kPage == 0 && (w % kPage == 0 || x + w == kWidth) &&
                              (h % kPage == 0 || y + h == kHeight);
            if (fits)
                pages.commits.push_back({x, y, z, w, h, d, commit});
            else
                pages.error = GL_INVALID_VALUE;
        };
        gl.glGetInternalformativ = [](GLenum, GLenum, GLenum name, GLsizei, GLint* value) {
            *value = name == GL_VIRTUAL_PAGE_SIZE_Z_ARB ? 1 : kPage;
        };
        gl.glGetTexParameteriv = [](GLenum, GLenum, GLint* value) { *value = 0; };
        gl.glGetTexLevelParameteriv = [](GLenum, GLint, GLenum name, GLint* value) {
            *value = name == GL_TEXTURE_WIDTH ? kWidth : name == GL_TEXTURE_HEIGHT ? kHeight : GL_RGBA8;
        };
        gl.glGetIntegerv = [](GLenum, GLint* value) { *value = kPage; };
        gl.glGetBufferParameteri64v = [](GLenum, GLenum, GLint64* value) { *value = 200; };
        gl.glBufferPageCommitmentARB = [](GLenum, GLintptr offset, GLsizeiptr size, GLboolean commit) {
            pages.buffers.push_back({offset, size, commit});
        };
    }
    void commit(GLint x, GLint y, GLsizei w, GLsizei h, GLboolean committed) {
        encode_glTexPageCommitmentARB(t_, GL_TEXTURE_2D, 0, x, y, 2, w, h, 1, committed);
        EXPECT_TRUE(send());
    }
};

TEST_F(PagesTest, keepsCommitmentsOnPageBorders) {
    commit(64, 128, 36, 64, GL_TRUE);
    commit(64, 128, 36, 64, GL_FALSE);
    EXPECT_EQ(pages.commits,
              (std::vector<std::array<GLint, 7>>{{64, 128, 2, 36, 64, 1, 1}, {64, 128, 2, 36, 64, 1, 0}}));
}

TEST_F(PagesTest, extendsCommitmentsToPagesAndReleasesNone) {
    commit(32, 96, 32, 32, GL_TRUE);
    commit(80, 0, 16, 16, GL_TRUE);
    commit(32, 96, 32, 32, GL_FALSE);
    EXPECT_EQ(pages.commits, (std::vector<std::array<GLint, 7>>{{0, 64, 2, 64, 64, 1, 1}, {64, 0, 2, 36, 64, 1, 1}}));
    EXPECT_EQ(log_.text(), "");
}

TEST_F(PagesTest, reportsMissingPagesInOneLine) {
    replay_->gl.glGetInternalformativ = [](GLenum, GLenum, GLenum, GLsizei, GLint*) {};
    commit(32, 96, 32, 32, GL_TRUE);
    commit(32, 96, 32, 32, GL_TRUE);
    EXPECT_TRUE(pages.commits.empty());
    EXPECT_EQ(log_.texts().size(), 1u) << log_.text();
}

TEST_F(PagesTest, supportsBuffers) {
    const auto commitBuffer = [&](GLintptr offset, GLsizeiptr size, GLboolean committed) {
        encode_glBufferPageCommitmentARB(t_, GL_ARRAY_BUFFER, offset, size, committed);
        EXPECT_TRUE(send());
    };
    commitBuffer(64, 128, GL_TRUE);
    commitBuffer(16, 64, GL_TRUE);
    commitBuffer(16, 64, GL_FALSE);
    commitBuffer(192, 8, GL_FALSE); // up to the end
    commitBuffer(160, 40, GL_TRUE);
    commitBuffer(160, 80, GL_TRUE); // beyond it
    EXPECT_EQ(pages.buffers,
              (std::vector<std::array<GLint64, 3>>{{64, 128, 1}, {0, 128, 1}, {192, 8, 0}, {128, 72, 1}}));
}

} // namespace
} // namespace mural
