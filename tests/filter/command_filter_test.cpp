// The commands that the filter defers, for how long, and the commands that it drops.
#include "streamcodec/filter/command_filter.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "tests/filter/seen_model.hpp"
#include "tests/trace/recorded.hpp"

namespace mural::filter {
namespace {

using trace::PacketBuilder;

constexpr uint32_t kStream = wire::streamOf(1, 0), kOther = wire::streamOf(1, 1);
constexpr uint64_t kBound = 1 << 20;

class CommandFilterTest : public testing::Test {
protected:
    void send(const PacketBuilder& p, uint32_t stream = kStream) { filter_.add(stream, p.bytes()); }
    void begin() {
        filter_.setDropsRedundant(true);
        send(PacketBuilder()
                 .context(1)
                 .window(1, 20, 10)
                 .record(wire::kOpMakeCurrent, {1, 1, 1})
                 .record(op::glGenTextures, {2, 8, 1, 2})
                 .record(op::glGenBuffers, {2, 8, 1, 2}));
    }
    static std::vector<uint32_t> image(uint32_t value) {
        std::vector<uint32_t> words{GL_TEXTURE_2D, 0, GL_RGBA, 16, 16, 0, GL_RGBA, GL_UNSIGNED_BYTE, 1024};
        words.resize(words.size() + 256, value);
        return words;
    }
    static std::vector<uint32_t> buffer(uint32_t value) {
        std::vector<uint32_t> words{GL_ARRAY_BUFFER, 1024, 0, 1024};
        words.resize(words.size() + 256, value);
        words.push_back(GL_STATIC_DRAW);
        return words;
    }
    static PacketBuilder draw() { return PacketBuilder().record(op::glDrawArrays, {GL_TRIANGLES, 0, 3}); }

    [[nodiscard]] size_t countOf(uint16_t opcode) const;

    SeenModel seen_;
    std::vector<uint32_t> streams_; // of the packets that were sent
    std::vector<uint16_t> opcodes_; // of the records that were sent
    CommandFilter filter_{kBound, [this](uint32_t stream, std::span<const std::byte> payload, const RecordOffsets*) {
                              seen_.packet(stream, payload);
                              streams_.push_back(stream);
                              wire::RecordWalk walk(payload);
                              for (wire::RecordView r; walk.next(r);) opcodes_.push_back(r.opcode);
                          }};
};

TEST_F(CommandFilterTest, defersATextureUntilADrawHasItBound) {
    begin();
    send(PacketBuilder()
             .record(op::glBindTexture, {GL_TEXTURE_2D, 1})
             .record(op::glTexImage2D, image(5))
             .record(op::glBindTexture, {GL_TEXTURE_2D, 2}));
    EXPECT_EQ(seen_.uploads(), 0u);
    for (uint32_t frame = 1; frame <= 100; ++frame)
        send(PacketBuilder().record(op::glDrawArrays, {GL_TRIANGLES, 0, 3}).swap(1, frame));
    EXPECT_EQ(seen_.uploads(), 0u);
    EXPECT_EQ(filter_.counts().deferredRecords, 1u);
    EXPECT_GT(filter_.counts().deferredBytes, 1024u);
    send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 1}).record(op::glDrawArrays, {GL_TRIANGLES, 0, 3}));
    EXPECT_EQ(seen_.uploads(), 1u);
    EXPECT_EQ(filter_.counts().deferredBytes, 0u);
}

// Shaders may use the texture without a binding.
TEST_F(CommandFilterTest, defersNothingAfterATextureHasAHandle) {
    begin();
    send(PacketBuilder()
             .record(op::glBindTexture, {GL_TEXTURE_2D, 1})
             .record(op::glTexImage2D, image(5))
             .record(op::glBindTexture, {GL_TEXTURE_2D, 2}));
    EXPECT_EQ(seen_.uploads(), 0u);
    send(PacketBuilder().record(op::glGetTextureHandleARB, {1, 7, 0}));
    EXPECT_EQ(seen_.uploads(), 1u);
    send(PacketBuilder().record(op::glTexImage2D, image(6)));
    EXPECT_EQ(seen_.uploads(), 2u);
}

