// Random programs: whatever the filter defers, each draw sees the same as without it.
#include <gtest/gtest.h>
#include <random>

#include "streamcodec/filter/command_filter.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "tests/filter/seen_model.hpp"
#include "tests/trace/recorded.hpp"
#include "tests/sanitized.hpp"

namespace mural::filter {
namespace {

using mural::testing::rounds;
using trace::PacketBuilder;

constexpr uint32_t kNames = 4; // of each kind
constexpr uint32_t kBufferBytes = 1024;

class RandomProgram {
public:
    RandomProgram(uint32_t seed, bool shares) : random_(seed), shares_(shares), fewDraws_(seed % 2) {}

    PacketBuilder begin() {
        PacketBuilder p;
        p.context(1).window(1, 20, 10).record(wire::kOpMakeCurrent, {1, 1, 1});
        for (uint32_t name = 1; name <= kNames; ++name) {
            p.record(op::glGenTextures, {1, 4, name})
                .record(op::glGenBuffers, {1, 4, name})
                .record(op::glGenVertexArrays, {1, 4, name})
                .record(op::glCreateProgram, {name});
            p.record(wire::kOpProgramLayout, {name, 4, 0});
        }
        return p;
    }
    PacketBuilder other() {
        return PacketBuilder().context(2, 1).window(2, 20, 10).record(wire::kOpMakeCurrent, {2, 2, 2});
    }

    PacketBuilder packet() {
        PacketBuilder p;
        for (uint32_t i = below(40); i > 0; --i) command(p);
        if (below(4) == 0) p.swap(1, ++frame_);
        return p;
    }
    uint32_t below(uint32_t n) { return random_() % n; }

