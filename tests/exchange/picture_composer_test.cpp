// Nodes as threads, with a network in memory.
#include <atomic>
#include <condition_variable>
#include <deque>
#include <gtest/gtest.h>
#include <mutex>
#include <thread>

#include "nodes/exchange/picture_composer.hpp"
#include "tests/exchange/test_parts.hpp"

namespace mural::test {
namespace {

using compositor::DepthFunction;
using compositor::kEveryStrategy;
using compositor::Strategy;

class FakeNetwork {
public:
    void put(int from, int to, std::vector<std::byte> message) {
        const std::lock_guard lock(mutex_);
        if (isCut(from, to)) return;
        under_[{from, to}].push_back(std::move(message));
        changed_.notify_all();
    }
    Result<std::vector<std::byte>> take(int from, int to, Deadline deadline) {
        std::unique_lock lock(mutex_);
        auto& coming = under_[{from, to}];
        if (!changed_.wait_for(lock, std::chrono::nanoseconds(deadline.leftNs()), [&] { return !coming.empty() || gone_.contains(from) || isCut(from, to); }) || coming.empty())
            return Error{"range " + std::to_string(from + 1) + " is gone"};
        auto message = std::move(coming.front());
        coming.pop_front();
        return message;
    }
    void lose(int rank) {
        const std::lock_guard lock(mutex_);
        gone_.insert(rank);
        changed_.notify_all();
    }
    // Nothing gets from one to the other, neither way.
    void cut(int a, int b) { cut_ = {a, b}; }

private:
    [[nodiscard]] bool isCut(int a, int b) const { return cut_ == std::pair(std::min(a, b), std::max(a, b)); }
    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::pair<int, int>, std::deque<std::vector<std::byte>>> under_;
    std::set<int> gone_;
    std::pair<int, int> cut_{-1, -1};
};

class FakeRoutes final : public PartRoutes {
public:
    FakeRoutes(FakeNetwork& network, int rank) : network_(network), rank_(rank) {}
    Result<void> send(int rank, std::vector<std::byte> message, Deadline) override {
        network_.put(rank_, rank, std::move(message));
        return {};
    }
    Result<std::vector<std::byte>> receive(int rank, size_t mostBytes, Deadline deadline) override {
        auto message = network_.take(rank, rank_, deadline);
        if (message && message->size() > mostBytes) return Error{"too large"};
        return message;
    }
    LinkTransfer takeTransfer(int) override { return {}; }
    void giveUp(int) override {}

private:
    FakeNetwork& network_;
    int rank_;
};

struct Scene {
    FoldRule rule;
    PicturePart whole; // of one machine
    std::vector<PicturePart> parts;
};

Scene sceneOf(std::mt19937& random, int ranks, const FoldRule& rule, int32_t width, int32_t height) {
    Scene s{rule, clearedPart(width, height, rule), {}};
    for (int rank = 0; rank < ranks; ++rank) {
        s.parts.push_back(clearedPart(width, height, rule));
        if (rank % 5 == 4) continue; // one that has drawn nothing
        for (const Fragment& f : fragmentsOf(random, s.whole.colour.size(), rule)) {
            draw(s.whole, f.at, f.colour, f.depth, rule);
            draw(s.parts.back(), f.at, f.colour, f.depth, rule);
        }
    }
    return s;
}

struct Outcome {
    PicturePart picture;
    std::vector<std::string> lines;
};

// lost: a rank that is gone before it sends anything; -1: none.
Outcome compose(const Scene& scene, Strategy strategy, const std::string& plant = "", int lost = -1, int64_t partMs = 20'000) {
    FakeNetwork network;
    Outcome outcome;
    std::mutex mutex;
    std::vector<std::thread> nodes;
    const int ranks = static_cast<int>(scene.parts.size());
    if (lost >= 0 && partMs == 20'000) network.lose(lost);
    for (int rank = 0; rank < ranks; ++rank) {
        if (rank == lost) continue;
        nodes.emplace_back([&, rank] {
            FakeRoutes routes(network, rank);
            PictureComposer composer({strategy, rank, ranks, partMs, 60'000, 200, plant}, routes, [&](const std::string& line) {
                const std::lock_guard lock(mutex);
                outcome.lines.push_back(line);
            });
            PicturePart part = scene.parts[static_cast<size_t>(rank)];
            composer.compose(part, scene.rule);
            if (rank == 0) outcome.picture = std::move(part);
        });
    }
    for (std::thread& node : nodes) node.join();
    return outcome;
}

TEST(PictureComposer, everyStrategyGivesThePictureOfOneMachine) {
    std::mt19937 random(23);
    for (const Strategy strategy : kEveryStrategy)
        for (int ranks = 1; ranks <= 9; ++ranks) {
            const FoldRule rule = ruleOf(kOrders[ranks % 4], ranks % 3 == 0);
            const Scene scene = sceneOf(random, ranks, rule, 97, ranks == 4 ? 3 : 150);
            const Outcome made = compose(scene, strategy);
            EXPECT_TRUE(made.lines.empty());
            EXPECT_EQ(made.picture.colour, scene.whole.colour) << nameOf(strategy) << ", " << ranks;
            EXPECT_EQ(made.picture.depth, scene.whole.depth) << nameOf(strategy) << ", " << ranks;
        }
}

// Pictures follow each other; what is left of one must not stand in the next.
TEST(PictureComposer, picturesFollowEachOther) {
    std::mt19937 random(29);
    for (const Strategy strategy : kEveryStrategy) {
        FakeNetwork network;
        std::vector<Scene> scenes;
        for (int i = 0; i < 6; ++i) {
            scenes.push_back(sceneOf(random, 5, ruleOf(kOrders[i % 4], false), 40 + 10 * (i % 2), 60 + 20 * (i % 3)));
            for (PicturePart& part : scenes.back().parts) part.id.serial = static_cast<uint64_t>(i);
        }
        std::vector<std::thread> nodes;
        std::atomic<int> wrong{0};
        for (int rank = 0; rank < 5; ++rank)
            nodes.emplace_back([&, rank] {
                FakeRoutes routes(network, rank);
                PictureComposer composer({strategy, rank, 5, 20'000, 60'000, 5'000, ""}, routes, [&](const std::string&) { ++wrong; });
                for (const Scene& scene : scenes) {
                    PicturePart part = scene.parts[static_cast<size_t>(rank)];
                    composer.compose(part, scene.rule);
                    if (rank == 0 && (part.colour != scene.whole.colour || part.depth != scene.whole.depth)) ++wrong;
                }
            });
        for (std::thread& node : nodes) node.join();
        EXPECT_EQ(wrong, 0) << nameOf(strategy);
    }
}

TEST(PictureComposer, plantedFaultsAreSeen) {
    std::mt19937 random(31);
    const Scene scene = sceneOf(random, 4, ruleOf(DepthFunction::LessOrEqual, false), 97, 150);
    for (const Strategy strategy : kEveryStrategy)
        for (const char* plant : {"range", "tie", "order", "band"}) {
            if (std::string(plant) == "band" && (strategy == Strategy::Serial || strategy == Strategy::Streaming)) continue; // they have no bands to gather
            EXPECT_NE(compose(scene, strategy, plant).picture.colour, scene.whole.colour) << nameOf(strategy) << " " << plant;
        }
}

// What it drew is missing; nobody waits for ever, and it is said once by each that waited for it.
TEST(PictureComposer, aLostNodeHoldsUpNobody) {
    std::mt19937 random(37);
    const Scene scene = sceneOf(random, 5, ruleOf(DepthFunction::Less, false), 60, 90);
    for (const Strategy strategy : kEveryStrategy)
        for (int lost = 1; lost < 5; ++lost) {
            const Outcome made = compose(scene, strategy, "", lost);
            ASSERT_FALSE(made.lines.empty());
            for (const std::string& line : made.lines) EXPECT_EQ(line, "a range of the picture is missing from now on: range " + std::to_string(lost + 1) + " is gone");
        }
}

PicturePart foldedWithout(const Scene& scene, int lost) {
    PicturePart picture = scene.parts[0];
    for (size_t rank = 1; rank < scene.parts.size(); ++rank) {
        const PicturePart& part = scene.parts[rank];
        if (static_cast<int>(rank) != lost) foldRow({picture.colour.data(), picture.depth.data(), part.colour.data(), part.depth.data(), part.colour.size()}, FoldSide::Later, scene.rule);
    }
    return picture;
}

// Three pictures by nodes of which one is gone (lost), or two can't reach each other (cut); the last one.
PicturePart thirdPicture(const Scene& scene, Strategy strategy, int lost, std::pair<int, int> cut) {
    FakeNetwork network;
    if (lost >= 0) network.lose(lost);
    network.cut(cut.first, cut.second);
    PicturePart last;
    std::vector<std::thread> nodes;
    const int ranks = static_cast<int>(scene.parts.size());
    for (int rank = 0; rank < ranks; ++rank) {
        if (rank == lost) continue;
        nodes.emplace_back([&, rank] {
            FakeRoutes routes(network, rank);
            PictureComposer composer({strategy, rank, ranks, 20'000, 60'000, 5'000, ""}, routes, [](const std::string&) {});
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

// From the next picture on, or the one after, nothing is missing but what the lost node draws.
TEST(PictureComposer, afterALossOnlyWhatTheLostNodeDrawsIsMissing) {
    std::mt19937 random(43);
    const Scene scene = sceneOf(random, 7, ruleOf(DepthFunction::LessOrEqual, false), 60, 150);
    for (const Strategy strategy : kEveryStrategy)
        for (int lost = 1; lost < 7; ++lost) {
            const PicturePart expected = foldedWithout(scene, lost);
            EXPECT_EQ(thirdPicture(scene, strategy, lost, {-1, -1}).colour, expected.colour) << nameOf(strategy) << " without " << lost;
        }
}

TEST(PictureComposer, nodesThatCanNotReachEachOtherSendToTheCollector) {
    std::mt19937 random(47);
    const Scene scene = sceneOf(random, 6, ruleOf(DepthFunction::Less, false), 60, 150);
    for (const Strategy strategy : kEveryStrategy)
        for (const auto& cut : {std::pair(1, 2), std::pair(2, 3), std::pair(3, 5)}) EXPECT_EQ(thirdPicture(scene, strategy, -1, cut).colour, scene.whole.colour) << nameOf(strategy);
}

// One that is silent: those who wait for it are not taken for lost themselves.
TEST(PictureComposer, aSilentNodeIsTheOnlyOneThatIsLost) {
    std::mt19937 random(41);
    const Scene scene = sceneOf(random, 5, ruleOf(DepthFunction::Less, false), 60, 90);
    for (const Strategy strategy : kEveryStrategy) {
        const Outcome made = compose(scene, strategy, "", 3, 300);
        for (const std::string& line : made.lines) EXPECT_EQ(line, "a range of the picture is missing from now on: range 4 is gone") << nameOf(strategy);
    }
}

} // namespace
} // namespace mural::test
