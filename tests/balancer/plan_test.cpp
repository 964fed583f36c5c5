// Contexts, frusta and links of small configurations in numbers, and messages for impossible ones.
#include <gtest/gtest.h>

#include "balancer/compound/check_config.hpp"
#include "balancer/compound/even_split.hpp"
#include "balancer/compound/plan_frame.hpp"
#include "balancer/config/resolve.hpp"
#include "balancer/config/eqc/parser.hpp"

namespace mural::compound {

namespace {

const std::string kHead = "#Equalizer 1.2 ascii\nconfig { appNode { pipe { window { viewport [ 0 0 400 200 ] channel { "
                          "name \"d\" } } window { viewport [ 0 0 400 200 ] channel { name \"s\" } } }"
                          " pipe { window { viewport [ 0 0 400 200 ] channel { name \"t\" } } } } ";
const std::string kWall = "observer { eye_base .05 } layout { view { observer 0 mode STEREO } } canvas { layout 0 wall "
                          "{ } segment { channel \"d\" } } ";

ResolvedConfig resolved(const std::string& text) {
    config::Diagnostics diagnostics("f");
    ResolvedConfig c = config::resolve(config::parseConfig(kHead + text + " }", diagnostics), {}, diagnostics);
    EXPECT_EQ(diagnostics.errors(), 0) << diagnostics.firstError();
    return c;
}

FramePlan plan(const ResolvedConfig& c, config::ViewMode mode = config::ViewMode::Mono, uint64_t number = 0) {
    FrameInput input = firstFrame(c);
    input.frameNumber = number;
    input.views.assign(c.views.size(), ViewState{mode, 1, {}});
    return planFrame(c, input);
}

const RenderContext& drawn(const FramePlan& p, const ResolvedConfig& c, const std::string& channel,
                           Eye eye = Eye::Cyclop) {
    for (const ChannelPlan& one : p.channels) {
        for (const PlannedTask& t : one.tasks) {
            const RenderContext& context = p.contexts[static_cast<size_t>(t.context)];
            if (t.kind == Task::Draw && context.eye == eye &&
                c.channels[static_cast<size_t>(one.channel)].name == channel)
                return context;
        }
    }
    static const RenderContext none;
    ADD_FAILURE() << channel << " draws nothing";
    return none;
}

void expectFrustum(const Frustum& f, double left, double right, double bottom, double top) {
    EXPECT_NEAR(f.left, left, 1e-9);
    EXPECT_NEAR(f.right, right, 1e-9);
    EXPECT_NEAR(f.bottom, bottom, 1e-9);
    EXPECT_NEAR(f.top, top, 1e-9);
}

std::vector<std::string> faults(const std::string& text) {
    config::Diagnostics diagnostics("f");
    const ResolvedConfig c = config::resolve(config::parseConfig(kHead + text + " }", diagnostics), {}, diagnostics);
    checkConfig(c, diagnostics);
    std::vector<std::string> lines;
    for (const auto& d : diagnostics.all())
        lines.push_back((d.severity == config::Severity::Error ? "error: " : "") + d.what);
    return lines;
}

} // namespace

TEST(Plan, computesFrustaOfTheDefaultWall) {
    const ResolvedConfig c = resolved(kWall);
    expectFrustum(drawn(plan(c), c, "d").perspective, -.08, .08, -.05, .05);
    const FramePlan stereo = plan(c, config::ViewMode::Stereo);
    expectFrustum(drawn(stereo, c, "d", Eye::Right).perspective, -.0825, .0775, -.05, .05);
    expectFrustum(drawn(stereo, c, "d", Eye::Left).perspective, -.0775, .0825, -.05, .05);
    expectFrustum(drawn(stereo, c, "d", Eye::Left).orthographic, -.8, .8, -.5, .5);
    // The eye is .025 to the right: the centre of the wall is .025 to its left.
    EXPECT_NEAR(transformPoint(drawn(stereo, c, "d", Eye::Right).perspectiveHead, {0, 0, -1}).x, -.025, 1e-12);
    EXPECT_NEAR(transformPoint(drawn(stereo, c, "d", Eye::Right).perspectiveHead, {0, 0, -1}).z, -1, 1e-12);
    // Orthographic eyes agree on the wall, and differ in front of it.
    const auto& ortho = drawn(stereo, c, "d", Eye::Right).orthographicHead;
    EXPECT_NEAR(transformPoint(ortho, {.3, 0, -1}).x - .3, .025, 1e-9);
}

TEST(Plan, setsAnaglyphMasksAndQuadBuffers) {
    ResolvedConfig c = resolved(kWall);
    EXPECT_EQ(drawn(plan(c, config::ViewMode::Stereo), c, "d", Eye::Left).colorMask,
              config::ColorMask{config::ColorComponent::Red});
    c.windows[0].attributes.hintStereo = config::value::kOn;
    const FramePlan quad = plan(c, config::ViewMode::Stereo);
    EXPECT_EQ(drawn(quad, c, "d", Eye::Left).drawBuffer, DrawBuffer::BackLeft);
    EXPECT_EQ(drawn(quad, c, "d", Eye::Right).drawBuffer, DrawBuffer::BackRight);
    c.segments[0].eyes = EyeSet{Eye::Left};
    const FramePlan passive = plan(c, config::ViewMode::Stereo);
    EXPECT_EQ(drawn(passive, c, "d", Eye::Left).stereoMode, StereoMode::Passive);
    EXPECT_EQ(passive.contexts.size(), 1u);
}

TEST(Plan, appliesHeadsAndModelUnits) {
    const ResolvedConfig c =
        resolved("observer { } layout { view { observer 0 } } canvas { layout 0 wall { } segment { channel \"d\" } }");
    FrameInput input = firstFrame(c);
    input.observers = {{Matrix4::translation({.1, .2, 1})}};
    const FramePlan one = planFrame(c, input);
    expectFrustum(drawn(one, c, "d").perspective, -.9 * .05, .7 * .05, -.7 * .05, .3 * .05);
    input.views = {ViewState{{}, 1000, {}}}; // millimetres
    input.nearPlane = 100;
    const FramePlan millimetres = planFrame(c, input);
    expectFrustum(drawn(millimetres, c, "d").perspective, -45, 35, -35, 15);
    // Behind the wall the picture is mirrored; in its plane a frustum still exists.
    input = firstFrame(c);
    input.observers = {{Matrix4::translation({0, 0, -2})}};
    EXPECT_TRUE(drawn(planFrame(c, input), c, "d").behindScreen);
    input.observers = {{Matrix4::translation({0, 0, -1})}};
    EXPECT_TRUE(std::isfinite(drawn(planFrame(c, input), c, "d").perspective.left));
}

TEST(Plan, movesTheWallToTheFocusDistance) {
    const ResolvedConfig c =
        resolved("observer { eye_base .1 focus_distance 4 focus_mode relative_to_observer } layout { view { observer 0 "
                 "mode STEREO } } canvas { layout 0 wall { } segment { channel \"d\" } }");
    // As if the wall were 4 m away and four times as large: a quarter of the eye's offset remains.
    expectFrustum(drawn(plan(c, config::ViewMode::Stereo), c, "d", Eye::Right).perspective, -.08 - .00125, .08 - .00125,
                  -.05, .05);
}

TEST(Plan, movesHmdWallsWithTheHead) {
    const ResolvedConfig c = resolved(
        "observer { } layout { view { observer 0 wall { type HMD } } } canvas { layout 0 segment { channel \"d\" } }");
    FrameInput input = firstFrame(c);
    input.observers = {{Matrix4::translation({5, 6, 7})}};
    const FramePlan p = planFrame(c, input);
    expectFrustum(drawn(p, c, "d").perspective, -.08, .08, -.05, .05);
    EXPECT_NEAR(transformPoint(drawn(p, c, "d").perspectiveHead, {5, 6, 7}).x, 0, 1e-12);
}

TEST(Plan, computesAreasInPixels) {
    const ResolvedConfig c =
        resolved(kWall + "compound { channel ( ) compound { viewport [ 0 0 .333 1 ] } compound { channel \"s\" "
                         "viewport [ .333 0 .667 1 ] outputframe { } } inputframe { name \"frame.s\" } }");
    const FramePlan p = plan(c);
    const RenderContext& s = drawn(p, c, "s");
    EXPECT_EQ(s.area, (PixelViewport{133, 0, 267, 200}));
    EXPECT_EQ(s.viewport, (PixelViewport{0, 0, 267, 200}));
    EXPECT_EQ(s.part, (Viewport{133 / 400., 0, 267 / 400., 1}));
    expectFrustum(s.perspective, -.08 + .16 * 133 / 400, .08, -.05, .05);
    ASSERT_EQ(p.frames.size(), 1u);
    const PlannedTask& assemble = p.channels.back().tasks.back();
    ASSERT_EQ(assemble.kind, Task::Assemble);
    EXPECT_EQ(assemble.inputs[0].x, 133);
    EXPECT_EQ(assemble.inputs[0].y, 0);
}

// Pixel i of the context is the centre of destination pixel kernel + i · step, for every width and height.
TEST(Plan, supportsKernelsOfAnySize) {
    for (const int k : {1, 2, 3, 5}) {
        for (int i = 0; i < k; ++i) {
            const std::string kernel = "[ " + std::to_string(i) + " " + std::to_string(k - 1 - i) + " " +
                                       std::to_string(k) + " " + std::to_string(k) + " ]";
            const ResolvedConfig c = resolved(kWall + "compound { channel ( ) compound { channel \"s\" pixel " +
                                              kernel + " outputframe { } } inputframe { name \"frame.s\" } }");
            const FramePlan p = plan(c);
            const RenderContext& s = drawn(p, c, "s");
            EXPECT_EQ(s.viewport.w, (400 + k - 1) / k);
            const double w = s.perspective.width() / s.viewport.w, h = s.perspective.height() / s.viewport.h;
            for (const int n : {0, 7}) {
                EXPECT_NEAR(s.perspective.left + (n + .5) * w, -.08 + .16 * (i + n * k + .5) / 400, 1e-12);
                EXPECT_NEAR(s.perspective.bottom + (n + .5) * h, -.05 + .1 * (k - 1 - i + n * k + .5) / 200, 1e-12);
            }
            EXPECT_EQ(p.channels.back().tasks.back().inputs.at(0).kernel, (PixelKernel{i, k - 1 - i, k, k}));
        }
    }
}

TEST(Plan, distributesSamplesEvenly) {
    for (const int n : {1, 2, 3, 4, 7, 8, 15, 16, 24, 66}) {
        double x = 0, y = 0;
        for (int i = 0; i < n; ++i) {
            const Jitter j = jitterOf({i, n});
            EXPECT_LT(std::max(std::abs(j.x), std::abs(j.y)), .5);
            x += j.x;
            y += j.y;
        }
        EXPECT_NEAR(x, 0, 1e-9);
        EXPECT_NEAR(y, 0, 1e-9);
    }
}

TEST(Plan, undoesZoomsWhereTheyAreShown) {
    const ResolvedConfig c = resolved(
        kWall +
        "compound { channel ( ) compound { channel \"s\" zoom [ .5 .5 ] outputframe { } } compound { channel \"t\" "
        "zoom [ 2 2 ] outputframe { } } inputframe { name \"frame.s\" } inputframe { name \"frame.t\" } }");
    const FramePlan p = plan(c);
    EXPECT_EQ(drawn(p, c, "s").viewport.w, 200);
    EXPECT_EQ(p.frames[0].size.w, 200);                                     // transferred at the small size
    EXPECT_EQ(p.channels.back().channel, 3);                                // (the destination)
    EXPECT_EQ(p.channels.back().tasks.back().inputs[0].zoom, (Zoom{2, 2})); // enlarged at the destination
    EXPECT_EQ(drawn(p, c, "t").viewport.w, 800);
    EXPECT_EQ(p.frames[1].size.w, 400); // reduced before the transfer
    EXPECT_EQ(p.channels.back().tasks.back().inputs[1].zoom, (Zoom{1, 1}));
}

TEST(Plan, showsTheSamePictureInCopies) {
    const ResolvedConfig c = resolved(
        "layout { view { mode STEREO } } canvas { layout 0 wall { } segment { channel \"d\" mural_copy_to \"t\" } }");
    for (const auto mode : {config::ViewMode::Mono, config::ViewMode::Stereo}) {
        const FramePlan p = plan(c, mode);
        const size_t passes = mode == config::ViewMode::Mono ? 1 : 2;
        ASSERT_EQ(p.channels.size(), 2u);
        EXPECT_EQ(p.frames.size(), passes);
        EXPECT_EQ(p.channels.front().tasks.size(), 2 * passes); // clear and assemble of the copy
    }
}

TEST(Plan, supportsTimeMultiplexing) {
    const ResolvedConfig c = resolved(
        kWall + "compound { channel ( ) compound { channel \"s\" period 2 phase 0 outputframe { name \"f\" } } "
                "compound { channel \"t\" period 2 phase 1 outputframe { name \"f\" } } inputframe { name \"f\" } }");
    EXPECT_EQ(c.channels[static_cast<size_t>(plan(c, config::ViewMode::Mono, 0).frames.at(0).channel)].name, "s");
    EXPECT_EQ(c.channels[static_cast<size_t>(plan(c, config::ViewMode::Mono, 1).frames.at(0).channel)].name, "t");
}

TEST(Plan, doesNotClearDrawsOfOtherLeaves) {
    const ResolvedConfig c = resolved(kWall + "compound { channel ( ) compound { range [ 0 .5 ] } compound { range [ "
                                              ".5 1 ] } compound { channel \"d\" viewport [ 0 0 1 0 ] } }");
    const FramePlan p = plan(c);
    ASSERT_EQ(p.channels.size(), 1u);
    std::vector<Task> kinds;
    for (const PlannedTask& t : p.channels[0].tasks) kinds.push_back(t.kind);
    EXPECT_EQ(kinds, (std::vector<Task>{Task::Clear, Task::Draw, Task::Draw}));
}

// A channel draws for another screen, and waits for it, and also shows its own picture in the same window. Its own
// picture follows after that work, although it could continue earlier.
TEST(Plan, separatesChannelsOfOneWindow) {
    const ResolvedConfig c =
        resolved("layout { view { } } canvas { layout 0 wall { } segment { channel \"s\" viewport [ 0 0 .5 1 ] } "
                 "segment { channel \"d\" viewport [ .5 0 .5 1 ] } }"
                 " compound { channel ( segment 1 ) compound { outputframe { name \"x\" } } compound { channel \"s\" "
                 "task [ CLEAR ASSEMBLE READBACK ] inputframe { name \"x\" } outputframe { name \"y\" } }"
                 " inputframe { name \"y\" } } compound { channel ( segment 0 ) }");
    const FramePlan p = plan(c);
    EXPECT_FALSE(p.interleaved);
    bool shown = false, worked = false;
    for (const PipeStep& step : p.pipes.at(0)) {
        const config::ResolvedChannel& channel = c.channels[static_cast<size_t>(p.channels[step.channel].channel)];
        if (channel.name != "s") continue;
        shown = shown || channel.isDestination();
        worked = worked || !channel.isDestination();
        EXPECT_FALSE(shown && !channel.isDestination());
    }
    EXPECT_TRUE(shown && worked);
}

TEST(Plan, takesTheFirstOfTwoFramesOfOneName) {
    const ResolvedConfig c =
        resolved(kWall + "compound { channel ( ) compound { channel \"t\" outputframe { name \"f\" } } compound { "
                         "channel \"s\" outputframe { name \"f\" } } inputframe { name \"f\" } }");
    const FramePlan p = plan(c);
    ASSERT_EQ(p.frames.size(), 1u);
    EXPECT_EQ(c.channels[static_cast<size_t>(p.frames[0].channel)].name, "t");
}

TEST(Plan, namesTheWindowsOfBarriers) {
    const ResolvedConfig c = resolved("layout { view { } } canvas { layout 0 swapbarrier { name \"w\" } segment { "
                                      "channel \"d\" } segment { channel \"t\" } }");
    const FramePlan p = plan(c);
    ASSERT_EQ(p.barriers.size(), 1u);
    EXPECT_EQ(p.barriers[0].windows, (std::vector<Index>{0, 2}));
}

TEST(Plan, switchesLayouts) {
    const ResolvedConfig c = resolved("layout { view { } } layout { view { } view { } } canvas { layout 0 layout 1 "
                                      "layout OFF segment { channel \"d\" } }");
    FrameInput input = firstFrame(c);
    EXPECT_EQ(planFrame(c, input).channels.size(), 1u);
    input.activeLayouts = {1};
    EXPECT_EQ(planFrame(c, input).channels.size(), 2u);
    for (const Index dark : {2, kNone, 99}) {
        input.activeLayouts = {dark};
        EXPECT_TRUE(planFrame(c, input).channels.empty());
    }
}

TEST(Check, reportsCyclicFrames) {
    const auto lines =
        faults(kWall + "compound { channel ( ) compound { channel \"s\" task [ ASSEMBLE READBACK ] inputframe { name "
                       "\"x\" } outputframe { name \"y\" } }"
                       " compound { channel \"t\" task [ ASSEMBLE READBACK ] inputframe { name \"y\" } outputframe { "
                       "name \"x\" } } inputframe { name \"y\" } inputframe { name \"x\" } }");
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0], "error: frames \"x\", \"y\" wait for each other: no picture is ever drawn");
    const auto itself = faults(kWall + "compound { channel ( ) inputframe { name \"x\" } outputframe { name \"x\" } }");
    EXPECT_EQ(itself.back(), "error: frame \"x\" waits for itself: no picture is ever drawn");
    // In different frames there is no cycle.
    EXPECT_TRUE(
        faults(kWall +
               "compound { channel ( ) compound { channel \"s\" outputframe { name \"y\" } } compound { channel \"t\" "
               "period 2 phase 1 inputframe { name \"y\" } outputframe { name \"x\" } } inputframe { name \"x\" } }")
            .empty());
}