    // A repeated frame; without commands: something between glBegin and glEnd.
    std::vector<PacketBuilder> frame() {
        std::vector<PacketBuilder> commands(1 + below(below(3) == 0 ? 400 : 60));
        for (PacketBuilder& p : commands) {
            if (below(20) != 0) command(p);
            if (endsFrames(p)) p = PacketBuilder().record(op::glDrawArrays, {GL_TRIANGLES, 0, 3});
        }
        return commands;
    }
    // A frame with many bindings and few draws.
    std::vector<PacketBuilder> bindingFrame() {
        std::vector<PacketBuilder> commands(150 + below(300));
        for (PacketBuilder& p : commands) binds(p);
        return commands;
    }
    // A frame that repeatedly binds few textures and draws, on one or two units.
    std::vector<PacketBuilder> textureFrame() {
        std::vector<PacketBuilder> commands(80 + below(60));
        const bool bindsBoth = below(2) == 0;
        for (PacketBuilder& p : commands) {
            if (below(4) == 0)
                p.record(op::glDrawArrays, {GL_TRIANGLES, 0, 3});
            else if (bindsBoth && below(3) == 0)
                p.record(op::glActiveTexture, {GL_TEXTURE0 + below(2)});
            else
                p.record(op::glBindTexture, {GL_TEXTURE_2D, 1 + below(2)});
        }
        if (below(2) == 0) commands.front() = PacketBuilder().record(op::glDrawArrays, {GL_TRIANGLES, 0, 3});
        commands.push_back(PacketBuilder().record(op::glActiveTexture, {GL_TEXTURE0}));
        return commands;
    }
    // Returns the frame with varying final bindings, and rarely with a different record towards its end.
    PacketBuilder withOtherEnd(const std::vector<PacketBuilder>& commands) {
        PacketBuilder p;
        const size_t other = below(8) == 0 ? commands.size() - 1 - below(12) : commands.size();
        for (size_t i = 0; i < commands.size(); ++i) {
            if (i == other) somethingElse(p);
            p.append(commands[i]);
        }
        for (uint32_t unit = 0; unit < 2; ++unit) {
            if (below(2) == 0) continue;
            p.record(op::glActiveTexture, {GL_TEXTURE0 + unit})
                .record(op::glBindTexture, {GL_TEXTURE_2D, below(3) != 0 ? kNames : 1 + below(kNames)});
            if (below(12) == 0) p.record(op::glDrawArrays, {GL_TRIANGLES, 0, 3});
        }
        p.record(op::glActiveTexture, {GL_TEXTURE0});
        return p.swap(1, ++frame_);
    }
    // Returns the frame with an upload to a bound object at a random position, sometimes with other names before it.
    PacketBuilder withUpload(const std::vector<PacketBuilder>& commands) {
        PacketBuilder p;
        const size_t at = commands.size() - 1 - below(below(2) == 0 ? 20 : 120);
        if (below(5) == 0) otherNames(p);
        for (size_t i = 0; i < commands.size(); ++i) {
            if (i == at && below(3) != 0) upload(p);
            if (i == at && below(4) == 0) p.record(op::glDrawArrays, {GL_TRIANGLES, 0, 3});
            if (i == at && below(8) == 0) binds(p);
            p.append(commands[i]);
        }
        return p.swap(1, ++frame_);
    }
    static bool endsFrames(const PacketBuilder& p) {
        wire::RecordWalk walk(p.bytes());
        for (wire::RecordView r; walk.next(r);)
            if (CommandKinds::all()[r.opcode].frame == FrameRole::Ends) return true;
        return false;
    }
    // Returns the frame with occasional differences at any position.
    PacketBuilder likeFrame(const std::vector<PacketBuilder>& commands, uint32_t changes) {
        PacketBuilder p;
        for (const PacketBuilder& c : commands) {
            if (below(changes) == 0) command(p);
            if (c.bytes().empty())
                primitive(p, changes);
            else if (below(changes) != 0)
                p.append(c);
        }
        return p.swap(1, ++frame_);
    }

private:
    // Few different values, so that some repeat.
    std::vector<uint32_t> value(uint32_t words) { return std::vector<uint32_t>(words, below(5)); }
    void withValue(PacketBuilder& p, uint16_t opcode, std::vector<uint32_t> arguments,
                   const std::vector<uint32_t>& value, const std::vector<uint32_t>& behind = {}) {
        if (below(3) == 0) { // as a blob in two pieces
            const uint32_t half = static_cast<uint32_t>(value.size() / 2),
                           rest = static_cast<uint32_t>(value.size()) - half;
            p.record(wire::kOpBlobBegin, {static_cast<uint32_t>(value.size() * 4), 0});
            std::vector<uint32_t> piece{half * 4};
            piece.insert(piece.end(), value.begin(), value.begin() + half);
            p.record(wire::kOpBlobData, piece);
            piece = {rest * 4};
            piece.insert(piece.end(), value.begin() + half, value.end());
            p.longRecord(wire::kOpBlobData, piece);
            arguments.push_back(record::kTagBlob);
        } else {
            arguments.push_back(static_cast<uint32_t>(value.size() * 4));
            arguments.insert(arguments.end(), value.begin(), value.end());
        }
        arguments.insert(arguments.end(), behind.begin(), behind.end());
        if (below(2) == 0)
            p.record(opcode, arguments);
        else
            p.longRecord(opcode, arguments);
    }
    uint32_t name() { return 1 + below(kNames); }
    uint32_t target() { return below(3) == 0 ? GL_ELEMENT_ARRAY_BUFFER : GL_ARRAY_BUFFER; }

