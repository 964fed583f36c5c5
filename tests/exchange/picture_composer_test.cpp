// Nodes as threads, with an in-memory network.
#include <atomic>
#include <gtest/gtest.h>
#include <mutex>
#include <thread>

#include "compositor/kernels/half_float.hpp"
#include "nodes/exchange/picture_composer.hpp"
#include "tests/exchange/fake_network.hpp"
#include "tests/exchange/test_scenes.hpp"
#include "tests/recorded_log.hpp"

namespace mural::test {
namespace {

using compositor::DepthFunction;
using compositor::kEveryStrategy;
using compositor::Strategy;

struct Outcome {
    PicturePart picture;
    std::vector<std::string> lines;
};

// lost: a rank that is gone before it sends anything; -1: none.
Outcome compose(const Scene& scene, Strategy strategy, const std::string& plant = "", int lost = -1,
                int64_t partMs = 20'000) {
    FakeNetwork network;
    Outcome outcome;
    const RecordedLog log;
    std::vector<std::thread> nodes;
    const int ranks = static_cast<int>(scene.parts.size());
    if (lost >= 0 && partMs == 20'000) network.lose({lost, 0});
    for (int rank = 0; rank < ranks; ++rank) {
        if (rank == lost) continue;
        nodes.emplace_back([&, rank] {
            FakeRoutes routes(network, {rank, 0});
            PictureComposer composer({strategy, rank, ranks, partMs, 60'000, 200, plant}, routes);
            PicturePart part = scene.parts[static_cast<size_t>(rank)];
            composer.compose(part, scene.rule);
            if (rank == 0) outcome.picture = std::move(part);
        });
    }
    for (std::thread& node : nodes) node.join();
    outcome.lines = log.texts();
    return outcome;
}

TEST(PictureComposer, givesOneNodesPictureWithEveryStrategy) {
    std::mt19937 random(23);
    for (const Strategy strategy : kEveryStrategy)
        for (int ranks = 1; ranks <= 9; ++ranks) {
            const CompositeRule rule = ruleOf(kOrders[ranks % 4], ranks % 3 == 0);
            const Scene scene = sceneOf(random, ranks, rule, 97, ranks == 4 ? 3 : 150);
            const Outcome made = compose(scene, strategy);
            EXPECT_TRUE(made.lines.empty());
            EXPECT_EQ(made.picture.colour, scene.whole.colour) << nameOf(strategy) << ", " << ranks;
            EXPECT_EQ(made.picture.depth, scene.whole.depth) << nameOf(strategy) << ", " << ranks;
        }
}

// Remains of one picture must not appear in the next.
TEST(PictureComposer, composesConsecutivePictures) {
    std::mt19937 random(29);
    for (const Strategy strategy : kEveryStrategy) {
        FakeNetwork network;
        std::vector<Scene> scenes;
        for (int i = 0; i < 6; ++i) {
            scenes.push_back(sceneOf(random, 5, ruleOf(kOrders[i % 4], false), 40 + 10 * (i % 2), 60 + 20 * (i % 3)));
            for (PicturePart& part : scenes.back().parts) part.id.serial = static_cast<uint64_t>(i);
        }
        std::vector<std::thread> nodes;
        const RecordedLog log;
        std::atomic<int> wrong{0};
        for (int rank = 0; rank < 5; ++rank)
            nodes.emplace_back([&, rank] {
                FakeRoutes routes(network, {rank, 0});
                PictureComposer composer({strategy, rank, 5, 20'000, 60'000, 5'000, ""}, routes);
                for (const Scene& scene : scenes) {
                    PicturePart part = scene.parts[static_cast<size_t>(rank)];
                    composer.compose(part, scene.rule);
                    if (rank == 0 && (part.colour != scene.whole.colour || part.depth != scene.whole.depth)) ++wrong;
                }
            });
        for (std::thread& node : nodes) node.join();
        EXPECT_EQ(wrong, 0) << nameOf(strategy);
        EXPECT_EQ(log.text(), "") << nameOf(strategy);
    }
}

TEST(PictureComposer, showsPlantedFaults) {
    std::mt19937 random(31);
    const Scene scene = sceneOf(random, 4, ruleOf(DepthFunction::LessOrEqual, false), 97, 150);
    for (const Strategy strategy : kEveryStrategy)
        for (const char* plant : {"range", "tie", "order", "band"}) {
            // these strategies gather no bands
            if (std::string(plant) == "band" && (strategy == Strategy::Serial || strategy == Strategy::Streaming))
                continue;
            EXPECT_NE(compose(scene, strategy, plant).picture.colour, scene.whole.colour)
                << nameOf(strategy) << " " << plant;
        }
}

// Random premultiplied colours of a rank, about half of them transparent.
PicturePart translucentPart(std::mt19937& random, const CompositeRule& rule) {
    PicturePart part = clearedPart(61, 90, rule);
    part.depth.clear();
    for (uint32_t& colour : part.colour) {
        const uint32_t alpha = random() % 2 ? 0 : random() % 256;
        const auto channel = [&] { return alpha == 0 ? 0 : static_cast<uint32_t>(random()) % (alpha + 1); };
        colour = alpha << 24 | channel() << 16 | channel() << 8 | channel();
    }
    return part;
}

CompositeRule blendingRule(bool hasHalfFloats = false) {
    CompositeRule rule;
    rule.blends = true;
    rule.hasHalfFloats = hasHalfFloats;
    return rule;
}

// Blends parts of `orders.size()` ranks, each with an order of its own.
Outcome blend(const std::vector<PicturePart>& parts, Strategy strategy, const std::vector<std::vector<int>>& orders,
              int64_t partMs = 20'000, const CompositeRule& rule = blendingRule()) {
    FakeNetwork network;
    Outcome outcome;
    const RecordedLog log;
    std::vector<std::thread> nodes;
    for (size_t rank = 0; rank < parts.size(); ++rank)
        nodes.emplace_back([&, rank] {
            FakeRoutes routes(network, {static_cast<int>(rank), 0});
            PictureComposer composer(
                {strategy, static_cast<int>(rank), static_cast<int>(parts.size()), partMs, 60'000, 100, ""}, routes);
            PicturePart part = parts[rank];
            composer.compose(part, rule, orders[rank]);
            if (rank == 0) outcome.picture = std::move(part);
        });
    for (std::thread& node : nodes) node.join();
    outcome.lines = log.texts();
    return outcome;
}

std::vector<PicturePart> translucentParts(int ranks) {
    std::mt19937 random(41);
    const CompositeRule rule = blendingRule();
    std::vector<PicturePart> parts;
    for (int rank = 0; rank < ranks; ++rank) parts.push_back(translucentPart(random, rule));
    return parts;
}

// Strategies round in different orders, so the values differ by the rounding of each step.
TEST(PictureComposer, blendsInTheGivenOrderWithEveryStrategy) {
    const CompositeRule rule = blendingRule();
    for (const Strategy strategy : kEveryStrategy)
        for (const std::vector<int>& order : {std::vector{0, 1}, {1, 0}, {2, 0, 1}, {3, 1, 4, 0, 2}}) {
            const auto parts = translucentParts(static_cast<int>(order.size()));
            PicturePart expected = parts[static_cast<size_t>(order.front())];
            for (size_t i = 1; i < order.size(); ++i) {
                const PicturePart& next = parts[static_cast<size_t>(order[i])];
                compositeRow({expected.colour.data(), nullptr, next.colour.data(), nullptr, next.colour.size()},
                             LayerOrder::Later, rule);
            }
            const Outcome made = blend(parts, strategy, std::vector(order.size(), order));
            EXPECT_TRUE(made.lines.empty()) << made.lines.front();
            int most = 0;
            for (size_t i = 0; i < expected.colour.size(); ++i)
                for (int shift = 0; shift < 32; shift += 8)
                    most = std::max(most, std::abs(static_cast<int>(made.picture.colour[i] >> shift & 255) -
                                                   static_cast<int>(expected.colour[i] >> shift & 255)));
            EXPECT_LE(most, static_cast<int>(order.size())) << nameOf(strategy) << ", " << order.size();
        }
}

uint32_t halfOf(uint32_t steps) { return compositor::halfOfFloat(static_cast<float>(steps) / 1024); }

TEST(PictureComposer, blendsHalfFloats) {
    std::mt19937 random(43);
    const CompositeRule rule = blendingRule(true);
    std::vector<PicturePart> parts;
    for (int rank = 0; rank < 2; ++rank) {
        PicturePart part = clearedPart(61, 90, rule);
        part.depth.clear();
        part.colour.resize(2 * part.colour.size());
        for (size_t i = 0; i < part.colour.size(); i += 2) {
            if (random() % 2) continue; // transparent
            part.colour[i] = halfOf(random() % 2048) | halfOf(random() % 2048) << 16;
            part.colour[i + 1] = halfOf(random() % 2048) | halfOf(random() % 1025) << 16;
        }
        parts.push_back(std::move(part));
    }
    PicturePart expected = parts[1]; // the back
    compositeRow({expected.colour.data(), nullptr, parts[0].colour.data(), nullptr, expected.colour.size() / 2},
                 LayerOrder::Later, rule);
    for (const Strategy strategy : kEveryStrategy) {
        const Outcome made = blend(parts, strategy, {{1, 0}, {1, 0}}, 20'000, rule);
        EXPECT_TRUE(made.lines.empty()) << made.lines.front();
        EXPECT_EQ(made.picture.colour, expected.colour) << nameOf(strategy);
    }
}

TEST(PictureComposer, reportsOrdersThatDifferBetweenNodes) {
    const auto parts = translucentParts(3);
    const std::vector<std::vector<int>> orders{{0, 1, 2}, {0, 1, 2}, {2, 1, 0}};
    for (const Strategy strategy : {Strategy::Serial, Strategy::DirectSend}) {
        const Outcome made = blend(parts, strategy, orders);
        ASSERT_FALSE(made.lines.empty()) << nameOf(strategy);
        for (const std::string& line : made.lines)
            EXPECT_NE(line.find("blend in different orders, so the picture is wrong; Renderer::order must return the "
                                "same positions on all nodes"),
                      std::string::npos)
                << line;
    }
    // The order selects the partners of a node. No node waits forever.
    for (const Strategy strategy : kEveryStrategy) {
        if (strategy == Strategy::Serial || strategy == Strategy::DirectSend) continue;
        const Outcome made = blend(parts, strategy, orders, 200);
        ASSERT_FALSE(made.lines.empty()) << nameOf(strategy);
        for (const std::string& line : made.lines)
            EXPECT_NE(line.find("Renderer::order"), std::string::npos) << nameOf(strategy) << ": " << line;
    }
}

// The node's draws are missing; no node waits forever, and each node that waited reports the loss once.
TEST(PictureComposer, doesNotBlockOnALostNode) {
    std::mt19937 random(37);
    const Scene scene = sceneOf(random, 5, ruleOf(DepthFunction::Less, false), 60, 90);
    for (const Strategy strategy : kEveryStrategy)
        for (int lost = 1; lost < 5; ++lost) {
            const Outcome made = compose(scene, strategy, "", lost);
            ASSERT_FALSE(made.lines.empty());
            for (const std::string& line : made.lines)
                EXPECT_EQ(line, "a range of the picture is missing until its node rejoins: range " +
                                    std::to_string(lost + 1) + " is disconnected");
        }
}

// Composes three pictures with a lost node, or with two nodes that cannot connect (cut); returns the last one.
PicturePart thirdPicture(const Scene& scene, Strategy strategy, int lost, std::pair<int, int> cut) {
    FakeNetwork network;
    if (lost >= 0) network.lose({lost, 0});
    network.cut(cut.first, cut.second);
    PicturePart last;
    std::vector<std::thread> nodes;
    const int ranks = static_cast<int>(scene.parts.size());
    for (int rank = 0; rank < ranks; ++rank) {
        if (rank == lost) continue;
        nodes.emplace_back([&, rank] {
            FakeRoutes routes(network, {rank, 0});
            PictureComposer composer({strategy, rank, ranks, 20'000, 60'000, 5'000, ""}, routes);
            for (uint64_t serial = 1; serial <= 3; ++serial) {
                PicturePart part = scene.parts[static_cast<size_t>(rank)];
                part.id.serial = serial;
                composer.compose(part, scene.rule);
                if (rank == 0) last = std::move(part);
            }
        });
    }
    for (std::thread& node : nodes) node.join();
    return last;
}

// From the second picture after the loss at the latest, only the lost node's draws are missing.
TEST(PictureComposer, missesOnlyTheLostNodesDrawsAfterALoss) {
    std::mt19937 random(43);
    const Scene scene = sceneOf(random, 7, ruleOf(DepthFunction::LessOrEqual, false), 60, 150);
    for (const Strategy strategy : kEveryStrategy)
        for (int lost = 1; lost < 7; ++lost) {
            const PicturePart expected = foldedWithout(scene, {lost});
            EXPECT_EQ(thirdPicture(scene, strategy, lost, {-1, -1}).colour, expected.colour)
                << nameOf(strategy) << " without " << lost;
        }
}

TEST(PictureComposer, sendsToTheCollectorWhenNodesCannotConnect) {
    std::mt19937 random(47);
    const Scene scene = sceneOf(random, 6, ruleOf(DepthFunction::Less, false), 60, 150);
    for (const Strategy strategy : kEveryStrategy)
        for (const auto& cut : {std::pair(1, 2), std::pair(2, 3), std::pair(3, 5)})
            EXPECT_EQ(thirdPicture(scene, strategy, -1, cut).colour, scene.whole.colour) << nameOf(strategy);
}

// Nodes that wait for a silent node must not count as lost themselves.
TEST(PictureComposer, losesOnlyTheSilentNode) {
    std::mt19937 random(41);
    const Scene scene = sceneOf(random, 5, ruleOf(DepthFunction::Less, false), 60, 90);
    for (const Strategy strategy : kEveryStrategy) {
        const Outcome made = compose(scene, strategy, "", 3, 300);
        for (const std::string& line : made.lines)
            EXPECT_EQ(line, "a range of the picture is missing until its node rejoins: range 4 is disconnected")
                << nameOf(strategy);
    }
}

} // namespace
} // namespace mural::test