TEST(Check, reportsNamesWithoutACounterpart) {
    EXPECT_EQ(faults(kWall + "compound { channel ( ) inputframe { name \"x\" } }"),
              std::vector<std::string>{"no compound of this tree creates frame \"x\", it is ignored"});
    EXPECT_EQ(faults(kWall + "compound { channel ( ) outputframe { name \"x\" } }"),
              std::vector<std::string>{"no compound of this tree uses frame \"x\", it is not read back"});
    EXPECT_EQ(faults(kWall + "compound { channel ( ) compound { channel \"s\" outputframe { } } compound { channel "
                             "\"t\" outputframe { name \"frame.s\" } } inputframe { name \"frame.s\" } }"),
              std::vector<std::string>{"frame \"frame.s\" is defined twice in this tree, only the first one is used"});
    EXPECT_EQ(faults(kWall + "compound { channel ( ) compound { eye [ LEFT ] channel \"s\" outputframe { } } compound "
                             "{ eye [ RIGHT ] task [ ASSEMBLE ] inputframe { name \"frame.s\" } } }"),
              std::vector<std::string>{
                  "frame \"frame.s\" is never created for the eyes and frame numbers that use it, it is ignored"});
    EXPECT_EQ(faults(kWall + "compound { channel ( ) compound { channel \"s\" inputtiles { name \"q\" } } }"),
              std::vector<std::string>{"error: no compound of this tree fills the queue \"q\""});
    EXPECT_EQ(
        faults(kWall + "compound { channel ( ) outputtiles { name \"q\" } compound { inputtiles { name \"q\" } } }"),
        std::vector<std::string>{"error: the queue \"q\" has no size"});
    EXPECT_EQ(faults(kWall + "compound { channel ( ) compound { channel \"t\" outputframe { type texture } } "
                             "inputframe { name \"frame.t\" } }"),
              std::vector<std::string>{
                  "frame \"frame.t\" is a texture, but another pipe uses it, it is transferred through memory"});
}

