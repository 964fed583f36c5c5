// What is kept of a stream for nodes that come late, command by command.
#include <gtest/gtest.h>

#include "gl_opcodes.hpp"
#include "recording/kept/kept_stream.hpp"
#include "tests/recording/recorded.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>

namespace mural::recording {
namespace {

constexpr uint32_t kStream = wire::streamOf(1, 0);

class Kept : public testing::Test {
protected:
    Kept() {
        PacketBuilder p;
        p.context(1).window(1, 20, 10).record(wire::kOpMakeCurrent, {1, 1, 1});
        give(p);
    }
    void give(const PacketBuilder& packet) { stream_.append(kStream, packet.bytes()); }
    // How many of these commands are left.
    size_t left(uint16_t opcode) {
        size_t n = 0;
        for (const KeptPacket& packet : stream_.snapshot()) {
            RecordWalk walk(packet.payload);
            RecordView r;
            while (walk.next(r)) n += r.opcode == opcode;
            EXPECT_FALSE(walk.malformed());
        }
        return n;
    }
    void frame() { give(PacketBuilder().record(op::glClear, {GL_COLOR_BUFFER_BIT}).record(op::glDrawArrays, {GL_TRIANGLES, 0, 3}).swap(1, ++frame_)); }

    std::vector<std::string> said_;
    KeptStream stream_{size_t{1} << 20, [this](const std::string& line) { said_.push_back(line); }};
    uint32_t frame_ = 0;
};

TEST_F(Kept, staysAsLargeAsOneFrame) {
    for (int i = 0; i < 10'000; ++i) frame();
    EXPECT_EQ(left(op::glDrawArrays), 1u);
    EXPECT_EQ(left(op::glClear), 1u);
    EXPECT_EQ(left(wire::kOpSwap), 1u);
    EXPECT_TRUE(said_.empty());
}

TEST_F(Kept, swapsAreSeenByNobody) {
    frame();
    for (const KeptPacket& packet : stream_.snapshot()) {
        RecordWalk walk(packet.payload);
        RecordView r;
        while (walk.next(r)) EXPECT_TRUE(r.opcode != wire::kOpSwap || argumentWord(r, 1) == wire::kUnseenFrame);
    }
}

TEST_F(Kept, whatIsMadeAndDeletedGoesWithItsNames) {
    for (int i = 0; i < 5; ++i) {
        give(PacketBuilder().record(op::glGenBuffers, {1, 4, 9}).record(op::glBindBuffer, {GL_ARRAY_BUFFER, 9}).record(op::glBufferData, {GL_ARRAY_BUFFER, 4, 0, 4, 1, GL_STATIC_DRAW}));
        give(PacketBuilder().record(op::glBindBuffer, {GL_ARRAY_BUFFER, 0}).record(op::glDeleteBuffers, {1, 4, 9}));
    }
    EXPECT_EQ(left(op::glGenBuffers), 0u);
    EXPECT_EQ(left(op::glBufferData), 0u);
    EXPECT_EQ(left(op::glDeleteBuffers), 0u);
}

TEST_F(Kept, proxiesOnlyAsk) {
    const auto image = [](uint32_t target) { return PacketBuilder().record(op::glTexImage2D, {target, 0, GL_RGBA, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, 4, 7}); };
    give(PacketBuilder().record(op::glGenTextures, {1, 4, 9}).record(op::glBindTexture, {GL_TEXTURE_2D, 9}));
    give(image(GL_TEXTURE_2D));
    for (const uint32_t proxy : {GL_PROXY_TEXTURE_2D, GL_PROXY_TEXTURE_CUBE_MAP, GL_PROXY_TEXTURE_RECTANGLE, GL_PROXY_TEXTURE_1D_ARRAY}) give(image(proxy));
    EXPECT_EQ(left(op::glTexImage2D), 1u);
}

TEST_F(Kept, aValueThatTravelsAheadStaysWithItsCommand) {
    give(PacketBuilder().record(op::glGenBuffers, {1, 4, 9}).record(op::glBindBuffer, {GL_ARRAY_BUFFER, 9}));
    for (uint32_t i = 0; i < 3; ++i) {
        give(PacketBuilder().record(wire::kOpBlobBegin, {4, 0}).record(wire::kOpBlobData, {4, i}));
        give(PacketBuilder().record(op::glBufferData, {GL_ARRAY_BUFFER, 4, 0, record::kTagBlob, GL_STATIC_DRAW}));
    }
    give(PacketBuilder().record(wire::kOpBlobBegin, {4, 0})); // of a command that has not come
    EXPECT_EQ(left(op::glBufferData), 1u);
    EXPECT_EQ(left(wire::kOpBlobData), 1u);
    EXPECT_EQ(left(wire::kOpBlobBegin), 2u);
}

TEST_F(Kept, ofShadersThatWereDeletedTheProgramLivesOn) {
    give(PacketBuilder().record(op::glCreateProgram, {1}).record(op::glCreateShader, {GL_VERTEX_SHADER, 2}).record(op::glCompileShader, {2}));
    give(PacketBuilder().record(op::glAttachShader, {1, 2}).record(op::glDeleteShader, {2}).record(op::glLinkProgram, {1}));
    EXPECT_EQ(left(op::glCompileShader), 1u);
    EXPECT_EQ(left(op::glDeleteShader), 1u);
    give(PacketBuilder().record(op::glDeleteProgram, {1}));
    EXPECT_EQ(left(op::glCreateProgram), 0u);
    EXPECT_EQ(left(op::glCompileShader), 0u);
}

// What the driver has gathered is drawn where a question comes, with the state of that moment.
TEST_F(Kept, questionsBehindBitmapsStayWithThem) {
    const auto ask = [&] { give(PacketBuilder().record(wire::kOpRequestTexImage, {1, 0, GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, 4})); };
    ask();
    EXPECT_EQ(left(wire::kOpRequestTexImage), 0u);
    give(PacketBuilder().record(op::glBitmap, {8, 8, 0, 0, 0, 0, 0}));
    ask();
    ask();
    EXPECT_EQ(left(op::glBitmap), 1u);
    EXPECT_EQ(left(wire::kOpRequestTexImage), 1u);
}

TEST_F(Kept, nothingOfAProgramThatHasGone) {
    frame();
    stream_.event({Event::ClientGone, 1, 0, ""});
    EXPECT_TRUE(stream_.snapshot().empty());
}

TEST_F(Kept, saysOnceThatItHasGrownTooLarge) {
    for (uint32_t i = 0; i < 40'000; ++i) give(PacketBuilder().record(op::glDrawArrays, {GL_TRIANGLES, i, 3})); // nothing clears
    EXPECT_FALSE(stream_.serves());
    ASSERT_EQ(said_.size(), 1u);
    EXPECT_NE(said_[0].find("give more by --store"), std::string::npos);
    EXPECT_TRUE(stream_.snapshot().empty());
    EXPECT_LT(stream_.sizeBytes(), size_t{1} << 18);
}

} // namespace
} // namespace mural::recording
