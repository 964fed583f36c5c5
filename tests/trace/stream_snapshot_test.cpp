// The commands of a stream that are kept for late nodes, command by command.
#include <gtest/gtest.h>

#include "gl_opcodes.hpp"
#include "streamcodec/snapshot/stream_snapshot.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "tests/recorded_log.hpp"
#include "tests/trace/recorded.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>

namespace mural::trace {
namespace {

constexpr uint32_t kStream = wire::streamOf(1, 0);

class StreamSnapshotTest : public ::testing::Test {
protected:
    StreamSnapshotTest() {
        PacketBuilder p;
        p.context(1).window(1, 20, 10).record(wire::kOpMakeCurrent, {1, 1, 1});
        give(p);
    }
    void give(const PacketBuilder& packet) { stream_.append(kStream, packet.bytes()); }
    // Returns the number of remaining commands with this opcode.
    size_t left(uint16_t opcode) {
        size_t n = 0;
        for (const snapshot::SnapshotPacket& packet : stream_.snapshot()) {
            wire::RecordWalk walk(packet.payload);
            wire::RecordView r;
            while (walk.next(r)) n += r.opcode == opcode;
            EXPECT_FALSE(walk.malformed());
        }
        return n;
    }
    void frame() {
        give(PacketBuilder()
                 .record(op::glClear, {GL_COLOR_BUFFER_BIT})
                 .record(op::glDrawArrays, {GL_TRIANGLES, 0, 3})
                 .swap(1, ++frame_));
    }