TEST_F(CommandFilterTest, defersNothingAfterAHandleIsRequestedInAList) {
    begin();
    send(PacketBuilder()
             .record(op::glNewList, {3, GL_COMPILE})
             .record(op::glGetTextureHandleARB, {1, 7, 0})
             .record(op::glEndList, {}));
    send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 2}).record(op::glTexImage2D, image(6)));
    EXPECT_EQ(seen_.uploads(), 1u);
}

TEST_F(CommandFilterTest, dropsUploadsReplacedBeforeTheirUse) {
    begin();
    send(PacketBuilder()
             .record(op::glBindTexture, {GL_TEXTURE_2D, 1})
             .record(op::glBindBuffer, {GL_ARRAY_BUFFER, 1})
             .record(op::glVertexAttribPointer, {0, 4, GL_FLOAT, 0, 0, 0}));
    for (uint32_t i = 0; i < 10; ++i)
        send(PacketBuilder().record(op::glTexImage2D, image(i)).record(op::glBufferData, buffer(i)).swap(1, i + 1));
    EXPECT_EQ(seen_.uploads(), 0u);
    send(draw());
    EXPECT_EQ(seen_.uploads(), 2u);
    EXPECT_EQ(filter_.counts().droppedRecords, 18u);
    EXPECT_EQ(filter_.counts().inBytes, filter_.counts().outBytes + filter_.counts().droppedBytes);
}

TEST_F(CommandFilterTest, sendsUploadsReadBeforeTheirReplacement) {
    begin();
    send(PacketBuilder()
             .record(op::glBindTexture, {GL_TEXTURE_2D, 1})
             .record(op::glTexImage2D, image(1))
             .record(op::glGenerateMipmap, {GL_TEXTURE_2D})
             .record(op::glTexImage2D, image(2)));
    send(draw());
    EXPECT_EQ(seen_.uploads(), 2u);
}

TEST_F(CommandFilterTest, dropsUploadsThatChangeNothing) {
    begin();
    send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 1}));
    for (uint32_t i = 0; i < 10; ++i)
        send(PacketBuilder()
                 .record(op::glTexImage2D, image(7))
                 .record(op::glDrawArrays, {GL_TRIANGLES, 0, 3})
                 .swap(1, i + 1));
    EXPECT_EQ(seen_.uploads(), 2u) << "the first is not remembered: most never comes again";
    EXPECT_EQ(filter_.counts().droppedRecords, 8u);
}

TEST_F(CommandFilterTest, dropsUploadsOfObjectsDeletedUnused) {
    begin();
    send(PacketBuilder()
             .record(op::glBindTexture, {GL_TEXTURE_2D, 1})
             .record(op::glTexImage2D, image(5))
             .record(op::glDeleteTextures, {1, 4, 1})
             .record(op::glDrawArrays, {GL_TRIANGLES, 0, 3}));
    EXPECT_EQ(seen_.uploads(), 0u);
    EXPECT_EQ(filter_.counts().droppedRecords, 1u);
}

TEST_F(CommandFilterTest, forwardsUploadsThatAreAlwaysUsedAtOnce) {
    begin();
    send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 1}));
    for (uint32_t i = 0; i < 40; ++i)
        send(PacketBuilder()
                 .record(op::glTexImage2D, image(i))
                 .record(op::glDrawArrays, {GL_TRIANGLES, 0, 3})
                 .swap(1, i + 1));
    EXPECT_EQ(seen_.uploads(), 40u);
    EXPECT_EQ(filter_.counts().deferredRecords, 2u) << "nothing was won twice";
}

TEST_F(CommandFilterTest, releasesEverythingForAnUnknownCommand) {
    begin();
    send(PacketBuilder()
             .record(op::glBindTexture, {GL_TEXTURE_2D, 1})
             .record(op::glTexImage2D, image(5))
             .record(op::glBindTexture, {GL_TEXTURE_2D, 2}));
    send(PacketBuilder().record(op::glClearTexImage, {1, 0, GL_RGBA, GL_UNSIGNED_BYTE, record::kTagNull}));
    EXPECT_EQ(seen_.uploads(), 1u);
    send(PacketBuilder().record(op::glTexImage2D, image(6)));
    EXPECT_EQ(seen_.uploads(), 2u) << "from then on all goes at once";
}

