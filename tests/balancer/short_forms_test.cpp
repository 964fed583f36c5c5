// Every short form is a configuration that can be parsed again, has no problem, and shows every pixel once.
#include <gtest/gtest.h>

#include "balancer/compound/even_split.hpp"
#include "balancer/compound/load_config.hpp"
#include "balancer/compound/plan_frame.hpp"
#include "balancer/config/presets.hpp"
#include "balancer/config/eqc/parser.hpp"
#include "balancer/config/eqc/writer.hpp"
#include "tests/balancer/symbolic_wall.hpp"

namespace mural::compound {

namespace {

using config::Preset;
using config::StereoPreset;

LoadedConfig loaded(const Preset& form) {
    const auto file = config::shortForm(form);
    EXPECT_TRUE(file.ok()) << file.error().message;
    return loadConfig(file.value(), "short", [](const std::string&) { return std::nullopt; });
}

void expectWhole(Preset form) {
    form.width = 37; // does not divide
    form.height = 23;
    const LoadedConfig one = loaded(form);
    for (const auto& d : one.diagnostics.all()) ADD_FAILURE() << one.diagnostics.text(d);
    const std::string text = config::writeConfig(one.file);
    config::Diagnostics diagnostics("short");
    EXPECT_TRUE(config::parseConfig(text, diagnostics) == one.file) << text;
    EXPECT_TRUE(diagnostics.all().empty());
    FrameInput input = firstFrame(one.resolved);
    for (input.frameNumber = 0; input.frameNumber < 4; ++input.frameNumber) {
        const FramePlan plan = planFrame(one.resolved, input);
        EXPECT_FALSE(plan.channels.empty());
        EXPECT_EQ(testing::SymbolicWall(one.resolved, input, plan).run(), "") << text;
    }
}

} // namespace

TEST(ShortForms, workSeparately) {
    for (const auto member :
         {&Preset::columns, &Preset::rows, &Preset::ranges, &Preset::pixelColumns, &Preset::samples, &Preset::frames}) {
        for (const int n : {1, 2, 3, 7}) {
            Preset form;
            form.*member = n;
            expectWhole(form);
        }
    }
    for (const auto stereo :
         {StereoPreset::Anaglyph, StereoPreset::Quad, StereoPreset::Passive, StereoPreset::SideBySide}) {
        Preset form;
        form.stereo = stereo;
        expectWhole(form);
    }
}

TEST(ShortForms, supportZoom) {
    Preset form;
    form.columns = form.ranges = 2;
    form.zoom = {0.5, 2};
    for (const auto& c : loaded(form).resolved.compounds)
        EXPECT_EQ(c.zoom, c.parent == config::kNone ? form.zoom : Zoom{}) << "what is in it inherits that";
}

TEST(ShortForms, workInCombination) {
    for (const auto stereo : {StereoPreset::None, StereoPreset::Anaglyph, StereoPreset::Passive}) {
        Preset form;
        form.columns = form.ranges = form.pixelColumns = form.samples = form.frames = 2;
        form.nodes = {"a", "b", "c"};
        form.stereo = stereo;
        expectWhole(form);
    }
}

TEST(ShortForms, supportTimeMultiplexedNodes) {
    Preset form;
    form.columns = form.rows = 2;
    form.nodes = {"a", "b"};
    const LoadedConfig one = loaded(form);
    ASSERT_EQ(one.resolved.nodes.size(), 3u); // the application's node, which does not draw
    EXPECT_EQ(one.resolved.nodes[1].host, "a");
    EXPECT_EQ(one.resolved.nodes[1].pipes.size(), 2u);
    EXPECT_EQ(one.resolved.segments[1].viewport, (Viewport{.5, 0, .5, .5}));
    EXPECT_EQ(one.resolved.windows.size(), 4u);
}

TEST(ShortForms, createTileQueues) {
    Preset form;
    form.tileWidth = form.tileHeight = 8;
    form.takers = 3;
    expectWhole(form);
    form.samples = 2;
    form.stereo = StereoPreset::Anaglyph;
    expectWhole(form);
    form.takers = 1; // a single node shares nothing
    for (const auto& c : loaded(form).resolved.compounds) EXPECT_TRUE(c.outputQueues.empty());
}

TEST(ShortForms, inheritTheCompositionInRanges) {
    Preset form;
    form.ranges = 3;
    form.composition = "2-3-swap";
    const LoadedConfig three = loaded(form);
    for (const auto& c : three.resolved.compounds) EXPECT_EQ(c.composition, "2-3-swap");
    form.ranges = 1; // nothing is composited
    for (const auto& c : loaded(form).resolved.compounds) EXPECT_EQ(c.composition, "");
}

TEST(ShortForms, areRejectedWhenInvalid) {
    Preset form;
    form.ranges = 0;
    EXPECT_EQ(config::shortForm(form).error().message, "--db cannot be 0; use 1 or more");
    form.ranges = 4097;
    EXPECT_FALSE(config::shortForm(form).ok());
    form = {};
    form.columns = 3000;
    EXPECT_EQ(config::shortForm(form).error().message,
              "a picture of 1920x1080 pixels cannot be divided this way; choose another size");
    form = {};
    form.nodes = {"a\"b"};
    EXPECT_FALSE(config::shortForm(form).ok());
}

} // namespace mural::compound
