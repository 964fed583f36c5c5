// Selection of the sinks for a frame's pictures, and the number of eyes.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "nodes/head/frames/picture_output.hpp"
#include "tests/recorded_log.hpp"

namespace mural {
namespace {

constexpr int kWidth = 6, kHeight = 4;
constexpr std::byte kLeft{200}, kRight{100};

struct Shown {
    int width = 0, height = 0;
    std::byte left{}, right{}; // value of the first pixel; right 0: one picture arrived
};

class RecordingSink final : public PictureSink {
public:
    explicit RecordingSink(std::vector<Shown>& shown, Result<void> finishes = {})
        : shown_(shown), finishes_(std::move(finishes)) {}
    Result<void> show(int64_t, const Picture& p) override {
        shown_.push_back({p.width, p.height, p.row(0)[0], std::byte{0}});
        return {};
    }
    Result<void> showPair(int64_t, const EyePair& eyes) override {
        shown_.push_back({eyes.left.width, eyes.left.height, eyes.left.row(0)[0], eyes.right.row(0)[0]});
        return {};
    }
    Result<void> finish() override { return finishes_; }
    [[nodiscard]] std::string describe() const override { return "a test"; }

private:
    std::vector<Shown>& shown_;
    Result<void> finishes_;
};

std::shared_ptr<OwnedPicture> filled(std::byte value) {
    auto picture = std::make_shared<OwnedPicture>();
    picture->resize(kWidth, kHeight);
    std::fill_n(picture->row(0), picture->view().sizeBytes(), value);
    return picture;
}
std::shared_ptr<OwnedPicture> pairOfEyes() {
    const auto left = filled(kLeft), right = filled(kRight);
    auto both = std::make_shared<OwnedPicture>();
    stackEyes({left->view(), right->view()}, *both);
    return both;
}

// The first canvas and a second one, each for one or two eyes.
TEST(PictureOutput, givesEachCanvasItsEyes) {
    for (const bool firstIsPair : {false, true})
        for (const bool otherIsPair : {false, true}) {
            std::vector<Shown> file, wall, otherFile, otherWall;
            const auto wallInto = [](std::vector<Shown>& into) {
                return [&into] { return Result<std::unique_ptr<PictureSink>>(std::make_unique<RecordingSink>(into)); };
            };
            PictureOutputConfig config;
            config.pairs = firstIsPair;
            config.openWall = wallInto(wall);
            OtherCanvas& canvas = config.canvases.emplace_back();
            canvas.name = "monitor";
            canvas.pairs = otherIsPair;
            canvas.file = std::make_shared<RecordingSink>(otherFile);
            canvas.openWall = wallInto(otherWall);
            config.done = [](uint32_t, uint32_t) {};
            const RecordedLog log;
            PictureOutput output(std::move(config), std::make_unique<RecordingSink>(file));
            output.add(
                {1, 1, 1, 0, firstIsPair ? pairOfEyes() : filled(kLeft), {otherIsPair ? pairOfEyes() : filled(kLeft)}});
            ASSERT_TRUE(output.finish(Deadline::inMs(10'000)));
            const auto expectOne = [](const std::vector<Shown>& shown, bool pair, const char* where) {
                ASSERT_EQ(shown.size(), 1u) << where;
                EXPECT_EQ(shown[0].width, kWidth) << where;
                EXPECT_EQ(shown[0].height, kHeight) << where;
                EXPECT_EQ(shown[0].left, kLeft) << where;
                EXPECT_EQ(shown[0].right, pair ? kRight : std::byte{0}) << where;
            };
            expectOne(file, firstIsPair, "file");
            expectOne(wall, firstIsPair, "wall");
            expectOne(otherFile, otherIsPair, "file of the other canvas");
            expectOne(otherWall, otherIsPair, "wall of the other canvas");
            EXPECT_EQ(log.text(), "");
        }
}

// Files have 8 bits, which one line reports; the program's window receives all bits.
TEST(PictureOutput, reducesDeepPicturesForSinksWithoutDepth) {
    struct DeepSink final : PictureSink {
        explicit DeepSink(std::vector<PictureFormat>& formats) : formats_(formats) {}
        Result<void> show(int64_t, const Picture& p) override {
            formats_.push_back(p.format);
            return {};
        }
        Result<void> finish() override { return {}; }
        [[nodiscard]] bool takesDeepPictures() const override { return true; }
        [[nodiscard]] std::string describe() const override { return "a test"; }
        std::vector<PictureFormat>& formats_;
    };
    std::vector<Shown> file;
    std::vector<PictureFormat> window;
    const RecordedLog log;
    PictureOutputConfig config;
    config.toNativeWindows = true;
    config.openWindow = [&](const WindowPicture&) {
        return Result<std::unique_ptr<PictureSink>>(std::make_unique<DeepSink>(window));
    };
    config.done = [](uint32_t, uint32_t) {};
    PictureOutput output(std::move(config), std::make_unique<RecordingSink>(file));
    auto deep = std::make_shared<OwnedPicture>();
    deep->resize(kWidth, kHeight, PictureFormat::Bgr10A2);
    const uint32_t word = 805; // blue of 1023: 200.7 of 255
    for (int i = 0; i < kWidth * kHeight; ++i) std::memcpy(deep->data() + 4 * i, &word, 4);
    for (uint32_t frame = 1; frame <= 2; ++frame) output.add({1, 1, frame, 7, deep, {}});
    ASSERT_TRUE(output.finish(Deadline::inMs(10'000)));
    ASSERT_EQ(file.size(), 2u);
    EXPECT_EQ(file[0].left, std::byte{201});
    EXPECT_EQ(window, (std::vector{PictureFormat::Bgr10A2, PictureFormat::Bgr10A2}));
    EXPECT_EQ(log.text(), "the program's window has 10 bits per channel; --out saves 8 of them\n");
}

TEST(PictureOutput, savesOnlyACompleteVideo) {
    for (const bool complete : {true, false}) {
        std::vector<Shown> file;
        const RecordedLog log;
        PictureOutputConfig config;
        config.done = [](uint32_t, uint32_t) {};
        PictureOutput output(std::move(config), std::make_unique<RecordingSink>(
                                                    file, complete ? Result<void>() : Error{"the disk is full"}));
        for (uint32_t frame = 1; frame <= 3; ++frame) output.add({1, 1, frame, 0, filled(kLeft), {}});
        ASSERT_TRUE(output.finish(Deadline::inMs(10'000)));
        EXPECT_EQ(file.size(), 3u);
        EXPECT_EQ(output.totals().savedPictures, complete ? 3 : 0);
        EXPECT_EQ(log.text(), complete ? "" : "the disk is full\n");
    }
}

} // namespace
} // namespace mural