// Records of a group that is no longer tracked are skipped at once, except those that leave the group.
TEST_F(CommandFilterTest, defersAgainInAContextWithoutSharing) {
    begin();
    filter_.setDropsRedundant(false);
    send(PacketBuilder().record(op::glClearTexImage, {1, 0, GL_RGBA, GL_UNSIGNED_BYTE, record::kTagNull}));
    send(draw()
             .record(op::glBindTexture, {GL_TEXTURE_2D, 1})
             .context(2)
             .window(2, 20, 10)
             .record(wire::kOpMakeCurrent, {2, 2, 2})
             .record(op::glGenTextures, {1, 4, 1}));
    send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 1}).record(op::glTexImage2D, image(6)));
    EXPECT_EQ(seen_.uploads(), 0u);
    send(draw());
    EXPECT_EQ(seen_.uploads(), 1u);
}

// A new vertex array does not inherit bindings of an older one in the same memory.
TEST_F(CommandFilterTest, distinguishesNewVertexArrays) {
    begin();
    send(PacketBuilder()
             .record(op::glBindBuffer, {GL_ARRAY_BUFFER, 1})
             .record(op::glBufferData, buffer(5))
             .record(op::glBindBuffer, {GL_ARRAY_BUFFER, 0}));
    send(PacketBuilder()
             .record(op::glGenVertexArrays, {1, 4, 1})
             .record(op::glBindVertexArray, {1})
             .record(op::glBindBuffer, {GL_ELEMENT_ARRAY_BUFFER, 1}));
    send(PacketBuilder()
             .record(op::glDeleteVertexArrays, {1, 4, 1})
             .record(op::glGenVertexArrays, {1, 4, 2})
             .record(op::glBindVertexArray, {2}));
    send(draw());
    EXPECT_EQ(seen_.uploads(), 0u);
    send(PacketBuilder().record(op::glBindBuffer, {GL_ELEMENT_ARRAY_BUFFER, 1}));
    send(draw());
    EXPECT_EQ(seen_.uploads(), 1u);
}

TEST_F(CommandFilterTest, releasesBeforeRecordsOfAnotherContext) {
    begin();
    send(PacketBuilder().context(2, 1).record(wire::kOpMakeCurrent, {2, 2, 2}), kOther);
    send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 1}).record(op::glTexImage2D, image(5)));
    EXPECT_EQ(seen_.uploads(), 0u);
    streams_.clear();
    send(PacketBuilder().record(op::glFlush, {}), kOther);
    EXPECT_EQ(seen_.uploads(), 1u);
    ASSERT_EQ(streams_.size(), 2u);
    EXPECT_EQ(streams_[0], kStream) << "by the context that it was given to";
}

TEST_F(CommandFilterTest, respectsItsMemoryLimit) {
    begin();
    std::vector<uint32_t> names;
    for (uint32_t i = 0; i < 2000; ++i)
        send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 10 + i}).record(op::glTexImage2D, image(i)));
    EXPECT_GT(seen_.uploads(), 900u);
    EXPECT_LE(filter_.counts().deferredBytes, kBound);
    filter_.releaseAll();
    EXPECT_EQ(seen_.uploads(), 2000u);
}

