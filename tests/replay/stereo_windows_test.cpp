// Programs that draw two eyes themselves: a node shows the program's picture of its eye, with this machine's GL.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <vector>

#include "encoders.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/replies.hpp"
#include "tests/interposer/encoder_harness.hpp"
#include "tests/recorded_log.hpp"

namespace mural {
namespace {

using Pixel = std::array<uint8_t, 3>; // red, green, blue

class StereoWindows : public ::testing::Test {
protected:
    static constexpr int kWidth = 8, kHeight = 4;

    void start(Eye eye, bool stereo = true) {
        auto platform = gl::openPlatform("egl");
        ASSERT_TRUE(platform) << platform.error().message;
        PlayerConfig config;
        config.answers = true;
        config.pass.eye = eye;
        config.eyeBase = 2;
        config.focusDistance = 4;
        PlayerOutputs out;
        out.answer = [this](const wire::ReplyPartHeader&, std::span<const std::byte> bytes) {
            answered_.assign(bytes.begin(), bytes.end());
        };
        out.frameDone = [this](const PlayerOutputs::Frame& f) {
            const std::byte* const pixels = f.pixels ? f.pixels(f.region) : nullptr;
            shown_.clear();
            for (int64_t i = 0; pixels && i < f.region.area(); ++i)
                shown_.push_back({static_cast<uint8_t>(pixels[i * 4 + 2]), static_cast<uint8_t>(pixels[i * 4 + 1]),
                                  static_cast<uint8_t>(pixels[i * 4])});
        };
        replay_ = std::make_unique<Replay>(std::move(*platform), config, out);
        wire::WindowConfig c{};
        c.width = kWidth;
        c.height = kHeight;
        c.red = c.green = c.blue = c.alpha = 8;
        c.depth = 24;
        c.doubleBuffer = 1;
        c.stereo = stereo ? 1 : 0;
        records::window(t_, 1, c);
        records::createContext(t_, {1, 0, 0, 2, 1, 0, 0, c});
        records::makeCurrent(t_, 1, 1, 1);
    }
    void clear(GLenum buffer, float red, float green, float blue) {
        encode_glDrawBuffer(t_, buffer);
        encode_glClearColor(t_, red, green, blue, 1);
        encode_glClear(t_, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    }
    // The uniform colour of the next picture.
    Pixel shown() {
        records::swap(t_, 1, ++frame_);
        send();
        EXPECT_EQ(shown_.size(), size_t{kWidth} * kHeight);
        for (const Pixel& p : shown_) EXPECT_EQ(p, shown_.front());
        return shown_.empty() ? Pixel{1, 2, 3} : shown_.front();
    }
    void send() {
        for (const auto& packet : encoder_.takePackets()) EXPECT_TRUE(replay_->packet(wire::streamOf(1, 1), packet));
    }
    // A quad two units in front of the eye, from x = 0 to the right, with a field of view of 90 degrees.
    void drawRightHalf() {
        encode_glMatrixMode(t_, GL_PROJECTION);
        encode_glLoadIdentity(t_);
        encode_glFrustum(t_, -1, 1, -1, 1, 1, 10);
        encode_glMatrixMode(t_, GL_MODELVIEW);
        encode_glLoadIdentity(t_);
        encode_glColor3f(t_, 1, 1, 1);
        encode_glBegin(t_, GL_QUADS);
        encode_glVertex3f(t_, 0, -9, -2);
        encode_glVertex3f(t_, 9, -9, -2);
        encode_glVertex3f(t_, 9, 9, -2);
        encode_glVertex3f(t_, 0, 9, -2);
        encode_glEnd(t_);
    }
    int whitePixels() {
        records::swap(t_, 1, ++frame_);
        send();
        return static_cast<int>(std::ranges::count(shown_, Pixel{255, 255, 255}));
    }

    testing::EncoderHarness encoder_;
    ThreadState& t_ = encoder_.thread();
    std::unique_ptr<Replay> replay_;
    std::vector<Pixel> shown_;
    std::vector<std::byte> answered_;
    RecordedLog log_;
    uint32_t frame_ = 0;
};

constexpr Pixel kRed{255, 0, 0}, kBlue{0, 0, 255}, kGreen{0, 255, 0};

TEST_F(StereoWindows, haveABufferPerEye) {
    for (const Eye eye : {Eye::Left, Eye::Right, Eye::Cyclop}) {
        start(eye);
        for (int frame = 0; frame < 3; ++frame) {
            clear(GL_BACK_LEFT, 1, 0, 0);
            clear(GL_BACK_RIGHT, 0, 0, 1);
            EXPECT_EQ(shown(), eye == Eye::Right ? kBlue : kRed);
            clear(GL_BACK_RIGHT, 0, 0, 1); // in the other order
            clear(GL_BACK_LEFT, 1, 0, 0);
            EXPECT_EQ(shown(), eye == Eye::Right ? kBlue : kRed);
        }
        replay_.reset();
    }
}

TEST_F(StereoWindows, showDrawsToBothEyes) {
    for (const Eye eye : {Eye::Left, Eye::Right}) {
        start(eye);
        clear(GL_BACK_LEFT, 1, 0, 0);
        clear(GL_BACK_RIGHT, 0, 0, 1);
        clear(GL_BACK, 0, 1, 0);
        EXPECT_EQ(shown(), kGreen);
        const std::array<GLenum, 2> both{GL_BACK_LEFT, GL_BACK_RIGHT};
        clear(GL_BACK, 0, 0, 0);
        encode_glDrawBuffers(t_, 2, DataArg::of(both.data(), sizeof both));
        encode_glClearColor(t_, 0, 1, 0, 1);
        encode_glClear(t_, GL_COLOR_BUFFER_BIT);
        EXPECT_EQ(shown(), kGreen);
        replay_.reset();
    }
}

// The other eye's buffer is not here: reads return this eye's pixels without an error, as natively.
TEST_F(StereoWindows, answerReads) {
    start(Eye::Left);
    clear(GL_BACK_LEFT, 1, 0, 0);
    clear(GL_BACK_RIGHT, 0, 0, 1);
    for (const GLenum buffer : {GL_BACK_LEFT, GL_BACK_RIGHT}) {
        encode_glReadBuffer(t_, buffer);
        answered_.clear();
        records::requestPixels(t_, 1, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, 4);
        send();
        EXPECT_EQ(answered_, (std::vector<std::byte>{std::byte{255}, std::byte{0}, std::byte{0}, std::byte{255}}))
            << buffer;
    }
}

// A stereo program's own eye offset is not applied twice; a mono window is transformed.
TEST_F(StereoWindows, keepTheProgramsOwnView) {
    std::map<bool, int> white;
    for (const bool stereo : {true, false}) {
        start(Eye::Left, stereo);
        clear(GL_BACK, 0, 0, 0);
        drawRightHalf();
        white[stereo] = whitePixels();
        replay_.reset();
    }
    EXPECT_EQ(white[true], kWidth * kHeight / 2);
    EXPECT_NE(white[false], white[true]);
}

TEST_F(StereoWindows, reportTheShownEyeInMonoSessions) {
    start(Eye::Cyclop);
    send();
    EXPECT_NE(log_.text().find("--stereo"), std::string::npos) << log_.text();
}

} // namespace
} // namespace mural