    void command(PacketBuilder& p) {
        if (below(3) == 0) return small(p);
        switch (below(26)) {
        case 0: p.record(op::glActiveTexture, {GL_TEXTURE0 + below(2)}); return;
        case 1:
        case 2: p.record(op::glBindTexture, {GL_TEXTURE_2D, below(kNames + 1)}); return;
        case 3:
        case 4:
            return withValue(p, op::glTexImage2D,
                             {GL_TEXTURE_2D, below(2), GL_RGBA, 16, 16 + 16 * below(2), 0, GL_RGBA, GL_UNSIGNED_BYTE},
                             value(256));
        case 5:
            return withValue(p, op::glTexSubImage2D,
                             {GL_TEXTURE_2D, below(2), 8 * below(2), 0, 16U >> below(2), 16, GL_RGBA, GL_UNSIGNED_BYTE},
                             value(200));
        case 6: p.record(op::glTexParameteri, {GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER + below(3), below(9)}); return;
        case 7: p.record(op::glGenerateMipmap, {GL_TEXTURE_2D}); return;
        case 8:
        case 9: p.record(op::glBindBuffer, {target(), below(kNames + 1)}); return;
        case 10:
            return withValue(p, op::glBufferData, {target(), kBufferBytes, 0}, value(kBufferBytes / 4),
                             {GL_STATIC_DRAW});
        case 11: return withValue(p, op::glBufferSubData, {target(), 128 * below(3), 0, 600, 0}, value(150));
        case 12: return withValue(p, wire::kOpBufferBytes, {name(), 64 * below(3), 0}, value(150));
        case 13: p.record(op::glVertexAttribPointer, {below(3), 4, GL_FLOAT, 0, 0, 0}); return;
        case 14: p.record(op::glBindVertexArray, {below(kNames + 1)}); return;
        case 15: p.record(op::glUseProgram, {name()}); return;
        case 16: return withValue(p, op::glUniformMatrix4fv, {below(3), 1, 0}, value(16));
        case 17: p.record(op::glBegin, {GL_POINTS}).record(op::glVertex2f, {0, 0}).record(op::glEnd, {}); return;
        case 18: return rare(p);
        case 19: p.record(op::glBindBuffer, {GL_PIXEL_UNPACK_BUFFER, below(4) == 0 ? name() : 0}); return;
        case 20: p.record(op::glCopyTexSubImage2D, {GL_TEXTURE_2D, below(2), 0, 0, 0, 0, 4, 4}); return;
        case 21:
            p.record(op::glPushAttrib, {GL_TEXTURE_BIT | (below(2) == 0 ? GL_ENABLE_BIT : 0U)})
                .record(op::glBindTexture, {GL_TEXTURE_2D, name()})
                .record(op::glActiveTexture, {GL_TEXTURE0 + below(2)});
            if (below(2) == 0)
                withValue(p, op::glTexImage2D, {GL_TEXTURE_2D, 0, GL_RGBA, 16, 16, 0, GL_RGBA, GL_UNSIGNED_BYTE},
                          value(256));
            for (uint32_t i = below(3); i > 0; --i) small(p);
            p.record(op::glPopAttrib, {});
            return;
        default:
            if (!fewDraws_ || below(8) == 0) p.record(op::glDrawArrays, {GL_TRIANGLES, 0, 3});
            return;
        }
    }
    void binds(PacketBuilder& p) {
        switch (below(12)) {
        case 0:
        case 1: p.record(op::glActiveTexture, {GL_TEXTURE0 + below(2)}); return;
        case 2: p.record(op::glBindBuffer, {target(), below(kNames + 1)}); return;
        case 3: p.record(op::glVertexAttribPointer, {below(3), 4, GL_FLOAT, 0, 0, 0}); return;
        case 4: p.record(op::glBindVertexArray, {below(kNames + 1)}); return;
        case 5:
            if (below(20) == 0) p.record(op::glDrawArrays, {GL_TRIANGLES, 0, 3});
            return;
        default: p.record(op::glBindTexture, {GL_TEXTURE_2D, below(kNames + 1)}); return;
        }
    }
    void somethingElse(PacketBuilder& p) {
        const uint32_t unit = below(2);
        if (below(2) == 0) p.record(op::glActiveTexture, {GL_TEXTURE0 + unit});
        if (below(8) == 0) p.record(op::glBindTexture, {GL_TEXTURE_2D, name()});
        if (below(5) == 0)
            withValue(p, op::glTexImage2D, {GL_TEXTURE_2D, 0, GL_RGBA, 16, 16, 0, GL_RGBA, GL_UNSIGNED_BYTE},
                      value(256));
        if (below(4) == 0) p.record(op::glDrawArrays, {GL_TRIANGLES, 0, 3});
        if (below(2) == 0) p.record(op::glActiveTexture, {GL_TEXTURE0});
    }
    void upload(PacketBuilder& p) {
        if (below(2) == 0)
            withValue(p, op::glTexImage2D, {GL_TEXTURE_2D, 0, GL_RGBA, 16, 16, 0, GL_RGBA, GL_UNSIGNED_BYTE},
                      value(256));
        else
            withValue(p, op::glBufferData, {target(), kBufferBytes, 0}, value(kBufferBytes / 4), {GL_STATIC_DRAW});
        if (below(2) == 0) p.record(op::glDrawArrays, {GL_TRIANGLES, 0, 3});
    }
    // Their addresses change too.
    void otherNames(PacketBuilder& p) {
        const uint32_t n = name(), other = n % kNames + 1;
        p.record(op::glDeleteTextures, {1, 4, n})
            .record(op::glDeleteTextures, {1, 4, other})
            .record(op::glGenTextures, {1, 4, n})
            .record(op::glGenTextures, {1, 4, other});
    }
    // Binding within it is an error.
    void primitive(PacketBuilder& p, uint32_t changes) {
        p.record(op::glBegin, {GL_POINTS});
        if (below(changes) == 0) p.record(op::glBindTexture, {GL_TEXTURE_2D, name()});
        p.record(op::glVertex2f, {below(3), 0});
        if (below(changes) == 0) p.record(op::glActiveTexture, {GL_TEXTURE0 + below(2)});
        p.record(op::glEnd, {});
    }
    // Few values of few states, so that many are unchanged.
    void small(PacketBuilder& p) {
        switch (below(17)) {
        case 0:
        case 1:
            p.record(below(2) == 0 ? op::glEnable : op::glDisable,
                     {below(2) == 0 ? 0U + GL_BLEND : 0U + GL_DEPTH_TEST});
            return;
        case 2: p.record(below(2) == 0 ? op::glEnable : op::glDisable, {GL_TEXTURE_2D}); return;
        case 3: p.record(op::glDepthFunc, {below(4) == 0 ? 77U : GL_LESS + below(2)}); return; // 77: rejected
        case 4: p.record(op::glStencilFunc, {GL_LESS, below(2), 255}); return;
        case 5: p.record(op::glStencilFuncSeparate, {GL_FRONT + below(2), GL_LESS, below(2), 255}); return;
        case 6: p.record(op::glViewport, {0, 0, 8 + below(2), 8}); return;
        case 7: p.record(op::glClearColor, {below(2), 0, 0, 0}); return;
        case 8: p.record(op::glMatrixMode, {GL_MODELVIEW + below(2)}); return;
        case 9: p.record(op::glLoadMatrixf, value(16)); return;
        case 10: p.record(op::glClear, {GL_COLOR_BUFFER_BIT}); return;
        case 11:
        case 12: p.record(op::glUniform1f, {3 + below(4), below(2)}); return;
        // 99: rejected, it is a sampler
        case 13: p.record(op::glUniform1i, {6, below(3) == 0 ? 99U : below(2)}); return;
        case 14: return withValue(p, op::glUniform1fv, {3 + below(2), 1 + below(2)}, value(2));
        case 15: p.record(op::glProgramUniform1f, {name(), 3 + below(3), below(2)}); return;
        default:
            if (below(8) == 0)
                p.record(op::glNewList, {2, GL_COMPILE}).record(op::glEnable, {GL_BLEND}).record(op::glEndList, {});
            p.record(op::glCallList, {2});
            return;
        }
    }
    void rare(PacketBuilder& p) {
        switch (below(10)) {
        case 8: p.record(op::glPushAttrib, {GL_TEXTURE_BIT}); return;
        case 9: p.record(op::glPopAttrib, {}); return;
        case 0: return otherNames(p);
        case 1: {
            const uint32_t n = name();
            if (!shares_) p.record(op::glDeleteBuffers, {1, 4, n}).record(op::glGenBuffers, {1, 4, n});
            return;
        }
        case 2:
            p.record(op::glBindFramebuffer, {GL_FRAMEBUFFER, 1})
                .record(op::glFramebufferTexture2D, {GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 1, 0});
            return;
        case 3: p.record(op::glBindFramebuffer, {GL_FRAMEBUFFER, 0}); return;
        case 4:
            p.record(op::glNewList, {1, GL_COMPILE})
                .record(op::glDrawArrays, {GL_TRIANGLES, 0, 3})
                .record(op::glEndList, {});
            return;
        case 5:
            if (below(4) == 0)
                p.record(op::glNewList, {1, GL_COMPILE})
                    .record(op::glBindTexture, {GL_TEXTURE_2D, name()})
                    .record(op::glDrawArrays, {GL_TRIANGLES, 0, 3})
                    .record(op::glEndList, {});
            return;
        case 6: p.record(op::glCallList, {1}); return;
        default: p.record(wire::kOpRequestTexImage, {1, 1, name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, 0, 0});
        }
    }