TEST_F(CommandFilterTest, waitsForBlobs) {
    begin();
    constexpr uint32_t kPieces = 5, kWords = 10'000;
    send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 1}));
    const auto give = [&](uint32_t value) {
        send(PacketBuilder().record(wire::kOpBlobBegin, {kPieces * kWords * 4, 0}));
        for (uint32_t i = 0; i < kPieces; ++i) {
            std::vector<uint32_t> piece(kWords + 1, value);
            piece[0] = kWords * 4;
            send(PacketBuilder().longRecord(wire::kOpBlobData, piece));
        }
        send(PacketBuilder().record(
            op::glTexImage2D, {GL_TEXTURE_2D, 0, GL_RGBA, 100, 500, 0, GL_RGBA, GL_UNSIGNED_BYTE, record::kTagBlob}));
    };
    give(1);
    give(2);
    EXPECT_EQ(seen_.uploads(), 0u);
    send(draw());
    EXPECT_EQ(seen_.uploads(), 1u);
    EXPECT_EQ(filter_.counts().droppedRecords, kPieces + 2u);
    give(2);
    send(draw());
    EXPECT_EQ(seen_.uploads(), 1u) << "it is there";
    give(3);
    EXPECT_EQ(filter_.counts().inBytes,
              filter_.counts().outBytes + filter_.counts().droppedBytes + filter_.counts().deferredBytes);
    filter_.clientGone(1);
    EXPECT_EQ(seen_.uploads(), 1u) << "nobody needs it";
    EXPECT_EQ(filter_.counts().deferredBytes, 0u);
}

// The number of sent records with this opcode.
size_t CommandFilterTest::countOf(uint16_t opcode) const {
    return static_cast<size_t>(std::ranges::count(opcodes_, opcode));
}

TEST_F(CommandFilterTest, dropsUnchangedState) {
    begin();
    for (uint32_t frame = 1; frame <= 50; ++frame) {
        send(PacketBuilder()
                 .record(op::glEnable, {GL_BLEND})
                 .record(op::glBlendFunc, {GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA})
                 .record(op::glDepthMask, {1})
                 .record(op::glActiveTexture, {GL_TEXTURE0}));
        send(PacketBuilder()
                 .record(op::glBindTexture, {GL_TEXTURE_2D, 1})
                 .record(op::glDrawArrays, {GL_TRIANGLES, 0, 3})
                 .swap(1, frame));
    }
    for (const uint16_t opcode : {op::glEnable, op::glBlendFunc, op::glDepthMask, op::glBindTexture})
        EXPECT_EQ(countOf(opcode), 1u);
    EXPECT_EQ(countOf(op::glActiveTexture), 0u) << "0 is active from the start";
    EXPECT_EQ(countOf(op::glDrawArrays), 50u);
    EXPECT_EQ(filter_.counts().droppedRecords, 4u * 49 + 50);
    EXPECT_EQ(filter_.counts().inBytes, filter_.counts().outBytes + filter_.counts().droppedBytes);
}

TEST_F(CommandFilterTest, defersStateUntilADrawNeedsIt) {
    begin();
    send(PacketBuilder()
             .record(op::glDisable, {GL_DEPTH_TEST})
             .record(op::glDepthFunc, {GL_LESS})
             .record(op::glDrawArrays, {GL_TRIANGLES, 0, 3}));
    EXPECT_EQ(countOf(op::glDisable), 1u);
    for (uint32_t frame = 1; frame <= 50; ++frame) // no draws in between
        send(PacketBuilder()
                 .record(op::glEnable, {GL_DEPTH_TEST})
                 .record(op::glDepthFunc, {GL_LESS + frame % 3})
                 .record(op::glMatrixMode, {GL_MODELVIEW})
                 .swap(1, frame));
    EXPECT_EQ(countOf(op::glEnable) + countOf(op::glDepthFunc), 1u);
    EXPECT_GT(filter_.counts().deferredBytes, 0u);
    send(PacketBuilder().record(op::glClear, {GL_COLOR_BUFFER_BIT}));
    EXPECT_EQ(countOf(op::glEnable), 1u);
    EXPECT_EQ(countOf(op::glDepthFunc), 2u);
    EXPECT_EQ(filter_.counts().deferredBytes, 0u);
    // Restored before it was used.
    send(PacketBuilder().record(op::glDisable, {GL_DEPTH_TEST}).record(op::glEnable, {GL_DEPTH_TEST}));
    EXPECT_EQ(filter_.counts().deferredBytes, 0u);
    send(draw());
    EXPECT_EQ(countOf(op::glDisable), 1u);
}

