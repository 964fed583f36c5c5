// view_equalizer: pipes lent between the segments of a wall. Four segments, each with a pipe of its own and leaves on
// all other pipes.
#include <gtest/gtest.h>

#include "balancer/compound/even_split.hpp"
#include "balancer/equalizers/view_equalizer.hpp"
#include "tests/balancer/text_config.hpp"

namespace mural::balance {
namespace {

constexpr size_t kSegments = 4;

compound::LoadedConfig wallOf(size_t segments) {
    std::string pipes, places, compounds;
    for (size_t s = 0; s < segments; ++s) {
        const std::string own = "\"c" + std::to_string(s) + "\"";
        pipes += "pipe { window { viewport [ 0 0 100 100 ] channel { name " + own + " } } }\n";
        places += "segment { channel " + own + " viewport [ " + std::to_string(1. * double(s) / double(segments)) +
                  " 0 " + std::to_string(1. / double(segments)) + " 1 ] }\n";
        compounds += "compound { channel ( segment " + std::to_string(s) + " view 0 ) load_equalizer { }\n";
        for (size_t pipe = 0; pipe < segments; ++pipe)
            compounds += pipe == s ? "compound { }\n"
                                   : "compound { channel \"c" + std::to_string(pipe) + "\" outputframe { name \"f" +
                                         std::to_string(s) + "." + std::to_string(pipe) + "\" } }\n";
        for (size_t pipe = 0; pipe < segments; ++pipe)
            if (pipe != s)
                compounds += "inputframe { name \"f" + std::to_string(s) + "." + std::to_string(pipe) + "\" }\n";
        compounds += "}\n";
    }
    return testing::configOf("appNode { " + pipes + " } layout { view { } } canvas { layout 0 wall { } " + places +
                             " } compound { view_equalizer { }\n" + compounds + " }");
}

// A wall whose segments have loads. A segment divides its load among its leaves with usage, in proportion to it.
class Wall {
public:
    explicit Wall(size_t segments = kSegments)
        : loaded_(wallOf(segments)),
          input_(compound::firstFrame(loaded_.resolved)),
          equalizer_("view", config(), config().roots.front()),
          loads(segments, 1) {
        EXPECT_TRUE(loaded_.ok());
        for (auto& state : input_.compounds) state.usage = 0;
        for (size_t s = 0; s < segments; ++s) usage(s, s) = 1;
    }