    std::mt19937 random_;
    const bool shares_, fewDraws_;
    uint32_t frame_ = 0;
};

struct Won {
    size_t deferred = 0, dropped = 0, alike = 0; // records
};

// The effect of the original packets on a node, and of the filter's output.
class Both {
public:
    Both(RandomProgram& program, uint64_t maxBytes, bool small, uint32_t toggles)
        : program_(program), maxBytes_(maxBytes), toggles_(toggles) {
        filter_.setDropsRedundant(small);
    }

    // Sends in pieces: values may be divided between two packets, but not between streams.
    void send(uint32_t stream, const PacketBuilder& p) {
        const auto bytes = p.bytes();
        wire::RecordWalk walk(bytes);
        wire::RecordView r;
        size_t from = 0;
        while (walk.next(r)) {
            if (program_.below(8) != 0) continue;
            give(stream, bytes.subspan(from, r.offset + r.sizeBytes - from));
            from = r.offset + r.sizeBytes;
        }
        if (from < bytes.size()) give(stream, bytes.subspan(from));
        ASSERT_EQ(held_.seen(), whole_.seen());
        ASSERT_LE(filter_.counts().deferredBytes, maxBytes_);
    }
    void ends(Won& won) {
        filter_.releaseAll();
        EXPECT_EQ(held_.all(), whole_.all()) << "what was held is lost";
        EXPECT_EQ(filter_.counts().deferredBytes, 0u);
        won.deferred += filter_.counts().deferredRecords;
        won.dropped += filter_.counts().droppedRecords;
        won.alike += filter_.counts().alikeRecords;
    }

private:
    void give(uint32_t stream, std::span<const std::byte> payload) {
        if (program_.below(toggles_) == 0) filter_.setDropsRedundant(program_.below(3) != 0);
        whole_.packet(stream, payload);
        filter_.add(stream, payload);
    }