TEST_F(CommandFilterTest, sendsStateBeforeCommandsThatReadIt) {
    const PacketBuilder queries[] = {
        PacketBuilder().record(op::glPushAttrib, {GL_ENABLE_BIT}),
        PacketBuilder().record(op::glBegin, {GL_POINTS}).record(op::glEnd, {}),
        PacketBuilder().record(op::glBlitFramebuffer, {0, 0, 1, 1, 0, 0, 1, 1, GL_COLOR_BUFFER_BIT, GL_NEAREST}),
        PacketBuilder().record(op::glCallList, {7}),
        PacketBuilder().record(wire::kOpFinish, {1}),
        PacketBuilder().record(wire::kOpMakeCurrent, {0, 0, 0}),
        PacketBuilder().record(op::glClearTexImage, {1, 0, GL_RGBA, GL_UNSIGNED_BYTE, record::kTagNull})};
    begin();
    for (size_t i = 0; i < std::size(queries); ++i) {
        send(PacketBuilder().record(wire::kOpMakeCurrent, {1, 1, 1}));
        send(PacketBuilder().record(op::glViewport, {0, 0, 10, static_cast<uint32_t>(i)}));
        EXPECT_EQ(countOf(op::glViewport), i) << "nobody has asked";
        send(queries[i]);
        EXPECT_EQ(countOf(op::glViewport), i + 1);
    }
}

TEST_F(CommandFilterTest, sendsUniformsOfTheDrawingProgram) {
    begin();
    for (const uint32_t program : {5U, 6U})
        send(PacketBuilder().record(op::glCreateProgram, {program}).record(wire::kOpProgramLayout, {program, 4, 0}));
    for (uint32_t frame = 1; frame <= 50; ++frame) {
        // replaced except once
        send(PacketBuilder()
                 .record(op::glUseProgram, {5})
                 .record(op::glUniform1f, {0, frame})
                 .record(op::glUniform4f, {1, frame, 2, 3, 4}));
        send(PacketBuilder()
                 .record(op::glUseProgram, {6})
                 .record(op::glUniform1f, {0, 7})
                 .record(op::glUniform1i, {2, 3})
                 .record(op::glDrawArrays, {GL_TRIANGLES, 0, 3})
                 .swap(1, frame));
    }
    EXPECT_EQ(countOf(op::glUniform1i), 1u) << "it is 3";
    EXPECT_EQ(countOf(op::glUniform4f), 0u) << "nothing is drawn by that program";
    EXPECT_EQ(countOf(op::glUniform1f), 1u);
    send(PacketBuilder().record(op::glUseProgram, {5}).record(op::glDrawArrays, {GL_TRIANGLES, 0, 3}));
    EXPECT_EQ(countOf(op::glUniform4f), 1u);
    EXPECT_EQ(countOf(op::glUniform1f), 2u);
    EXPECT_EQ(filter_.counts().deferredBytes, 0u);
}

// State set by another thread meanwhile is unknown.
TEST_F(CommandFilterTest, dropsNoSmallStateWhereContextsShare) {
    begin();
    send(PacketBuilder().context(2, 1), kOther);
    send(PacketBuilder()
             .record(op::glCreateProgram, {5})
             .record(wire::kOpProgramLayout, {5, 4, 0})
             .record(op::glUseProgram, {5}));
    for (uint32_t frame = 1; frame <= 10; ++frame)
        send(PacketBuilder()
                 .record(op::glUniform1f, {0, 7})
                 .record(op::glBindTexture, {GL_TEXTURE_2D, 1})
                 .record(op::glDrawArrays, {GL_TRIANGLES, 0, 3})
                 .swap(1, frame));
    EXPECT_EQ(countOf(op::glUniform1f), 10u);
    EXPECT_EQ(countOf(op::glBindTexture), 10u);
}

