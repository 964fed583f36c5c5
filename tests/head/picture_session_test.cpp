// Pictures through the complete head: saved, shown, counted.
#include <gtest/gtest.h>

#include "tests/head/support/fake_sink.hpp"

namespace mural {
namespace {

bool swapFrame(FakeProgram& program, uint32_t frame, uint32_t window = 1, uint32_t width = 64) {
    return program.publish(kFakeSwap, {frame, window, width, 48});
}

TEST(PictureSession, savesWallPicturesOfAllNodes) {
    Shown shown;
    SessionHarness head(4);
    addSinks(head, shown);
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    for (uint32_t frame = 1; frame <= 10; ++frame) ASSERT_TRUE(swapFrame(program, frame));
    const auto report = head.finish();
    EXPECT_EQ(report["savedPictures"], 10);
    EXPECT_EQ(shown.frames["file"], (std::vector<int64_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
    EXPECT_TRUE(shown.finished);
    ASSERT_EQ(shown.lastPixels.size(), 64u * 48);
    for (uint32_t x = 0; x < 64; ++x) EXPECT_EQ(shown.lastPixels[x], 10 << 8 | x / 16);
}

TEST(PictureSession, savesOnlyRequestedFramesOfTheMainWindow) {
    Shown shown;
    SessionHarness head(2);
    addSinks(head, shown);
    head.config.saveFrames = {2, 4, 99};
    head.config.frames = 4;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    uint32_t frame = 0;
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(swapFrame(program, ++frame, 7, 20)); // a splash screen
    for (int i = 0; i < 5; ++i) {
        ASSERT_TRUE(swapFrame(program, ++frame, 8, 64));
        ASSERT_TRUE(swapFrame(program, ++frame, 7, 20));
    }
    head.waitFor("frames-reached");
    const auto report = head.finish();
    EXPECT_EQ(shown.frames["file"], (std::vector<int64_t>{2, 4})); // frames of the wall, including the splash screen's
    EXPECT_EQ(report["savedPictures"], 2);
}

TEST(PictureSession, showsTheNextLargestWindowAfterTheMainWindow) {
    Shown shown;
    SessionHarness head(3);
    addSinks(head, shown);
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    uint32_t frame = 0;
    for (int i = 0; i < 2; ++i) ASSERT_TRUE(swapFrame(program, ++frame, 7, 20));
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(swapFrame(program, ++frame, 8, 64));
    for (int i = 0; i < 2; ++i) ASSERT_TRUE(swapFrame(program, ++frame, 7, 20)); // not on the wall
    ASSERT_TRUE(program.publish(kFakeWindowGone, {8}));
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(swapFrame(program, ++frame, 7, 20));
    const auto report = head.finish();
    EXPECT_EQ(shown.frames["file"], (std::vector<int64_t>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(shown.lastPixels.size(), 20u * 48);
    EXPECT_EQ(report["frames"], 9);
}

// Nodes may be several frames late when a program ends: their pictures still belong to the last main window.
TEST(PictureSession, forgetsAProgramAfterItsLastPicture) {
    Shown shown;
    SessionHarness head(2);
    addSinks(head, shown);
    std::atomic<bool> isPaused{false};
    head.behaviours[1].isPaused = &isPaused;
    head.start();
    head.waitFor("ready");
    {
        FakeProgram program;
        ASSERT_TRUE(program.connect(head.config.session));
        ASSERT_TRUE(swapFrame(program, 1, 7, 64));
        ASSERT_TRUE(swapFrame(program, 2, 8, 64));
        ASSERT_TRUE(program.waitFramesDone(2));
        isPaused = true;
        ASSERT_TRUE(swapFrame(program, 3, 8, 64));
        program.disconnect();
    }
    while (head.waitFor("clients")["count"] != 0) {}
    isPaused = false;
    const auto report = head.finish();
    EXPECT_EQ(shown.frames["file"], (std::vector<int64_t>{1})) << "the other window's are none of the wall's";
    EXPECT_EQ(report["frames"], 1);
}

// A wait for the lost node would never end.
TEST(PictureSession, closesAWindowWithoutALostNode) {
    Shown shown;
    SessionHarness head(2);
    addSinks(head, shown);
    head.behaviours[1].dieAtFrame = 2;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    ASSERT_TRUE(swapFrame(program, 1, 8, 64));
    ASSERT_TRUE(swapFrame(program, 2, 8, 64));
    ASSERT_TRUE(program.waitFramesDone(2));
    ASSERT_TRUE(program.publish(kFakeWindowGone, {8}));
    ASSERT_TRUE(swapFrame(program, 3, 7, 20));
    ASSERT_TRUE(program.waitFramesDone(3));
    const auto report = head.finish();
    EXPECT_EQ(report["frames"], 3);
    EXPECT_EQ(shown.frames["file"].back(), 3);
}

TEST(PictureSession, savesNoFrameAfterTheLastOne) {
    Shown shown;
    SessionHarness head(2);
    addSinks(head, shown);
    head.config.frames = 3;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    for (uint32_t frame = 1; frame <= 6; ++frame) ASSERT_TRUE(swapFrame(program, frame));
    const auto report = head.finish();
    EXPECT_EQ(shown.frames["file"], (std::vector<int64_t>{1, 2, 3}));
    EXPECT_EQ(report["savedPictures"], 3);
}

TEST(PictureSession, blocksNodesAndProgramForASlowOutput) {
    Shown shown;
    SessionHarness head(2);
    addSinks(head, shown);
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    shown.block(true);
    for (uint32_t frame = 1; frame <= 12; ++frame) ASSERT_TRUE(swapFrame(program, frame));
    ASSERT_TRUE(program.waitFramesDone(1));
    // One shown, three queued and one more per reader: the rest must wait.
    EXPECT_LT(program.header()->framesDone.load(), 12u);
    shown.block(false);
    EXPECT_TRUE(program.waitFramesDone(12));
    head.finish();
    EXPECT_EQ(shown.frames["file"].size(), 12u);
}

TEST(PictureSession, countsFramesInTheProgramsWindowWhenShown) {
    Shown shown;
    SessionHarness head(2);
    addSinks(head, shown);
    head.config.out.clear();
    head.options.file.reset();
    head.config.display = Display::App;
    head.config.latency = 0;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    EXPECT_EQ(program.welcome().displayApp, 1u);
    ASSERT_TRUE(swapFrame(program, 1, 5));
    ASSERT_TRUE(program.waitFramesDone(1));
    EXPECT_EQ(shown.count("window 5"), 1u) << "done before it was shown";
    EXPECT_TRUE(program.waitFramesShown(1));
    shown.block(true);
    ASSERT_TRUE(swapFrame(program, 2, 5));
    ASSERT_TRUE(program.publish(kFakeSum, {77}));
    FakeProgram::Answer answer; // the nodes have passed the frame then
    ASSERT_TRUE(program.readAnswer(answer));
    EXPECT_EQ(program.header()->framesDone.load(), 1u);
    shown.block(false);
    EXPECT_TRUE(program.waitFramesDone(2));
    // A frame of a window without a native window is not shown, and does not block the program.
    ASSERT_TRUE(swapFrame(program, 3, 0));
    EXPECT_TRUE(program.waitFramesDone(3));
    EXPECT_TRUE(program.waitFramesShown(3));
    head.finish();
    EXPECT_EQ(shown.frames["window 5"].size(), 2u);
}

TEST(PictureSession, letsTheProgramRunAheadWithLatency) {
    Shown shown;
    SessionHarness head(1);
    addSinks(head, shown);
    head.config.display = Display::App;
    head.config.latency = 1;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    shown.block(true);
    ASSERT_TRUE(swapFrame(program, 1, 5));
    EXPECT_TRUE(program.waitFramesDone(1));
    EXPECT_EQ(program.header()->framesShown.load(), 0u);
    shown.block(false);
    EXPECT_TRUE(program.waitFramesShown(1));
    head.finish();
}

TEST(PictureSession, reportsAFailingFileInOneLineAndContinues) {
    Shown shown;
    shown.failing = true;
    SessionHarness head(1);
    addSinks(head, shown);
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    for (uint32_t frame = 1; frame <= 8; ++frame) ASSERT_TRUE(swapFrame(program, frame));
    EXPECT_TRUE(program.waitFramesDone(8));
    const auto report = head.finish();
    EXPECT_EQ(report["savedPictures"], 0);
    int complaints = 0;
    for (const auto& event : head.seen) complaints += event["event"] == "say";
    EXPECT_EQ(complaints, 1);
}

} // namespace
} // namespace mural