    double& usage(size_t segment, size_t pipe) {
        const Index child = config().compounds[at(config().roots.front())].children[segment];
        return input_.compounds[at(config().compounds[at(child)].children[pipe])].usage;
    }
    double usageOf(size_t segment) {
        double sum = 0;
        for (size_t pipe = 0; pipe < loads.size(); ++pipe) sum += usage(segment, pipe);
        return sum;
    }
    void run(int frames) {
        for (int f = 0; f < frames; ++f) {
            equalizer_.observe(draw());
            const FrameContext context{config(), input_};
            equalizer_.update(context, input_.compounds);
            moves += equalizer_.lastDecision().moved;
            ++input_.frameNumber;
        }
    }
    FrameStatistics draw() {
        FrameStatistics statistics;
        statistics.frameNumber = input_.frameNumber;
        for (size_t s = 0; s < loads.size(); ++s)
            for (size_t pipe = 0; pipe < loads.size(); ++pipe) {
                if (usage(s, pipe) <= 0) continue;
                LeafStatistics leaf;
                leaf.compound =
                    config().compounds[at(config().compounds[at(config().roots[0])].children[s])].children[pipe];
                (isTransferred ? leaf.transferSeconds : leaf.busySeconds) = loads[s] * usage(s, pipe) / usageOf(s);
                statistics.leaves.push_back(leaf);
            }
        return statistics;
    }
    // Returns the problem of the usages; empty: none.
    std::string problem() {
        for (size_t pipe = 0; pipe < loads.size(); ++pipe) {
            double sum = 0;
            int served = 0;
            for (size_t s = 0; s < loads.size(); ++s) {
                const double u = usage(s, pipe);
                if (u < 0 || (u > 0 && u < .1 - 1e-9)) return "usage " + std::to_string(u);
                sum += u;
                served += u > 0;
            }
            // a segment that needs almost nothing takes a little of its own pipe, even of one that is lent
            if (sum > 1.1 + 1e-9) return "pipe " + std::to_string(pipe) + " is used " + std::to_string(sum);
            if (served > 3) return "pipe " + std::to_string(pipe) + " serves " + std::to_string(served);
        }
        for (size_t s = 0; s < loads.size(); ++s)
            if (usageOf(s) <= 0) return "segment " + std::to_string(s) + " has no pipe";
        return "";
    }
    [[nodiscard]] const ResolvedConfig& config() const { return loaded_.resolved; }
    ViewEqualizer& equalizer() { return equalizer_; }
    [[nodiscard]] States& states() { return input_.compounds; }

private:
    compound::LoadedConfig loaded_;
    compound::FrameInput input_;
    ViewEqualizer equalizer_;

public:
    std::vector<double> loads; // seconds per frame, by segment
    bool isTransferred = false;
    int moves = 0;
};

TEST(ViewEqualizer, leavesEachSegmentItsPipeWhenLoadsAreEqual) {
    Wall wall;
    wall.run(30);
    for (size_t s = 0; s < kSegments; ++s)
        for (size_t pipe = 0; pipe < kSegments; ++pipe) EXPECT_EQ(wall.usage(s, pipe), s == pipe ? 1 : 0);
    EXPECT_EQ(wall.moves, 0);
}

TEST(ViewEqualizer, lendsPipesOfCheapSegmentsToExpensiveOnes) {
    Wall wall;
    wall.loads = {9, 1, 1, 1};
    wall.run(60);
    EXPECT_EQ(wall.problem(), "");
    EXPECT_EQ(wall.usage(0, 0), 1) << "its own pipe first";
    EXPECT_GT(wall.usageOf(0), 2);
    for (size_t s = 1; s < kSegments; ++s) {
        EXPECT_LT(wall.usageOf(s), 1);
        EXPECT_EQ(wall.usageOf(s), wall.usage(s, s)) << "a cheap segment needs its own pipe only";
    }
}

TEST(ViewEqualizer, countsTransfersThatTakeLongerThanDrawing) {
    Wall wall;
    wall.isTransferred = true;
    wall.loads = {9, 1, 1, 1};
    wall.run(60);
    EXPECT_GT(wall.usageOf(0), 2);
}

TEST(ViewEqualizer, restsWhenNeedsStayAndChangesLittleForSmallChanges) {
    Wall wall;
    wall.loads = {6, 2, 2, 2};
    wall.run(80);
    const int settled = wall.moves;
    wall.run(40);
    wall.loads = {6.2, 2, 1.9, 2};
    wall.run(40);
    EXPECT_EQ(wall.moves, settled);
    wall.loads = {2, 2, 6, 2};
    wall.run(80);
    EXPECT_GT(wall.moves, settled);
    EXPECT_GT(wall.usageOf(2), 1.3);
    EXPECT_LT(wall.usageOf(0), 1);
}

TEST(ViewEqualizer, givesEachSegmentAPipeForAnyLoads) {
    for (size_t heavy = 0; heavy < kSegments; ++heavy) {
        Wall wall;
        wall.loads.assign(kSegments, 1e-9);
        wall.loads[heavy] = 1;
        for (int f = 0; f < 40; ++f) {
            wall.run(1);
            ASSERT_EQ(wall.problem(), "") << "segment " << heavy << ", frame " << f;
        }
    }
}

TEST(ViewEqualizer, changesNothingBeforeMeasurementsAndWhileFrozen) {
    Wall wall;
    const States first = wall.states();
    const compound::FrameInput input = compound::firstFrame(wall.config());
    wall.equalizer().update({wall.config(), input}, wall.states());
    EXPECT_EQ(wall.states(), first);
    wall.equalizer().freeze(true, wall.states());
    wall.loads = {9, 1, 1, 1};
    wall.run(40);
    EXPECT_EQ(wall.states(), first);
    wall.equalizer().freeze(false, wall.states());
    wall.run(1);
    EXPECT_GT(wall.usageOf(0), 2);
}

TEST(ViewEqualizer, hasNoEffectWithOneSegment) {
    Wall wall(1);
    wall.run(20);
    EXPECT_EQ(wall.usage(0, 0), 1);
    EXPECT_EQ(wall.moves, 0);
}

} // namespace
} // namespace mural::balance