// Called lists set state and bind nothing. The first frame ends with other bindings than the second starts with.
TEST_F(CommandFilterTest, followsFramesThatEndDifferently) {
    begin();
    filter_.setDropsRedundant(false);
    SeenModel whole;
    const auto give = [&](const PacketBuilder& p) {
        whole.packet(kStream, p.bytes());
        send(p);
        ASSERT_EQ(seen_.seen(), whole.seen());
    };
    whole.packet(kStream, PacketBuilder()
                              .context(1)
                              .window(1, 20, 10)
                              .record(wire::kOpMakeCurrent, {1, 1, 1})
                              .record(op::glGenTextures, {2, 8, 1, 2})
                              .record(op::glGenBuffers, {2, 8, 1, 2})
                              .bytes());
    uint32_t frame = 0;
    const auto bindsSecond = [&] { return draw().record(op::glBindTexture, {GL_TEXTURE_2D, 2}).swap(1, ++frame); };
    const auto bindsFirst = [&] {
        return draw().append(draw()).record(op::glBindTexture, {GL_TEXTURE_2D, 1}).swap(1, ++frame);
    };
    for (uint32_t i = 0; i < 60; ++i) {
        give(bindsFirst());
        give(bindsSecond());
        give(PacketBuilder()
                 .record(op::glTexImage2D, image(i))
                 .record(op::glBindTexture, {GL_TEXTURE_2D, 0})
                 .append(draw())
                 .record(op::glBindTexture, {GL_TEXTURE_2D, 2})
                 .append(draw())
                 .swap(1, ++frame));
    }
}

TEST_F(CommandFilterTest, skipsRepeatedFrames) {
    begin();
    filter_.setDropsRedundant(false);
    const auto frame = [&](uint32_t number, uint32_t texture) {
        PacketBuilder p;
        for (uint32_t i = 0; i < 50; ++i)
            p.record(op::glActiveTexture, {GL_TEXTURE0 + i % 2})
                .record(op::glBindTexture, {GL_TEXTURE_2D, 1 + i % 2})
                .record(op::glColor4f, {number, i, 0, 0})
                .append(draw());
        return p.record(op::glBindTexture, {GL_TEXTURE_2D, texture}).swap(1, number);
    };
    for (uint32_t i = 1; i <= 100; ++i) send(frame(i, 1));
    const uint64_t alike = filter_.counts().alikeRecords;
    EXPECT_GT(alike, 80u * 200) << "of 201 in each";
    send(frame(101, 2)); // differs at its end
    EXPECT_GT(filter_.counts().alikeRecords, alike + 199);
    send(PacketBuilder()
             .record(op::glTexImage2D, image(5))
             .record(op::glBindTexture, {GL_TEXTURE_2D, 1})
             .append(draw()));
    EXPECT_EQ(seen_.uploads(), 0u) << "it is the second that has waited";
    send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 2}).append(draw()));
    EXPECT_EQ(seen_.uploads(), 1u);
}

// Each frame ends with another texture bound, as in programs that move one object; the next frame binds its own first.
TEST_F(CommandFilterTest, skipsFramesThatLeaveOtherTexturesBound) {
    begin();
    filter_.setDropsRedundant(false);
    constexpr uint32_t kEnds = 3, kFirst = 10;
    PacketBuilder made = PacketBuilder().record(op::glGenTextures, {kEnds, 4 * kEnds, kFirst, kFirst + 1, kFirst + 2});
    for (uint32_t i = 0; i < kEnds; ++i) made.record(op::glBindTexture, {GL_TEXTURE_2D, kFirst + i});
    send(made);
    const auto frame = [&](uint32_t number) {
        PacketBuilder p;
        for (uint32_t i = 0; i < 100; ++i)
            p.record(op::glBindTexture, {GL_TEXTURE_2D, 1 + i % 2})
                .record(op::glColor4f, {number, i, 0, 0})
                .append(draw());
        return p.record(op::glBindTexture, {GL_TEXTURE_2D, kFirst + number % kEnds}).append(draw()).swap(1, number);
    };
    uint32_t number = 0;
    while (number < 100) send(frame(++number));
    EXPECT_GT(filter_.counts().alikeRecords, 80u * 300) << "of 302 in each";
    // The remaining binding is followed nevertheless.
    const uint32_t last = kFirst + number % kEnds;
    send(PacketBuilder()
             .record(op::glTexImage2D, image(7))
             .record(op::glTexParameteri, {GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR}));
    EXPECT_EQ(seen_.uploads(), 0u);
    send(frame(++number));
    EXPECT_EQ(seen_.uploads(), 0u) << "each frame binds others before it draws";
    EXPECT_EQ(kFirst + (number + 2) % kEnds, last);
    send(frame(++number));
    send(frame(++number));
    EXPECT_EQ(seen_.uploads(), 1u) << "the third one binds that at its end, and draws";
}