    const RecordedLog log_{"node:debug"};
    snapshot::StreamSnapshot stream_{size_t{1} << 20};
    uint32_t frame_ = 0;
};

TEST_F(StreamSnapshotTest, staysAsLargeAsOneFrame) {
    for (int i = 0; i < 10'000; ++i) frame();
    EXPECT_EQ(left(op::glDrawArrays), 1u);
    EXPECT_EQ(left(op::glClear), 1u);
    EXPECT_EQ(left(wire::kOpSwap), 1u);
    EXPECT_TRUE(log_.texts().empty());
}

TEST_F(StreamSnapshotTest, dropsSwaps) {
    frame();
    for (const snapshot::SnapshotPacket& packet : stream_.snapshot()) {
        wire::RecordWalk walk(packet.payload);
        wire::RecordView r;
        while (walk.next(r)) EXPECT_TRUE(r.opcode != wire::kOpSwap || wire::argumentWord(r, 1) == wire::kUnseenFrame);
    }
}

TEST_F(StreamSnapshotTest, dropsObjectsWhenTheirNamesAreDeleted) {
    for (int i = 0; i < 5; ++i) {
        give(PacketBuilder()
                 .record(op::glGenBuffers, {1, 4, 9})
                 .record(op::glBindBuffer, {GL_ARRAY_BUFFER, 9})
                 .record(op::glBufferData, {GL_ARRAY_BUFFER, 4, 0, 4, 1, GL_STATIC_DRAW}));
        give(PacketBuilder().record(op::glBindBuffer, {GL_ARRAY_BUFFER, 0}).record(op::glDeleteBuffers, {1, 4, 9}));
    }
    EXPECT_EQ(left(op::glGenBuffers), 0u);
    EXPECT_EQ(left(op::glBufferData), 0u);
    EXPECT_EQ(left(op::glDeleteBuffers), 0u);
}

// Nodes that divide draws check whether shaders may ever have written to memory (nodes/replay/features/sort_last.cpp).
TEST_F(StreamSnapshotTest, remembersThatDeletedMemoryWasBound) {
    give(PacketBuilder()
             .record(op::glGenBuffers, {1, 4, 9})
             .record(op::glBindBufferBase, {GL_SHADER_STORAGE_BUFFER, 2, 9})
             .record(op::glDeleteBuffers, {1, 4, 9}));
    EXPECT_EQ(left(op::glBindBufferBase), 1u);
    give(PacketBuilder()
             .record(op::glGenTextures, {1, 4, 9})
             .record(op::glBindImageTexture, {0, 9, 0, 0, 0, GL_READ_WRITE, GL_RGBA8})
             .record(op::glBindImageTexture, {0, 0, 0, 0, 0, GL_READ_WRITE, GL_RGBA8}));
    give(PacketBuilder().record(op::glDeleteTextures, {1, 4, 9}));
    EXPECT_EQ(left(op::glBindImageTexture), 1u);
}

// The driver has created the drawable again, with new buffers.
TEST_F(StreamSnapshotTest, dropsAWindowsPictureWhenItIsRecreated) {
    give(PacketBuilder().record(op::glDrawArrays, {GL_TRIANGLES, 0, 3}));
    EXPECT_EQ(left(op::glDrawArrays), 1u);
    give(PacketBuilder().window(1, 20, 10));
    EXPECT_EQ(left(op::glDrawArrays), 0u);
}

TEST_F(StreamSnapshotTest, dropsProxies) {
    const auto image = [](uint32_t target) {
        return PacketBuilder().record(op::glTexImage2D, {target, 0, GL_RGBA, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, 4, 7});
    };
    give(PacketBuilder().record(op::glGenTextures, {1, 4, 9}).record(op::glBindTexture, {GL_TEXTURE_2D, 9}));
    give(image(GL_TEXTURE_2D));
    for (const uint32_t proxy :
         {GL_PROXY_TEXTURE_2D, GL_PROXY_TEXTURE_CUBE_MAP, GL_PROXY_TEXTURE_RECTANGLE, GL_PROXY_TEXTURE_1D_ARRAY})
        give(image(proxy));
    EXPECT_EQ(left(op::glTexImage2D), 1u);
}

TEST_F(StreamSnapshotTest, keepsABlobWithItsCommand) {
    give(PacketBuilder().record(op::glGenBuffers, {1, 4, 9}).record(op::glBindBuffer, {GL_ARRAY_BUFFER, 9}));
    for (uint32_t i = 0; i < 3; ++i) {
        give(PacketBuilder().record(wire::kOpBlobBegin, {4, 0}).record(wire::kOpBlobData, {4, i}));
        give(PacketBuilder().record(op::glBufferData, {GL_ARRAY_BUFFER, 4, 0, record::kTagBlob, GL_STATIC_DRAW}));
    }
    give(PacketBuilder().record(wire::kOpBlobBegin, {4, 0})); // for a command that has not arrived
    EXPECT_EQ(left(op::glBufferData), 1u);
    EXPECT_EQ(left(wire::kOpBlobData), 1u);
    EXPECT_EQ(left(wire::kOpBlobBegin), 2u);
}

TEST_F(StreamSnapshotTest, keepsDeletedShadersOfALivingProgram) {
    give(PacketBuilder()
             .record(op::glCreateProgram, {1})
             .record(op::glCreateShader, {GL_VERTEX_SHADER, 2})
             .record(op::glCompileShader, {2}));
    give(PacketBuilder()
             .record(op::glAttachShader, {1, 2})
             .record(op::glDeleteShader, {2})
             .record(op::glLinkProgram, {1}));
    EXPECT_EQ(left(op::glCompileShader), 1u);
    EXPECT_EQ(left(op::glDeleteShader), 1u);
    give(PacketBuilder().record(op::glDeleteProgram, {1}));
    EXPECT_EQ(left(op::glCreateProgram), 0u);
    EXPECT_EQ(left(op::glCompileShader), 0u);
}

// A request makes the driver draw its collected bitmaps, with the state of that moment.
TEST_F(StreamSnapshotTest, keepsRequestsAfterBitmaps) {
    const auto query = [&] {
        give(PacketBuilder().record(wire::kOpRequestTexImage, {1, 0, GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, 4}));
    };
    query();
    EXPECT_EQ(left(wire::kOpRequestTexImage), 0u);
    give(PacketBuilder().record(op::glBitmap, {8, 8, 0, 0, 0, 0, 0}));
    query();
    query();
    EXPECT_EQ(left(op::glBitmap), 1u);
    EXPECT_EQ(left(wire::kOpRequestTexImage), 1u);
}

TEST_F(StreamSnapshotTest, keepsNothingOfAnEndedProgram) {
    frame();
    stream_.clientGone(1);
    EXPECT_TRUE(stream_.snapshot().empty());
}

TEST_F(StreamSnapshotTest, reportsOnceThatItIsTooLarge) {
    // without clears
    for (uint32_t i = 0; i < 40'000; ++i) give(PacketBuilder().record(op::glDrawArrays, {GL_TRIANGLES, i, 3}));
    EXPECT_FALSE(stream_.serves());
    ASSERT_EQ(log_.texts().size(), 1u);
    EXPECT_NE(log_.texts()[0].find("use a larger --cache-size"), std::string::npos);
    EXPECT_TRUE(stream_.snapshot().empty());
    EXPECT_LT(stream_.sizeBytes(), size_t{1} << 18);
}

// ---- handles of textures, sparse pages

PacketBuilder sparseTexture(uint32_t name) {
    return PacketBuilder()
        .record(op::glGenTextures, {1, 4, name})
        .record(op::glBindTexture, {GL_TEXTURE_2D, name})
        .record(op::glTexStorage2D, {GL_TEXTURE_2D, 1, GL_RGBA8, 256, 256});
}
PacketBuilder uploadTo(uint32_t x) {
    return PacketBuilder().record(op::glTexSubImage2D,
                                  {GL_TEXTURE_2D, 0, x, 0, 128, 256, GL_RGBA, GL_UNSIGNED_BYTE, 4, x});
}

// Drivers number handles in order of creation. Handles of deleted textures count too, but not the contents of these
// textures.
TEST_F(StreamSnapshotTest, createsHandlesInTheSameOrder) {
    for (uint32_t i = 0; i < 3; ++i) {
        give(sparseTexture(9));
        give(uploadTo(0));
        give(PacketBuilder()
                 .record(op::glGetTextureHandleARB, {9, 5, 0})
                 .record(op::glMakeTextureHandleResidentARB, {5, 0}));
        give(PacketBuilder().record(op::glGetTextureHandleARB, {9, 5, 0})); // again: creates no handle
        give(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 0}).record(op::glDeleteTextures, {1, 4, 9}));
    }
    EXPECT_EQ(left(op::glGetTextureHandleARB), 3u);
    EXPECT_EQ(left(op::glTexStorage2D), 3u);
    EXPECT_EQ(left(op::glDeleteTextures), 3u);
    EXPECT_EQ(left(op::glTexSubImage2D), 0u);
}

TEST_F(StreamSnapshotTest, keepsTheLastResidency) {
    give(sparseTexture(9));
    give(PacketBuilder().record(op::glGetTextureHandleARB, {9, 5, 0}));
    for (int i = 0; i < 4; ++i)
        give(PacketBuilder()
                 .record(op::glMakeTextureHandleResidentARB, {5, 0})
                 .record(op::glMakeTextureHandleNonResidentARB, {5, 0}));
    give(PacketBuilder().record(op::glMakeTextureHandleResidentARB, {5, 0}));
    EXPECT_EQ(left(op::glMakeTextureHandleResidentARB), 1u);
    EXPECT_EQ(left(op::glMakeTextureHandleNonResidentARB), 0u);
}

// A framebuffer object was drawn with the former contents of the resident texture, although that texture was never
// bound.
TEST_F(StreamSnapshotTest, keepsDrawsThatUseResidentTextures) {
    give(sparseTexture(7)); // the target
    give(PacketBuilder()
             .record(op::glGenFramebuffers, {1, 4, 3})
             .record(op::glBindFramebuffer, {GL_FRAMEBUFFER, 3})
             .record(op::glFramebufferTexture2D, {GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 7, 0}));
    give(sparseTexture(9));
    give(PacketBuilder()
             .record(op::glGetTextureHandleARB, {9, 5, 0})
             .record(op::glMakeTextureHandleResidentARB, {5, 0}));
    give(uploadTo(0));
    give(PacketBuilder()
             .record(op::glActiveTexture, {GL_TEXTURE0})
             .record(op::glBindTexture, {GL_TEXTURE_2D, 0})
             .record(op::glDrawArrays, {GL_TRIANGLES, 0, 3}));
    give(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 9}));
    give(uploadTo(0));
    EXPECT_EQ(left(op::glTexSubImage2D), 2u);
}