    RandomProgram& program_;
    const uint64_t maxBytes_;
    const uint32_t toggles_; // mean number of packets between them
    SeenModel whole_, held_;
    CommandFilter filter_{maxBytes_,
                          [this](uint32_t stream, std::span<const std::byte> payload, const RecordOffsets* walked) {
                              ASSERT_LE(payload.size(), wire::kMaxPacketBytes);
                              if (walked != nullptr) isMadeOf(payload, *walked);
                              held_.packet(stream, payload);
                          }};
    static void isMadeOf(std::span<const std::byte> payload, const RecordOffsets& offsets) {
        wire::RecordWalk walk(payload);
        wire::RecordView r;
        while (walk.next(r)) {}
        ASSERT_NE(walk.whole(), nullptr);
        ASSERT_EQ(offsets.records, walk.whole()->records);
        ASSERT_EQ(offsets.lastBytes, walk.whole()->lastBytes);
        ASSERT_EQ(offsets.longAt, walk.whole()->longAt);
    }
};

constexpr uint32_t kFirst = wire::streamOf(1, 0), kSecond = wire::streamOf(1, 1);

void same(uint32_t seed, bool shares, uint64_t maxBytes, Won& won) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomProgram program(seed, shares);
    Both both(program, maxBytes, true, 40);
    both.send(kFirst, program.begin());
    if (shares) both.send(kSecond, program.other());
    uint32_t stream = kFirst;
    for (int i = 0; i < 60 && !::testing::Test::HasFatalFailure(); ++i) {
        const PacketBuilder p = program.packet();
        if (shares && program.below(3) == 0) stream = stream == kFirst ? kSecond : kFirst;
        both.send(stream, p);
    }
    both.ends(won);
}

// Similar frames, as most programs send.
void sameFrames(uint32_t seed, Won& won) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomProgram program(seed, false);
    Both both(program, 1 << 20, false, 600);
    both.send(kFirst, program.begin());
    for (int scene = 0; scene < 3; ++scene) {
        const std::vector<PacketBuilder> frame = program.frame();
        const uint32_t changes = program.below(3) == 0 ? 20 : 1000;
        for (int i = 0; i < 40 && !::testing::Test::HasFatalFailure(); ++i)
            both.send(kFirst, program.likeFrame(frame, changes));
    }
    both.ends(won);
}

