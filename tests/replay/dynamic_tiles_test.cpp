// Moving areas and zooms: the time at which a window adopts them, and its area and zoom before.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "encoders.hpp"
#include "gl_opcodes.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/replies.hpp"
#include "tests/fuzz/fake_gl.hpp"
#include "tests/interposer/encoder_harness.hpp"

namespace mural {
namespace {

constexpr GLbitfield kColour = GL_COLOR_BUFFER_BIT, kDepth = GL_DEPTH_BUFFER_BIT, kStencil = GL_STENCIL_BUFFER_BIT;
constexpr PixelViewport kLeft{0, 0, 32, 32}, kRight{32, 0, 32, 32};

ViewportAssignment leftAndRight(uint32_t number, bool swapped) {
    const Viewport left{0, 0, 0.5, 1}, right{0.5, 0, 0.5, 1};
    return {number, swapped ? std::vector<Viewport>{right, left} : std::vector<Viewport>{left, right}};
}

// Node 0 of two starts with the left half of a window of 64x32 pixels, and is to get the right one.
class DynamicTiles : public ::testing::Test {
protected:
    void SetUp() override { replay_ = make(false); }

    std::unique_ptr<Replay> make(bool isResyncing, PlayerConfig config = {}) {
        config.areas = leftAndRight(0, false);
        config.isResyncing = isResyncing;
        PlayerOutputs out;
        out.frameDone = [this](const PlayerOutputs::Frame& f) { frame_ = f; };
        out.answer = [this](const wire::ReplyPartHeader& h, std::span<const std::byte>) { answer_ = h; };
        fuzz::FakeGlOptions options;
        options.drew = [this](bool scissored, const std::array<int, 4>& box) {
            drawn_.push_back(scissored ? PixelViewport{box[0], box[1], box[2], box[3]} : PixelViewport{0, 0, 64, 32});
        };
        return std::make_unique<Replay>(fuzz::makeFakePlatform(options), config, out);
    }

    void open(uint8_t depth = 24, uint8_t stencil = 0, uint8_t accum = 0) {
        wire::WindowConfig c{};
        c.width = 64;
        c.height = 32;
        c.doubleBuffer = 1;
        c.depth = depth;
        c.stencil = stencil;
        c.accum = accum;
        records::window(t_, 1, c);
        records::createContext(t_, {1, 0, 0, 4, 5, 0, 0, c});
        records::makeCurrent(t_, 1, 1, 1);
        send();
    }
    void send() {
        for (const auto& packet : encoder_.takePackets()) ASSERT_TRUE(replay_->packet(wire::streamOf(1, 1), packet));
    }
    void draw() { encode_glRectf(t_, -1, -1, 1, 1); }
    // This node's part of the window in this frame.
    PixelViewport shown() {
        records::swap(t_, 1, ++frames_);
        send();
        return frame_.region;
    }
    void announce(uint32_t number = 1, bool swapped = true) {
        send();
        replay_->moveAreas(leftAndRight(number, swapped));
    }