TEST_F(StreamSnapshotTest, keepsThePagesThatUploadsNeed) {
    const auto commit = [](uint32_t x, uint32_t committed) {
        return PacketBuilder().record(op::glTexPageCommitmentARB, {GL_TEXTURE_2D, 0, x, 0, 0, 128, 256, 1, committed});
    };
    give(sparseTexture(9));
    for (int i = 0; i < 5; ++i) {
        give(commit(0, 1));
        give(commit(128, 1));
        give(uploadTo(128));
        give(commit(0, 0));
    }
    give(commit(0, 1));
    give(commit(128, 1)); // changes nothing, but the upload before it stays
    EXPECT_EQ(left(op::glTexSubImage2D), 1u);
    const size_t pages = left(op::glTexPageCommitmentARB);
    EXPECT_GE(pages, 3u);
    EXPECT_LE(pages, 5u);
}

TEST_F(StreamSnapshotTest, keepsPagesOfBuffers) {
    give(PacketBuilder()
             .record(op::glGenBuffers, {1, 4, 9})
             .record(op::glBindBuffer, {GL_ARRAY_BUFFER, 9})
             .record(op::glBufferStorage, {GL_ARRAY_BUFFER, 0x20000, 0, 0, 0x400}));
    for (uint32_t i = 0; i < 4; ++i) {
        give(PacketBuilder().record(op::glBufferPageCommitmentARB, {GL_ARRAY_BUFFER, 0, 0, 0x10000, 0, 1}));
        give(PacketBuilder().record(op::glBufferSubData, {GL_ARRAY_BUFFER, 0, 0, 4, 0, 4, i}));
        if (i < 3) give(PacketBuilder().record(op::glBufferPageCommitmentARB, {GL_ARRAY_BUFFER, 0, 0, 0x10000, 0, 0}));
    }
    EXPECT_EQ(left(op::glBufferSubData), 1u);
    EXPECT_EQ(left(op::glBufferPageCommitmentARB), 1u);
}

} // namespace
} // namespace mural::trace