// Nodes reject them; the head continues.
TEST_F(CommandFilterTest, survivesDamagedPackets) {
    begin();
    filter_.setDropsRedundant(false);
    const auto frame = [](uint32_t number) {
        PacketBuilder p;
        for (uint32_t i = 0; i < 20; ++i)
            p.record(op::glBindTexture, {GL_TEXTURE_2D, 1 + i % 2})
                .longRecord(op::glColor4f, {i, number, 0, 0})
                .append(draw());
        return p.swap(1, number);
    };
    uint32_t number = 0;
    const size_t sizeBytes = frame(0).bytes().size();
    for (size_t cut = 0; cut < sizeBytes; cut += 4) {
        for (int i = 0; i < 8; ++i) send(frame(++number));
        const PacketBuilder whole = frame(++number);
        filter_.add(kStream, whole.bytes().first(cut)); // usually within a record
        filter_.add(kStream, whole.bytes().subspan(cut));
    }
    EXPECT_EQ(filter_.counts().inBytes, filter_.counts().outBytes);
}

TEST_F(CommandFilterTest, releasesTheOldestAtTheMemoryLimit) {
    begin();
    constexpr uint32_t kImages = 1100; // about a thousand fit
    for (uint32_t i = 0; i < kImages; ++i)
        send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 10 + i}).record(op::glTexImage2D, image(i)));
    EXPECT_GT(seen_.uploads(), 50u);
    EXPECT_LT(seen_.uploads(), 400u) << "the others wait on";
    const size_t before = seen_.uploads();
    send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 10}).append(draw()));
    EXPECT_EQ(seen_.uploads(), before) << "the first has gone";
    send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 9 + kImages}).append(draw()));
    EXPECT_EQ(seen_.uploads(), before + 1);
}

// Loaded and drawn in the same frame repeatedly: most uploads are then forwarded.
TEST_F(CommandFilterTest, defersLittleThatIsAlwaysDrawnAtOnce) {
    begin();
    constexpr uint32_t kTextures = 200;
    for (uint32_t i = 0; i < kTextures; ++i)
        send(PacketBuilder()
                 .record(op::glBindTexture, {GL_TEXTURE_2D, 10 + i})
                 .record(op::glTexImage2D, image(i))
                 .append(draw())
                 .swap(1, i + 1));
    EXPECT_EQ(seen_.uploads(), kTextures);
    EXPECT_LT(filter_.counts().deferredRecords, 60u);
    // A waiting object shows that deferring pays.
    for (uint32_t i = 0; i < 20; ++i)
        send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 1000 + i}).record(op::glTexImage2D, image(i)));
    for (uint32_t i = 0; i < 5; ++i)
        send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 1}).append(draw()).swap(1, 300 + i));
    const uint64_t deferred = filter_.counts().deferredRecords;
    for (uint32_t i = 0; i < 100; ++i)
        send(PacketBuilder().record(op::glBindTexture, {GL_TEXTURE_2D, 2000 + i}).record(op::glTexImage2D, image(i)));
    EXPECT_EQ(filter_.counts().deferredRecords, deferred + 100);
}

TEST_F(CommandFilterTest, examinesUniformsOnlyWithSmallState) {
    begin();
    send(PacketBuilder()
             .record(op::glCreateProgram, {5})
             .record(wire::kOpProgramLayout, {5, 4, 0})
             .record(op::glUseProgram, {5}));
    const auto sets = [&](uint32_t value) { send(PacketBuilder().record(op::glUniform1f, {0, value})); };
    sets(1);
    EXPECT_EQ(countOf(op::glUniform1f), 0u) << "it waits";
    filter_.setDropsRedundant(false);
    EXPECT_EQ(countOf(op::glUniform1f), 1u) << "the next one will not";
    sets(2);
    sets(2);
    EXPECT_EQ(countOf(op::glUniform1f), 3u);
    filter_.setDropsRedundant(true);
    sets(1);
    send(PacketBuilder().record(op::glUseProgram, {5}).record(op::glUniform1f, {0, 1}).append(draw()));
    EXPECT_GE(countOf(op::glUniform1f), 4u) << "what was set meanwhile is not taken for what it was before";
}