    testing::EncoderHarness encoder_;
    ThreadState& t_ = encoder_.thread();
    std::unique_ptr<Replay> replay_;
    PlayerOutputs::Frame frame_{};
    wire::ReplyPartHeader answer_{};
    std::vector<PixelViewport> drawn_; // or cleared
    uint32_t frames_ = 0;
};

TEST_F(DynamicTiles, areAdoptedAtTheNextFullClear) {
    open();
    encode_glEnable(t_, GL_DEPTH_TEST);
    encode_glClear(t_, kColour | kDepth);
    draw();
    announce();
    EXPECT_EQ(shown(), kLeft) << "announced in the middle of a frame";
    EXPECT_EQ(frame_.areas, 0u);
    draw();
    EXPECT_EQ(shown(), kLeft) << "a frame that is drawn over the one before";
    drawn_.clear();
    draw();
    encode_glClear(t_, kColour | kDepth);
    draw();
    EXPECT_EQ(shown(), kRight);
    EXPECT_EQ(frame_.areas, 1u);
    EXPECT_EQ(drawn_, (std::vector<PixelViewport>{kLeft, {0, 0, 64, 32}, kRight}))
        << "what was the other node's is cleared here, too";
}

TEST_F(DynamicTiles, waitForEachBufferThatIsDrawnTo) {
    open(24, 8);
    encode_glEnable(t_, GL_DEPTH_TEST);
    draw();
    announce();
    encode_glClear(t_, kColour);
    EXPECT_EQ(shown(), kLeft) << "depths are left";
    encode_glClear(t_, kDepth);
    EXPECT_EQ(shown(), kRight) << "stencils are not: nothing ever drew any";
    encode_glEnable(t_, GL_STENCIL_TEST);
    draw();
    announce(2, false);
    encode_glClear(t_, kColour | kDepth);
    EXPECT_EQ(shown(), kRight);
    encode_glClear(t_, kColour | kDepth | kStencil);
    EXPECT_EQ(shown(), kLeft);
}

TEST_F(DynamicTiles, considerDrawsBetweenClears) {
    open();
    encode_glEnable(t_, GL_DEPTH_TEST);
    draw();
    announce();
    encode_glClear(t_, kDepth);
    draw();
    encode_glClear(t_, kColour);
    EXPECT_EQ(shown(), kLeft);
    encode_glClear(t_, kDepth);
    EXPECT_EQ(shown(), kRight) << "in a later frame, as nothing was drawn since";
}

TEST_F(DynamicTiles, ignorePartialClears) {
    open();
    draw();
    announce();
    encode_glEnable(t_, GL_SCISSOR_TEST);
    encode_glScissor(t_, 0, 0, 64, 31);
    encode_glClear(t_, kColour);
    EXPECT_EQ(shown(), kLeft);
    encode_glDisable(t_, GL_SCISSOR_TEST);
    encode_glColorMask(t_, GL_TRUE, GL_TRUE, GL_FALSE, GL_TRUE);
    encode_glClear(t_, kColour);
    EXPECT_EQ(shown(), kLeft);
    encode_glColorMask(t_, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    encode_glClear(t_, kColour | 1); // an error
    EXPECT_EQ(shown(), kLeft);
    const GLfloat colour[] = {0, 0, 0, 0};
    encode_glClearBufferfv(t_, GL_COLOR, 1, DataArg::of(colour, sizeof colour)); // of another draw buffer
    EXPECT_EQ(shown(), kLeft);
    encode_glBegin(t_, GL_LINES);
    encode_glClear(t_, kColour); // an error
    encode_glEnd(t_);
    EXPECT_EQ(shown(), kLeft);
    encode_glClearBufferfv(t_, GL_COLOR, 0, DataArg::of(colour, sizeof colour));
    EXPECT_EQ(shown(), kRight);
}

TEST_F(DynamicTiles, useTheLatestOnly) {
    open();
    draw();
    announce(1, true);
    announce(2, false);
    encode_glClear(t_, kColour);
    EXPECT_EQ(shown(), kLeft);
    EXPECT_EQ(frame_.areas, 2u);
}

TEST_F(DynamicTiles, areAdoptedAfterAClearWithoutDraws) {
    open();
    encode_glEnable(t_, GL_DEPTH_TEST);
    draw();
    encode_glClear(t_, kColour | kDepth);
    announce();
    draw();
    EXPECT_EQ(shown(), kRight);
}

TEST_F(DynamicTiles, applyTheLatestToNewWindowsAndSizes) {
    announce();
    open();
    EXPECT_EQ(shown(), kRight);
    draw();
    announce(2, false);
    wire::WindowConfig c{};
    c.width = 128;
    c.height = 32;
    c.doubleBuffer = 1;
    records::window(t_, 1, c);
    EXPECT_EQ(shown(), (PixelViewport{0, 0, 64, 32}));
}

TEST_F(DynamicTiles, stayForFrontDrawsAndAccumulation) {
    open(24, 0, 16);
    encode_glDrawBuffer(t_, GL_FRONT);
    draw();
    encode_glDrawBuffer(t_, GL_BACK);
    announce();
    for (int frame = 0; frame < 60; ++frame) {
        encode_glClear(t_, kColour | kDepth);
        EXPECT_EQ(shown(), kLeft);
        EXPECT_EQ(frame_.keepsAreas, frame == 59) << "said after a while";
    }
}

TEST_F(DynamicTiles, reportAWindowThatIsNeverCleared) {
    open();
    draw();
    announce();
    for (int frame = 0; frame < 60; ++frame) {
        EXPECT_FALSE(frame_.keepsAreas);
        draw();
        EXPECT_EQ(shown(), kLeft);
    }
    EXPECT_TRUE(frame_.keepsAreas);
}

TEST_F(DynamicTiles, considerDisplayLists) {
    open();
    encode_glNewList(t_, 1, GL_COMPILE);
    encode_glClear(t_, kColour | kDepth);
    encode_glEndList(t_);
    encode_glNewList(t_, 2, GL_COMPILE);
    encode_glEnable(t_, GL_DEPTH_TEST);
    draw();
    encode_glDisable(t_, GL_DEPTH_TEST);
    encode_glEndList(t_);
    encode_glCallList(t_, 2);
    announce();
    encode_glClear(t_, kColour);
    EXPECT_EQ(shown(), kLeft) << "the list has drawn depths, though the test is off before and behind it";
    encode_glCallList(t_, 1);
    EXPECT_EQ(shown(), kRight) << "and one clears all";
    announce(2, false);
    encode_glNewList(t_, 3, GL_COMPILE_AND_EXECUTE);
    draw();
    encode_glEndList(t_);
    encode_glClear(t_, kColour);
    EXPECT_EQ(shown(), kRight);
    encode_glClear(t_, kColour | kDepth);
    EXPECT_EQ(shown(), kLeft);
}

// The driver clears the node's part only.
TEST_F(DynamicTiles, acceptClearsOfBuffersInLists) {
    open();
    const GLfloat depth = 0.5F;
    encode_glNewList(t_, 1, GL_COMPILE);
    encode_glClearBufferfv(t_, GL_DEPTH, 0, DataArg::of(&depth, sizeof depth));
    encode_glEndList(t_);
    encode_glCallList(t_, 1);
    announce();
    encode_glClear(t_, kColour);
    EXPECT_EQ(shown(), kLeft);
    encode_glClear(t_, kDepth);
    EXPECT_EQ(shown(), kRight);
}

TEST_F(DynamicTiles, answerForTheAreaAtThePosition) {
    open();
    draw();
    announce();
    const auto area = [&] {
        records::requestPixels(t_, 1, 0, 0, 64, 32, GL_RGBA, GL_UNSIGNED_BYTE, 4);
        send();
        return PixelViewport{answer_.x, answer_.y, answer_.w, answer_.h};
    };
    EXPECT_EQ(area(), kLeft);
    encode_glClear(t_, kColour);
    EXPECT_EQ(area(), kRight);
}

// A returning node gets the state that a member reports.
TEST_F(DynamicTiles, areReportedToReturningNodes) {
    open();
    draw();
    announce();
    const auto sentAreas = replay_->memberAreas();
    replay_ = make(true);
    open();
    draw();
    EXPECT_EQ(shown(), kLeft);
    ASSERT_TRUE(replay_->takeMemberAreas(sentAreas));
    encode_glClear(t_, kColour);
    EXPECT_EQ(shown(), kRight) << "they were announced before it came";
    EXPECT_EQ(frame_.areas, 1u);
    EXPECT_NE(replay_->memberAreas(), sentAreas);
}

TEST_F(DynamicTiles, rejectInvalidReports) {
    open();
    const auto sentAreas = replay_->memberAreas();
    for (size_t size = 0; size < sentAreas.size(); ++size) {
        replay_ = make(true);
        open();
        EXPECT_FALSE(replay_->takeMemberAreas(std::span(sentAreas).first(size)))
            << size << " of " << sentAreas.size() << " bytes";
    }
}

// Node 0 starts with the left half at full size, and is to draw the same half with half the size in both directions.
class DynamicZooms : public DynamicTiles {
protected:
    void SetUp() override { replay_ = makeZooming(false); }
    std::unique_ptr<Replay> makeZooming(bool isResyncing) {
        PlayerConfig config;
        config.anyMovesZoom = config.movesZoom = true;
        return make(isResyncing, config);
    }
    void announceZoom(double zoom, uint32_t number = 1) {
        send();
        ViewportAssignment areas = leftAndRight(number, false);
        areas.zooms = {zoom, 1};
        replay_->moveAreas(areas);
    }
    // The first frames are drawn without zoom, until it is known that the program reads nothing.
    void drawPlainFrames() {
        for (int i = 0; i < 2; ++i) {
            encode_glClear(t_, kColour);
            draw();
            EXPECT_EQ(shown(), kLeft);
            EXPECT_TRUE(frame_.isUnzoomed);
        }
    }
    // The pixels that the latest draw could change.
    PixelViewport drawnBox() {
        drawn_.clear();
        draw();
        send();
        return drawn_.back();
    }
};
constexpr PixelViewport kHalf{0, 0, 16, 16};

TEST_F(DynamicZooms, areAdoptedAtTheNextFullClear) {
    open();
    drawPlainFrames();
    encode_glClear(t_, kColour);
    EXPECT_EQ(drawnBox(), kLeft);
    announceZoom(.5);
    EXPECT_EQ(drawnBox(), kLeft) << "announced in the middle of a frame";
    EXPECT_EQ(shown(), kLeft);
    EXPECT_EQ(drawnBox(), kLeft) << "a frame that is drawn over the one before";
    encode_glClear(t_, kColour);
    EXPECT_EQ(drawnBox(), kHalf);
    EXPECT_EQ(shown(), kLeft) << "the shown size";
    EXPECT_EQ(frame_.picture, (PixelViewport{0, 0, 64, 32}));
    EXPECT_EQ(frame_.areas, 1u);
    EXPECT_FALSE(frame_.isUnzoomed);
    announceZoom(1, 2);
    encode_glClear(t_, kColour);
    EXPECT_EQ(drawnBox(), kLeft);
}

TEST_F(DynamicZooms, waitAfterPartialClears) {
    open();
    drawPlainFrames();
    announceZoom(.5);
    encode_glClear(t_, kColour);
    encode_glEnable(t_, GL_SCISSOR_TEST);
    encode_glScissor(t_, 0, 0, 10, 10);
    encode_glClear(t_, kColour);
    encode_glDisable(t_, GL_SCISSOR_TEST);
    EXPECT_EQ(drawnBox(), kHalf) << "with the full clear";
    announceZoom(.25, 2);
    EXPECT_EQ(shown(), kLeft);
    encode_glEnable(t_, GL_SCISSOR_TEST);
    encode_glClear(t_, kColour);
    EXPECT_EQ(shown(), kLeft);
    EXPECT_EQ(frame_.areas, 1u) << "the cleared part has its place by the old zoom";
}

TEST_F(DynamicZooms, doNotApplyToWindowsThatAreRead) {
    open();
    drawPlainFrames();
    announceZoom(.5);
    for (int i = 0; i < 3; ++i) {
        encode_glClear(t_, kColour);
        const PixelViewport box = drawnBox();
        records::requestPixels(t_, 1, 0, 0, 64, 32, GL_RGBA, GL_UNSIGNED_BYTE, 4);
        EXPECT_EQ(shown(), kLeft);
        if (i == 0) continue; // the first read is not known before
        EXPECT_EQ(box, kLeft);
        EXPECT_TRUE(frame_.isUnzoomed);
    }
}

TEST_F(DynamicZooms, doNotApplyToWindowsThatKeepTheirAreas) {
    open();
    drawPlainFrames();
    announceZoom(.5);
    encode_glClear(t_, kColour);
    EXPECT_EQ(drawnBox(), kHalf);
    encode_glDrawBuffer(t_, GL_FRONT);
    draw();
    encode_glDrawBuffer(t_, GL_BACK);
    EXPECT_EQ(shown(), kLeft);
    encode_glClear(t_, kColour);
    EXPECT_EQ(drawnBox(), kLeft);
    EXPECT_EQ(shown(), kLeft);
    EXPECT_TRUE(frame_.isUnzoomed);
}

TEST_F(DynamicZooms, areReportedToReturningNodes) {
    open();
    drawPlainFrames();
    announceZoom(.5);
    encode_glClear(t_, kColour);
    draw();
    EXPECT_EQ(shown(), kLeft);
    const auto sentAreas = replay_->memberAreas();
    replay_ = makeZooming(true);
    open();
    ASSERT_TRUE(replay_->takeMemberAreas(sentAreas));
    encode_glClear(t_, kColour);
    EXPECT_EQ(drawnBox(), kHalf);
    EXPECT_EQ(shown(), kLeft);
    EXPECT_FALSE(frame_.isUnzoomed) << "as on the member";
    EXPECT_EQ(replay_->memberAreas(), sentAreas);
}

TEST_F(DynamicTiles, restartWithoutAMember) {
    replay_ = make(true);
    open();
    announce();
    replay_->beginAreas();
    EXPECT_EQ(shown(), kRight);
}

} // namespace
} // namespace mural
