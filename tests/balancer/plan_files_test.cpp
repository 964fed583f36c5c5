// Executes every configuration file without drawing: every layout, mono and stereo, several frames.
#include <gtest/gtest.h>

#include "balancer/compound/even_split.hpp"
#include "balancer/compound/load_config.hpp"
#include "balancer/compound/plan_frame.hpp"
#include "tests/balancer/example_files.hpp"
#include "tests/balancer/symbolic_wall.hpp"

namespace mural::compound {

namespace {

std::optional<std::string> noEnvironment(const std::string&) { return std::nullopt; }

// Reduces the size to the smallest that distinguishes all positions.
void shrink(const ResolvedConfig& config, FrameInput& input) {
    for (size_t w = 0; w < config.windows.size(); ++w) {
        const PixelViewport& size = input.sizes.windows[w];
        resizeWindow(config, static_cast<Index>(w), {std::max(6, size.w / 40), std::max(6, size.h / 40)}, input.sizes);
    }
    splitEvenly(config, input);
}

void expectWhole(const std::string& path) {
    const LoadedConfig loaded = loadConfig(path, noEnvironment);
    ASSERT_TRUE(loaded.ok()) << loaded.diagnostics.firstError();
    const ResolvedConfig& config = loaded.resolved;
    FrameInput input = firstFrame(config);
    shrink(config, input);
    size_t layouts = 1;
    for (const auto& c : config.canvases) layouts = std::max(layouts, c.layouts.size());
    for (size_t layout = 0; layout < layouts; ++layout) {
        input.activeLayouts.assign(config.canvases.size(), static_cast<Index>(layout));
        for (const bool switched : {false, true}) {
            input.views.clear();
            for (const auto& v : config.views) {
                const bool stereo = (v.mode == config::ViewMode::Stereo) != switched;
                input.views.push_back({stereo ? config::ViewMode::Stereo : config::ViewMode::Mono, 1, {}});
            }
            for (input.frameNumber = 0; input.frameNumber < 4; ++input.frameNumber) {
                const FramePlan plan = planFrame(config, input);
                const std::string wrong = testing::SymbolicWall(config, input, plan).run();
                // Files for stereo only may show nothing in mono, and vice versa.
                if (switched && wrong.ends_with("nothing was drawn")) continue;
                ASSERT_EQ(wrong, "") << "layout " << layout << " frame " << input.frameNumber
                                     << (switched ? ", mono and stereo exchanged" : "");
            }
        }
    }
}

} // namespace

TEST(PlanFiles, showEveryPixelOnce) {
    for (const auto& path : config::testing::allFiles()) {
        SCOPED_TRACE(path.filename().string());
        if (path.filename() == "own-coverage.eqc") continue; // uses every keyword, so its picture makes no sense
        if (path.filename() == "frame-zoom.eqc") continue;   // merges pixels intentionally: see FrameFlow
        if (path.filename() == "monitor.eqc") continue;      // its monitor shows scaled pixels: see FrameFlow
        expectWhole(path.string());
    }
    if (config::testing::exampleFiles().empty()) GTEST_SKIP() << config::testing::noExamples();
}

TEST(PlanFiles, reportNoProblemInOurFiles) {
    EXPECT_GE(config::testing::ownFiles().size(), 10u);
    for (const auto& path : config::testing::ownFiles()) {
        const LoadedConfig loaded = loadConfig(path.string(), noEnvironment);
        for (const auto& d : loaded.diagnostics.all()) ADD_FAILURE() << loaded.diagnostics.text(d);
        EXPECT_FALSE(loaded.file.heading.empty()) << path << " does not say what it is for";
    }
}

} // namespace mural::compound
