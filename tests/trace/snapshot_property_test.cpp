// Random programs: the snapshot of a stream leaves the same state as the whole stream.
#include <gtest/gtest.h>
#include <random>

#include "streamcodec/snapshot/stream_snapshot.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "tests/sanitized.hpp"
#include "tests/trace/recorded.hpp"
#include "tests/trace/state_model.hpp"

namespace mural::trace {
namespace {

constexpr uint32_t kNames = 4; // of each kind

class RandomProgram {
public:
    explicit RandomProgram(uint32_t seed) : random_(seed) {}

    PacketBuilder begin() {
        PacketBuilder p;
        p.context(1).window(1, 20, 10).record(wire::kOpMakeCurrent, {1, 1, 1});
        for (uint32_t name = 1; name <= kNames; ++name) {
            p.record(op::glGenTextures, {1, 4, name})
                .record(op::glBindTexture, {GL_TEXTURE_2D, name})
                .record(op::glTexImage2D, image(name));
            p.record(op::glGenBuffers, {1, 4, name})
                .record(op::glGenQueries, {1, 4, name})
                .record(op::glCreateProgram, {name});
        }
        for (uint32_t name = 1; name <= 2; ++name) {
            p.record(op::glGenFramebuffers, {1, 4, name}).record(op::glBindFramebuffer, {GL_FRAMEBUFFER, name});
            p.record(op::glFramebufferTexture2D, {GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, name, 0});
        }
        p.record(op::glBindFramebuffer, {GL_FRAMEBUFFER, 0}).record(op::glGenLists, {2, 1});
        return p;
    }
    // About a frame of commands, mostly valid.
    PacketBuilder packet() {
        PacketBuilder p;
        for (uint32_t i = below(60); i > 0; --i) command(p);
        if (below(4) == 0) p.swap(1, ++frame_);
        return p;
    }

private:
    uint32_t below(uint32_t n) { return random_() % n; }
    static std::vector<uint32_t> image(uint32_t value) {
        return {GL_TEXTURE_2D, 0, GL_RGBA, value + 1, 8, 0, GL_RGBA, GL_UNSIGNED_BYTE, record::kTagNull};
    }
    uint32_t cap() { return std::array{GL_BLEND, GL_CULL_FACE, GL_SCISSOR_TEST, GL_FOG}[below(4)]; }

