// Nodes that are lost, and take part again from one picture on.
#include <gtest/gtest.h>
#include <mutex>
#include <thread>

#include "nodes/exchange/picture_composer.hpp"
#include "tests/exchange/fake_network.hpp"
#include "tests/exchange/test_scenes.hpp"

namespace mural::test {
namespace {

using compositor::DepthFunction;
using compositor::kEveryStrategy;
using compositor::Strategy;

struct Happening {
    enum class Kind { Lost, Returned } kind;
    int rank = 0;
    uint64_t before = 0;       // number of the picture
    std::set<int> absent = {}; // as announced by the head when a node has returned
};
constexpr int64_t kPartMs = 5000; // reached only by a failing test
constexpr auto kLost = Happening::Kind::Lost, kReturned = Happening::Kind::Returned;

// Several pictures of one scene, with events between them.
class Story {
public:
    Story(const Scene& scene, Strategy strategy, uint64_t pictures, std::vector<Happening> happenings)
        : scene_(scene), strategy_(strategy), happenings_(std::move(happenings)), pictures_(pictures), sent_(pictures) {
        std::vector<std::thread> ranks;
        for (int rank = 0; rank < static_cast<int>(scene.parts.size()); ++rank)
            ranks.emplace_back([this, rank] { live(rank); });
        for (std::thread& rank : ranks) rank.join();
    }
    [[nodiscard]] const std::vector<uint32_t>& colour(uint64_t picture) const { return pictures_[picture].colour; }
    // Messages of the collector up to this picture.
    [[nodiscard]] int sent(uint64_t picture) const { return sent_[picture]; }

private:
    // Runs all incarnations of this rank in sequence.
    void live(int rank) {
        FakeNode node{rank, 0};
        uint64_t next = 0;
        while (next < pictures_.size()) {
            next = take(node, next);
            if (next == pictures_.size()) return;
            network_.lose(node);
            const auto again = std::ranges::find_if(happenings_, [&](const Happening& h) {
                return h.kind == kReturned && h.rank == rank && h.before >= next;
            });
            if (again == happenings_.end()) return;
            for (const Happening& h : happenings_)
                if (h.kind == kReturned && (h.before < again->before || &h < &*again))
                    network_.awaitIncarnation(h.rank, incarnationAt(h));
            next = again->before;
            node = network_.comeAgain(rank);
        }
    }
    // Returns the picture at which that node is lost.
    uint64_t take(FakeNode node, uint64_t from) {
        const int ranks = static_cast<int>(scene_.parts.size());
        std::map<int, int> incarnations; // incarnations of its peers
        for (const Happening& h : happenings_) {
            if (node.incarnation > 0 && h.kind == kReturned && h.rank == node.rank &&
                incarnationAt(h) == node.incarnation)
                break;
            if (node.incarnation > 0 && h.kind == kReturned) incarnations[h.rank] = incarnationAt(h);
        }
        FakeRoutes routes(network_, node, incarnations);
        PictureComposer composer({strategy_, node.rank, ranks, kPartMs, 2 * kPartMs, 1000, ""}, routes);
        bool member = node.incarnation == 0;
        for (uint64_t picture = from; picture < pictures_.size(); ++picture) {
            for (const Happening& h : happenings_) {
                if (h.before != picture) continue;
                if (h.kind == kLost && h.rank == node.rank && (member || picture > from)) return picture;
                if (h.kind != kReturned) continue;
                member = member || h.rank == node.rank;
                if (!member) continue;
                network_.awaitIncarnation(h.rank, incarnationAt(h)); // a member is always connected
                composer.returned(h.rank, static_cast<uint32_t>(incarnationAt(h)), h.absent);
            }
            PicturePart part = scene_.parts[static_cast<size_t>(node.rank)];
            part.id.serial = picture;
            composer.compose(part, scene_.rule);
            if (node.rank != 0) continue;
            pictures_[picture] = std::move(part);
            sent_[picture] = network_.sentBy(0);
        }
        return pictures_.size();
    }
    // The incarnation of that rank after this return.
    [[nodiscard]] int incarnationAt(const Happening& happening) const {
        int incarnations = 0;
        for (const Happening& h : happenings_) {
            incarnations += h.kind == kReturned && h.rank == happening.rank ? 1 : 0;
            if (&h == &happening) break;
        }
        return incarnations;
    }