void bindingFrames(uint32_t seed, Won& won) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomProgram program(seed, false);
    Both both(program, 1 << 20, false, seed % 4 == 0 ? 500 : 20'000);
    both.send(kFirst, program.begin());
    for (int scene = 0; scene < 2; ++scene) {
        const std::vector<PacketBuilder> frame = program.bindingFrame();
        for (int i = 0; i < 30 && !::testing::Test::HasFatalFailure(); ++i)
            both.send(kFirst, program.withUpload(frame));
    }
    both.ends(won);
}

void slidingFrames(uint32_t seed, Won& won) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomProgram program(seed, false);
    Both both(program, 1 << 20, false, 20'000);
    both.send(kFirst, program.begin());
    for (int scene = 0; scene < 2; ++scene) {
        const std::vector<PacketBuilder> frame = program.textureFrame();
        for (int i = 0; i < 200 && !::testing::Test::HasFatalFailure(); ++i)
            both.send(kFirst, program.withOtherEnd(frame));
    }
    both.ends(won);
}

TEST(FilteredStreams, showTheSameToEachDraw) {
    Won won;
    for (uint32_t seed = 0; seed < rounds(400) && !HasFatalFailure(); ++seed) same(seed, false, 1 << 20, won);
    EXPECT_GT(won.deferred, rounds(10'000)) << "or this shows nothing";
    EXPECT_GT(won.dropped, rounds(1000));
}

TEST(FilteredStreams, showTheSameInSimilarFrames) {
    Won won;
    for (uint32_t seed = 0; seed < rounds(50) && !HasFatalFailure(); ++seed) sameFrames(seed, won);
    EXPECT_GT(won.alike, rounds(10'000)) << "or this shows nothing";
    EXPECT_GT(won.deferred, rounds(1000));
}

TEST(FilteredStreams, showTheSameInFramesWithManyBindings) {
    Won won;
    for (uint32_t seed = 0; seed < rounds(150) && !HasFatalFailure(); ++seed) bindingFrames(seed, won);
    EXPECT_GT(won.alike, rounds(50'000)) << "or this shows nothing";
    EXPECT_GT(won.deferred, rounds(500));
}

TEST(FilteredStreams, showTheSameInFramesThatLeaveOtherTexturesBound) {
    Won won;
    for (uint32_t seed = 0; seed < rounds(75) && !HasFatalFailure(); ++seed) slidingFrames(seed, won);
    EXPECT_GT(won.alike, rounds(500'000)) << "or this shows nothing";
    EXPECT_GT(won.deferred, rounds(250));
}

TEST(FilteredStreams, showTheSameWithTwoSharingThreads) {
    Won won;
    for (uint32_t seed = 0; seed < rounds(200) && !HasFatalFailure(); ++seed) same(seed, true, 1 << 20, won);
}

TEST(FilteredStreams, showTheSameWithLittleMemory) {
    Won won;
    for (uint32_t seed = 0; seed < rounds(100) && !HasFatalFailure(); ++seed) same(seed, false, 3000, won);
}

} // namespace
} // namespace mural::filter
