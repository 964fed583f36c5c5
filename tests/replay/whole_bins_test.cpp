// The drawing area of a node that ends its region on the driver's bins, with a GL that records scissor boxes.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "encoders.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/replies.hpp"
#include "tests/fuzz/fake_gl.hpp"
#include "tests/interposer/encoder_harness.hpp"

namespace mural {
namespace {

constexpr PixelViewport kWindow{0, 0, 250, 190}, kRegion{83, 95, 83, 95}; // the middle tile of the upper row of 3x2
constexpr PixelViewport kBins{64, 62, 128, 128};

class WholeBins : public ::testing::Test {
protected:
    void open(bool rastersInBins, const wire::WindowConfig& buffers) {
        PlayerConfig config;
        config.grid = {3, 2};
        config.region = {1, 1, 1, 1};
        config.rastersInBins = rastersInBins;
        PlayerOutputs out;
        out.frameDone = [this](const PlayerOutputs::Frame& f) { shown_ = f.region; };
        out.answer = [](const wire::ReplyPartHeader&, std::span<const std::byte>) {};
        fuzz::FakeGlOptions options;
        options.drew = [this](bool scissored, const std::array<int, 4>& box) {
            drawn_ = scissored ? PixelViewport{box[0], box[1], box[2], box[3]} : kWindow;
        };
        replay_ = std::make_unique<Replay>(fuzz::makeFakePlatform(options), config, out);
        wire::WindowConfig c = buffers;
        c.width = static_cast<uint32_t>(kWindow.w);
        c.height = static_cast<uint32_t>(kWindow.h);
        c.doubleBuffer = 1;
        records::window(t_, 1, c);
        records::createContext(t_, {1, 0, 0, 4, 5, 0, 0, c});
        records::makeCurrent(t_, 1, 1, 1);
    }
    PixelViewport draw() {
        encode_glRectf(t_, -1, -1, 1, 1);
        send();
        return drawn_;
    }
    PixelViewport swap() {
        records::swap(t_, 1, 1);
        send();
        return shown_;
    }
    void send() {
        for (const auto& packet : encoder_.takePackets()) ASSERT_TRUE(replay_->packet(wire::streamOf(1, 1), packet));
    }

    testing::EncoderHarness encoder_;
    ThreadState& t_ = encoder_.thread();
    std::unique_ptr<Replay> replay_;
    PixelViewport drawn_, shown_;
};

wire::WindowConfig buffers(uint8_t depth, uint8_t stencil, uint8_t samples) {
    wire::WindowConfig c{};
    c.depth = depth;
    c.stencil = stencil;
    c.samples = samples;
    return c;
}

TEST_F(WholeBins, areDrawnInWindowsWithoutDepthAndStencil) {
    open(true, buffers(0, 0, 0));
    EXPECT_EQ(draw(), kBins);
    EXPECT_EQ(swap(), kRegion); // the shown part is still the region
}

TEST_F(WholeBins, areNotDrawnInWindowsWithDepthOrStencil) {
    open(true, buffers(24, 0, 0));
    EXPECT_EQ(draw(), kRegion);
    open(true, buffers(0, 8, 0));
    EXPECT_EQ(draw(), kRegion);
}

TEST_F(WholeBins, areNotDrawnByGpus) {
    open(false, buffers(0, 0, 0));
    EXPECT_EQ(draw(), kRegion);
}

TEST_F(WholeBins, areDrawnInWindowsWithSamplesByAllDrivers) {
    open(false, buffers(24, 8, 4));
    EXPECT_EQ(draw(), kBins);
}

// Regions overlap, so a sum over nodes would count samples twice.
TEST_F(WholeBins, areTheWholeWindowWhileSamplesAreCounted) {
    open(true, buffers(0, 0, 0));
    encode_glBeginQuery(t_, GL_SAMPLES_PASSED, 1);
    EXPECT_EQ(draw(), kWindow);
    encode_glEndQuery(t_, GL_SAMPLES_PASSED);
    EXPECT_EQ(draw(), kBins);
}

} // namespace
} // namespace mural