    const Scene& scene_;
    const Strategy strategy_;
    const std::vector<Happening> happenings_; // in order
    FakeNetwork network_;
    std::vector<PicturePart> pictures_; // by the collector; empty while it was lost
    std::vector<int> sent_;
};

// Returns whether the collector announces each picture, as all strategies except serial do.
bool goesBy(Strategy strategy, const Story& story, uint64_t picture, int others) {
    return strategy == Strategy::Serial || story.sent(picture) - story.sent(picture - 1) >= others;
}

TEST(ComposerReturns, workForEachRankAfterItsLossWasDetected) {
    std::mt19937 random(53);
    for (const Strategy strategy : kEveryStrategy)
        for (const int ranks : {2, 3, 6})
            for (int lost = 0; lost < ranks; ++lost) {
                const Scene scene = sceneOf(random, ranks, ruleOf(DepthFunction::LessOrEqual, false), 60, 110);
                const Story story(scene, strategy, 10, {{kLost, lost, 3}, {kReturned, lost, 6}});
                const auto what =
                    std::string(nameOf(strategy)) + ", " + std::to_string(lost) + " of " + std::to_string(ranks);
                if (lost > 0) {
                    ASSERT_EQ(story.colour(5), foldedWithout(scene, {lost}).colour) << what;
                }
                for (const uint64_t picture : {2, 6, 7, 9})
                    ASSERT_EQ(story.colour(picture), scene.whole.colour) << what << ", picture " << picture;
                ASSERT_TRUE(goesBy(strategy, story, 9, ranks - 1)) << what;
            }
}

// No node has waited for it meanwhile: the collector's announcement of the previous picture is still unread.
TEST(ComposerReturns, workBeforeTheLossWasDetected) {
    std::mt19937 random(59);
    const Scene scene = sceneOf(random, 4, ruleOf(DepthFunction::Less, false), 60, 110);
    for (const Strategy strategy : kEveryStrategy)
        for (int lost = 0; lost < 4; ++lost) {
            const int other = lost == 3 ? 2 : 3;
            const Story story(scene, strategy, 12, {{kLost, lost, 4}, {kReturned, lost, 4}, {kLost, other, 7}});
            const auto what = std::string(nameOf(strategy)) + ", " + std::to_string(lost);
            for (const uint64_t picture : {3, 4, 5, 6})
                ASSERT_EQ(story.colour(picture), scene.whole.colour) << what << ", picture " << picture;
            ASSERT_EQ(story.colour(9), foldedWithout(scene, {other}).colour) << what;
            ASSERT_EQ(story.colour(11), foldedWithout(scene, {other}).colour) << what;
        }
}

TEST(ComposerReturns, workWhileAnotherNodeIsLost) {
    std::mt19937 random(61);
    const Scene scene = sceneOf(random, 4, ruleOf(DepthFunction::GreaterOrEqual, false), 60, 110);
    for (const Strategy strategy : kEveryStrategy)
        for (const auto& [first, second] : {std::pair(1, 2), std::pair(3, 1), std::pair(2, 0), std::pair(0, 3)}) {
            const Story story(
                scene, strategy, 14,
                {{kLost, first, 2}, {kLost, second, 3}, {kReturned, first, 6, {second}}, {kReturned, second, 10, {}}});
            const auto what =
                std::string(nameOf(strategy)) + ", " + std::to_string(first) + " before " + std::to_string(second);
            if (second != 0) {
                for (const uint64_t picture : {6, 9})
                    ASSERT_EQ(story.colour(picture), foldedWithout(scene, {second}).colour)
                        << what << ", picture " << picture;
            }
            for (const uint64_t picture : {10, 11, 13})
                ASSERT_EQ(story.colour(picture), scene.whole.colour) << what << ", picture " << picture;
            ASSERT_TRUE(goesBy(strategy, story, 13, 3)) << what;
        }
}

// The head has not detected the loss yet: as after any loss, only that node's draws are missing two pictures later.
TEST(ComposerReturns, workWhileAnotherLossIsUnknownToTheHead) {
    std::mt19937 random(67);
    const Scene scene = sceneOf(random, 5, ruleOf(DepthFunction::Less, false), 60, 110);
    for (const Strategy strategy : kEveryStrategy) {
        const Story story(scene, strategy, 10, {{kLost, 1, 2}, {kLost, 3, 4}, {kReturned, 1, 5, {}}});
        for (const uint64_t picture : {7, 9})
            ASSERT_EQ(story.colour(picture), foldedWithout(scene, {3}).colour)
                << nameOf(strategy) << ", picture " << picture;
    }
}

TEST(ComposerReturns, workRepeatedlyForOneNode) {
    std::mt19937 random(71);
    const Scene scene = sceneOf(random, 3, ruleOf(DepthFunction::Less, false), 60, 110);
    for (const Strategy strategy : kEveryStrategy)
        for (int rank = 0; rank < 3; ++rank) {
            const Story story(scene, strategy, 12,
                              {{kLost, rank, 1},
                               {kReturned, rank, 3},
                               {kLost, rank, 5},
                               {kReturned, rank, 5},
                               {kLost, rank, 8},
                               {kReturned, rank, 9}});
            for (const uint64_t picture : {0, 3, 4, 5, 7, 9, 11})
                ASSERT_EQ(story.colour(picture), scene.whole.colour)
                    << nameOf(strategy) << ", rank " << rank << ", picture " << picture;
        }
}

} // namespace
} // namespace mural::test