TEST_F(CommandFilterTest, followsListsThatSetState) {
    begin();
    send(PacketBuilder()
             .record(op::glNewList, {3, GL_COMPILE})
             .record(op::glEnable, {GL_BLEND})
             .record(op::glEndList, {})
             .record(op::glDisable, {GL_BLEND})
             .record(op::glDrawArrays, {GL_TRIANGLES, 0, 3}));
    send(PacketBuilder()
             .record(op::glCallList, {3})
             .record(op::glDisable, {GL_BLEND})
             .record(op::glDrawArrays, {GL_TRIANGLES, 0, 3}));
    EXPECT_EQ(countOf(op::glDisable), 2u) << "the list has enabled it";
    send(PacketBuilder()
             .record(op::glBindTexture, {GL_TEXTURE_2D, 1})
             .record(op::glTexImage2D, image(5))
             .record(op::glBindTexture, {GL_TEXTURE_2D, 2}));
    EXPECT_EQ(seen_.uploads(), 0u) << "holding goes on";
}

// Draw records of a list are skipped together; glBegin and glEnd are paired nevertheless, even across packets.
TEST_F(CommandFilterTest, pairsPrimitivesOfLists) {
    for (const bool dropsRedundant : {true, false}) {
        for (const bool ends : {true, false}) {
            SCOPED_TRACE(testing::Message()
                         << "redundant state is dropped: " << dropsRedundant << ", the last primitive ends: " << ends);
            SeenModel seen;
            CommandFilter subject(kBound, [&](uint32_t stream, std::span<const std::byte> payload,
                                              const RecordOffsets*) { seen.packet(stream, payload); });
            const auto feed = [&](const PacketBuilder& p) { subject.add(kStream, p.bytes()); };
            subject.setDropsRedundant(dropsRedundant);
            feed(PacketBuilder()
                     .context(1)
                     .window(1, 20, 10)
                     .record(wire::kOpMakeCurrent, {1, 1, 1})
                     .record(op::glGenTextures, {2, 8, 1, 2}));
            PacketBuilder list;
            list.record(op::glNewList, {3, GL_COMPILE});
            for (int i = 0; i < 50; ++i)
                list.record(op::glNormal3f, {0, 0, 0})
                    .record(op::glBegin, {GL_POINTS})
                    .record(op::glVertex3f, {1, 2, 3})
                    .record(op::glEnd, {});
            feed(list.record(op::glBegin, {GL_POINTS}).record(op::glVertex3f, {1, 2, 3}));
            PacketBuilder rest;
            rest.record(op::glVertex3f, {1, 2, 3});
            if (ends) rest.record(op::glEnd, {});
            feed(rest.record(op::glEndList, {}).record(op::glCallList, {3}));
            feed(PacketBuilder()
                     .record(op::glBindTexture, {GL_TEXTURE_2D, 1})
                     .record(op::glTexImage2D, image(5))
                     .record(op::glBindTexture, {GL_TEXTURE_2D, 2}));
            EXPECT_EQ(subject.counts().deferredRecords, ends ? 1u : 0u)
                << "a list that leaves one open is not followed";
        }
    }
}

TEST_F(CommandFilterTest, defersNothingForAProgramWithDebugOutput) {
    begin();
    send(PacketBuilder()
             .record(op::glEnable, {GL_DEBUG_OUTPUT})
             .record(op::glBindTexture, {GL_TEXTURE_2D, 1})
             .record(op::glTexImage2D, image(5)));
    EXPECT_EQ(seen_.uploads(), 1u);
}

} // namespace
} // namespace mural::filter
