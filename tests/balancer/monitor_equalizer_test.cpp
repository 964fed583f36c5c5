// monitor_equalizer: places of a wall's pictures on the channel of a monitor.
#include <gtest/gtest.h>

#include "balancer/compound/even_split.hpp"
#include "balancer/compound/plan_frame.hpp"
#include "balancer/equalizers/make_equalizers.hpp"
#include "balancer/equalizers/monitor_equalizer.hpp"
#include "tests/balancer/text_config.hpp"

namespace mural::balance {
namespace {

// A wall of 640x480 and 320x480 pixels, and a monitor.
compound::LoadedConfig wallWithMonitor() {
    return testing::configOf(R"(
        appNode { pipe {
            window { viewport [ 0 0 640 480 ] channel { name "left" } }
            window { viewport [ 0 0 320 480 ] channel { name "right" } }
            window { viewport [ 0 0 480 120 ] channel { name "monitor" } } } }
        layout { view { } }
        canvas { layout 0 wall { }
            segment { channel "left" viewport [ 0 0 .75 1 ] } segment { channel "right" viewport [ .75 0 .25 1 ] } }
        canvas { name "monitor" layout 0 wall { } segment { channel "monitor" } }
        compound {
            compound { channel ( canvas 0 segment 0 view 0 ) outputframe { name "l" } }
            compound { channel ( canvas 0 segment 1 view 0 ) outputframe { name "r" } }
            compound { channel ( canvas "monitor" segment 0 view 0 ) monitor_equalizer { }
                inputframe { name "r" } inputframe { name "l" } } })");
}

class MonitorEqualizerTest : public ::testing::Test {
protected:
    MonitorEqualizerTest() : loaded(wallWithMonitor()), input(compound::firstFrame(loaded.resolved)) {
        for (size_t i = 0; i < loaded.resolved.compounds.size(); ++i)
            if (loaded.resolved.compounds[i].inputFrames.size() == 2) monitor = static_cast<Index>(i);
        equalizer = std::make_unique<MonitorEqualizer>("monitor", loaded.resolved, monitor);
    }
    const auto& places() {
        equalizer->update({loaded.resolved, input}, input.compounds);
        return input.compounds[at(monitor)].inputs;
    }
    void resize(const std::string& channel, int32_t width, int32_t height) {
        for (size_t i = 0; i < loaded.resolved.channels.size(); ++i)
            if (loaded.resolved.channels[i].name == channel) input.sizes.channels[i] = {0, 0, width, height};
    }

    compound::LoadedConfig loaded;
    compound::FrameInput input;
    Index monitor = kNone;
    std::unique_ptr<MonitorEqualizer> equalizer;
};

TEST_F(MonitorEqualizerTest, isMadeForTheCompoundOfTheFile) {
    const auto all = makeEqualizers(loaded.resolved);
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0]->compound(), monitor);
    EXPECT_EQ(all[0]->effect(), Effect::Inputs);
}

TEST_F(MonitorEqualizerTest, placesEachPictureAtItsPartOfTheView) {
    const auto& inputs = places();
    ASSERT_EQ(inputs.size(), 2u) << "in the order of the input frames";
    ASSERT_TRUE(inputs[0] && inputs[1]);
    EXPECT_EQ(inputs[0]->x, 360);
    EXPECT_EQ(inputs[0]->y, 0);
    EXPECT_EQ(inputs[0]->zoom, (Zoom{120. / 320, 120. / 480}));
    EXPECT_EQ(inputs[1]->x, 0);
    EXPECT_EQ(inputs[1]->zoom, (Zoom{360. / 640, 120. / 480}));
    EXPECT_TRUE(equalizer->lastDecision().moved);
}

TEST_F(MonitorEqualizerTest, placesThePicturesOfThePlan) {
    places();
    const compound::FramePlan plan = planFrame(loaded.resolved, input);
    std::vector<std::pair<int32_t, Zoom>> uses;
    for (const auto& channel : plan.channels)
        for (const auto& task : channel.tasks)
            for (const auto& use : task.inputs) {
                EXPECT_EQ(use.y, 0);
                uses.emplace_back(use.x, use.zoom);
            }
    EXPECT_EQ(uses,
              (std::vector<std::pair<int32_t, Zoom>>{{360, {120. / 320, 120. / 480}}, {0, {360. / 640, 120. / 480}}}));
}

TEST_F(MonitorEqualizerTest, movesOnlyWhenSizesChange) {
    places();
    places();
    EXPECT_FALSE(equalizer->lastDecision().moved);
    resize("monitor", 960, 240);
    EXPECT_EQ(places()[0]->x, 720);
    EXPECT_EQ(places()[0]->zoom, (Zoom{240. / 320, 240. / 480}));
    resize("right", 160, 480);
    EXPECT_EQ(places()[0]->zoom, (Zoom{240. / 160, 240. / 480}));
    EXPECT_TRUE(equalizer->lastDecision().moved);
}

TEST_F(MonitorEqualizerTest, showsNothingOfEmptyChannels) {
    resize("right", 0, 0);
    EXPECT_FALSE(places()[0]);
    EXPECT_TRUE(places()[1]);
    resize("monitor", 0, 0);
    EXPECT_FALSE(places()[1]);
}

TEST_F(MonitorEqualizerTest, keepsPlacesWhileFrozen) {
    places();
    equalizer->freeze(true, input.compounds);
    resize("monitor", 960, 240);
    EXPECT_EQ(places()[0]->x, 360);
    equalizer->freeze(false, input.compounds);
    EXPECT_EQ(places()[0]->x, 720);
}

} // namespace
} // namespace mural::balance