TEST(Check, reportsPartsThatAreNeverShown) {
    EXPECT_EQ(faults("layout { name \"a\" view { } } layout { name \"b\" view { viewport [ .6 0 .2 1 ] } } canvas { "
                     "layout \"b\" segment { channel \"d\" viewport [ 0 0 .5 1 ] } }"),
              (std::vector<std::string>{"layout \"a\" is not used by a canvas and is never shown",
                                        "view number 1 does not overlap a segment and is never shown"}));
    EXPECT_EQ(faults(kWall + "compound { channel ( ) period 2 phase 2 }"),
              std::vector<std::string>{"phase 2 does not occur with a period of 2, so this compound never draws"});
    EXPECT_EQ(faults(kWall + "compound { channel ( ) load_equalizer { } }"),
              std::vector<std::string>{"this equalizer has no effect: its compound has fewer than two children"});
}

TEST(Plan, usesDefaultsForAnEmptyInput) {
    const ResolvedConfig c = resolved(kWall);
    const FramePlan empty = planFrame(c, FrameInput{}), first = planFrame(c, firstFrame(c));
    ASSERT_FALSE(empty.contexts.empty());
    ASSERT_EQ(empty.channels.size(), first.channels.size());
    ASSERT_EQ(empty.contexts.size(), first.contexts.size());
    for (size_t i = 0; i < empty.contexts.size(); ++i) EXPECT_EQ(empty.contexts[i].area, first.contexts[i].area);
}

} // namespace mural::compound
