// Executes random trees with nested decompositions without drawing: every pixel is drawn at its place, with its
// complete range and every sample once, in every frame, without deadlock.
#include <gtest/gtest.h>

#include "balancer/compound/even_split.hpp"
#include "balancer/compound/load_config.hpp"
#include "balancer/compound/plan_frame.hpp"
#include "balancer/config/eqc/writer.hpp"
#include "tests/balancer/symbolic_wall.hpp"
#include "tests/balancer/tree_maker.hpp"
#include "tests/sanitized.hpp"

namespace mural::compound {

using config::ConfigFile;
using testing::TreeMaker;

TEST(RandomTrees, showEveryPixelOnce) {
    size_t tasks = 0;
    for (uint64_t seed = 1; seed <= mural::testing::rounds(150); ++seed) {
        const ConfigFile file = TreeMaker(seed).make();
        const LoadedConfig loaded =
            loadConfig(file, "seed " + std::to_string(seed), [](const std::string&) { return std::nullopt; });
        ASSERT_TRUE(loaded.ok()) << loaded.diagnostics.firstError() << config::writeConfig(file);
        FrameInput input = firstFrame(loaded.resolved);
        for (input.frameNumber = 0; input.frameNumber < 12; input.frameNumber += 1 + input.frameNumber / 4) {
            const FramePlan plan = planFrame(loaded.resolved, input);
            for (const ChannelPlan& c : plan.channels) tasks += c.tasks.size();
            ASSERT_EQ(testing::SymbolicWall(loaded.resolved, input, plan).run(), "")
                << "seed " << seed << " frame " << input.frameNumber << "\n"
                << config::writeConfig(file);
        }
    }
    EXPECT_GT(tasks, mural::testing::rounds(4'000));
}

} // namespace mural::compound