    void state(PacketBuilder& p) {
        switch (below(9)) {
        case 0: p.record(op::glEnable, {cap()}); return;
        case 1: p.record(op::glDisable, {cap()}); return;
        case 2: p.record(op::glColor3f, {below(9), 0, 0}); return;
        case 3: p.record(op::glLoadIdentity, {}); return;
        case 4: p.record(op::glTranslatef, {below(99), 0, 0}); return;
        case 5: p.record(op::glMatrixMode, {GL_MODELVIEW + below(2)}); return;
        case 6: p.record(op::glUseProgram, {1 + below(kNames)}); return;
        case 7: p.record(op::glUniform1f, {below(3), below(99)}); return;
        default: p.record(op::glClearColor, {below(9), 0, 0, 0});
        }
    }
    void command(PacketBuilder& p) {
        switch (below(19)) {
        case 0: p.record(op::glActiveTexture, {GL_TEXTURE0 + below(2)}); return;
        case 1: p.record(op::glBindTexture, {GL_TEXTURE_2D, 1 + below(kNames)}); return;
        case 2: p.record(op::glTexParameteri, {GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER + below(3), below(9)}); return;
        case 3: p.record(op::glTexImage2D, image(below(50))); return;
        case 4: p.record(op::glBindBuffer, {GL_ARRAY_BUFFER, 1 + below(kNames)}); return;
        case 5: p.record(op::glBufferData, {GL_ARRAY_BUFFER, 8, 0, 8, below(26), 0, GL_STATIC_DRAW}); return;
        case 6: p.record(op::glBufferSubData, {GL_ARRAY_BUFFER, below(3) * 4, 0, 4, 0, 4, below(999)}); return;
        case 7:
            if (below(3) == 0)
                p.record(op::glClear, {GL_COLOR_BUFFER_BIT}).record(op::glDrawArrays, {GL_TRIANGLES, 0, 3});
            return;
        case 8: p.record(op::glDrawArrays, {GL_TRIANGLES, 0, 3}); return;
        case 9:
            p.record(op::glBegin, {GL_POINTS})
                .record(op::glColor3f, {below(9), 0, 0})
                .record(op::glVertex2f, {0, 0})
                .record(op::glEnd, {});
            return;
        case 10: p.record(op::glBindFramebuffer, {GL_FRAMEBUFFER, below(3)}); return;
        case 11: return brackets(p);
        case 12:
            if (below(4) == 9) return listed(p);
            p.record(op::glCallList, {1 + below(2)});
            return;
        case 13:
            if (below(6) == 0) return remade(p);
            [[fallthrough]];
        default: return state(p);
        }
    }
    void brackets(PacketBuilder& p) {
        switch (below(5)) {
        case 0: p.record(op::glPushMatrix, {}); break;
        case 1: p.record(op::glPopMatrix, {}); break;
        case 2:
            p.record(op::glPushAttrib, {std::array<uint32_t, 4>{GL_ENABLE_BIT, GL_TEXTURE_BIT,
                                                                GL_ENABLE_BIT | GL_CURRENT_BIT | GL_TRANSFORM_BIT,
                                                                GL_ALL_ATTRIB_BITS}[below(4)]});
            break;
        case 3: p.record(op::glPopAttrib, {}); break;
        default:
            p.record(op::glBeginQuery, {GL_SAMPLES_PASSED, 1 + below(kNames)})
                .record(op::glDrawArrays, {GL_TRIANGLES, 0, 3})
                .record(op::glEndQuery, {GL_SAMPLES_PASSED});
        }
    }
    void listed(PacketBuilder& p) {
        p.record(op::glNewList, {1 + below(2), GL_COMPILE});
        for (uint32_t i = below(6); i > 0; --i) {
            if (below(3) == 0)
                p.record(op::glDrawArrays, {GL_TRIANGLES, 0, 3});
            else if (below(4) == 0)
                p.record(op::glBindTexture, {GL_TEXTURE_2D, 1 + below(kNames)});
            else
                state(p);
        }
        p.record(op::glEndList, {});
    }
    void remade(PacketBuilder& p) {
        const uint32_t name = 1 + below(kNames);
        p.record(op::glDeleteTextures, {1, 4, name})
            .record(op::glGenTextures, {1, 4, name})
            .record(op::glBindTexture, {GL_TEXTURE_2D, name})
            .record(op::glTexImage2D, image(below(50)));
    }

    std::mt19937 random_;
    uint32_t frame_ = 0;
};

TEST(SnapshotProperty, leavesTheStateOfTheWholeStream) {
    size_t whole = 0, snapshotBytes = 0;
    for (uint32_t seed = 1; seed <= (testing::kSanitized ? 20U : 300U); ++seed) {
        RandomProgram program(seed);
        snapshot::LiveCommandLog log;
        StateModel all;
        const auto give = [&](const PacketBuilder& packet) {
            all.packet(packet.bytes());
            whole += packet.bytes().size();
            log.append(wire::streamOf(1, 0), packet.bytes());
        };
        give(program.begin());
        for (int i = 0; i < 40; ++i) {
            give(program.packet());
            if (i % 10 != 9 && seed % 3 != 0) continue; // repeated passes, or one at the end
            log.compact();
            StateModel some;
            size_t bytes = 0;
            log.forEach([&](uint32_t, std::span<const std::byte> records) {
                some.packet(records);
                bytes += records.size();
            });
            ASSERT_EQ(some.text(), all.text()) << "seed " << seed << ", packet " << i;
            if (i == 39) snapshotBytes += bytes;
        }
    }
    // The reduction is worthwhile.
    EXPECT_LT(snapshotBytes * 5, whole * 3);
    RecordProperty("keptBytes", static_cast<int>(snapshotBytes));
}

} // namespace
} // namespace mural::trace
